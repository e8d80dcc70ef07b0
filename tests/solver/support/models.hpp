#pragma once
/// \file Hand-made bodies and systems for the solver's tests.
///
/// PointBody is a cloud of point masses that deforms as r_k = p_k + φ_k η + ½ ηᵀ g_k η with a random second-order field
/// g_k: its mass integrals, the twelve K_G1 and every K_G2 follow by plain sums (docs/theory/flexible-body.md §4), so
/// the flexible-body record made from it is exact by construction.
#include <map>
#include <memory>
#include <random>

#include "solver/system/system.hpp"

namespace bough::solver::testing {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double scale = 1) { return scale * std::uniform_real_distribution<double>(-1, 1)(engine_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  Vector3d vector(double scale = 1) { return {(*this)(scale), (*this)(scale), (*this)(scale)}; }
  VectorXd vector_n(int n, double scale = 1) {
    return VectorXd::NullaryExpr(n, [&] { return (*this)(scale); });
  }
  MatrixXd symmetric(int n, double scale = 1);
  Matrix3d rotation();

 private:
  std::mt19937 engine_;
};

struct PointBody {
  int num_modes = 0;
  std::vector<double> mass;
  std::vector<Vector3d> p;
  std::vector<MatrixXd> phi, psi;                   ///< [k] 3 x n
  std::vector<std::array<MatrixXd, 3>> g, g_theta;  ///< [k][a] n x n, symmetric; of the rotation: may be empty
  MatrixXd K, D;

  /// Kinetic energy of the points themselves (to all orders in η).
  double calc_kinetic(const Vector3d& v, const Vector3d& w, const VectorXd& eta, const VectorXd& eta_dot) const;
  /// Output nodes have the ids 101, 102, ...; all have locators of forces, and of moments when there is a g_theta.
  records::FlexBody make_record(const std::string& name) const;
};

PointBody make_point_body(int num_modes, unsigned seed, double second_order_scale = 0.3);

records::BodyRecord make_rigid_record(const std::string& name, Random& random);
records::HingeRecord make_hinge_record(const std::string& name, records::HingeType type, const std::string& parent,
                                       const std::string& child);
inline constexpr records::HingeType kAllHinges[] = {records::HingeType::Fixed,       records::HingeType::Revolute,
                                                    records::HingeType::Prismatic,   records::HingeType::Universal,
                                                    records::HingeType::Cylindrical, records::HingeType::Planar,
                                                    records::HingeType::Spherical,   records::HingeType::Free};

struct RandomTreeOptions {
  int num_bodies = 8;
  bool forces = true;       ///< node forces and moments in all frames, gravity
  bool dissipation = true;  ///< hinge and modal dampers
  bool springs = true;
  bool prescribed = true;  ///< some hinges follow a sine
  bool to_ground = true;   ///< roots hang on ground by random hinges; else one free root
};
struct RandomTree {
  records::SystemSpec spec;
  std::map<std::string, records::FlexBody> flex;
};
/// Rigid and flexible bodies (1 to 4 modes), all hinge types, attachments at moving nodes with offsets on both sides.
RandomTree make_random_tree(unsigned seed, const RandomTreeOptions& options);

/// A state with hinge coordinates of order 1 and small η, quaternions normalized.
void make_random_state(const System& system, unsigned seed, VectorXd& q, VectorXd& u);

System build(const records::SystemSpec& spec, const std::map<std::string, records::FlexBody>& flex = {});

/// Everything that a test may want at (t, q, u).
VectorXd calc_u_dot(const System& system, SystemData& data, double t, const VectorXd& q, const VectorXd& u);

/// One step of the classical Runge-Kutta method on (q, u).
void step_rk4(const System& system, SystemData& data, double t, double step, VectorXd& q, VectorXd& u);

/// q after `dt` along q̇ = N(q) u with u(t) = u0 + u̇0 t: a true trajectory to finite-difference along (error dt⁵).
VectorXd advance_q(const System& system, SystemData& data, double t, double dt, const VectorXd& q0, const VectorXd& u0,
                   const VectorXd& u_dot0);

/// Rates of the momenta (linear, angular about the inertial origin, in W) of each body along the trajectory through
/// (q, u) with u_dot, by differences of order 8.
Matrix6Xd calc_momentum_rates(const System& system, double t, const VectorXd& q, const VectorXd& u,
                              const VectorXd& u_dot);
/// Applied forces and gravity on body b: resultant and moment about the inertial origin, in W. \pre `data` is that of
/// calc_u_dot.
Vector6d calc_applied_loads(const System& system, const SystemData& data, int b);

}  // namespace bough::solver::testing
