#pragma once
/// \file Interface of a hinge for the tree: pose, motion subspace, bias, q̇ = N(q) u. Numerics only (the input record
/// is records::HingeRecord); the tree passes do not depend on the type.
///
/// Hp is fixed in the parent's node, Hc in the child's. Velocity of Hc in Hp, components in Hp:
///     [v; w] = H(q) u             6 x num_u, linear first; v is that of the origin of Hc
///     [a; α] = H(q) u̇ + bias      time derivative in Hp
/// Powers: τ = Hᵀ [f; t] for a force at Hc's origin and a moment, components in Hp.
#include <memory>

#include "base/diagnostic.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/bodies/spatial.hpp"

namespace bough::solver {

struct HingeMotion {
  Matrix3d R_HpHc = Matrix3d::Identity();
  Vector3d p_HpHc = Vector3d::Zero();  ///< in Hp
  Matrix6d H = Matrix6d::Zero();       ///< the first num_u columns
  Vector6d bias = Vector6d::Zero();
};

class Hinge {
 public:
  /// \param num_q  rows of q. \param num_u  rows of u; less than num_q with a quaternion.
  Hinge(int num_q, int num_u) : num_q_(num_q), num_u_(num_u) {}
  virtual ~Hinge() = default;
  /// Number of rows of q; 0 to 7.
  int num_q() const { return num_q_; }
  /// Number of rows of u; 0 to 6.
  int num_u() const { return num_u_; }

  /// Pose and H. q: num_q (any quaternion length but zero). Fills every used part of `motion`.
  virtual void calc_position(const double* q, HingeMotion& motion) const = 0;
  /// The bias, after calc_position. u: num_u. Default: it is zero and stays so.
  virtual void calc_bias(const double*, HingeMotion&) const {}
  /// Pose, H and bias at q and u.
  void calc_motion(const double* q, const double* u, HingeMotion& motion) const {
    calc_position(q, motion);
    calc_bias(u, motion);
  }
  /// Returns true if H is constant with components in Hc, as that of a revolute hinge is.
  virtual bool is_constant_in_child() const { return false; }
  /// q̇ = N(q) u. Default: q̇ = u.
  virtual void calc_q_dot(const double* q, const double* u, double* q_dot) const;
  /// The coordinates at which Hc coincides with Hp (zero; identity quaternion).
  virtual void set_neutral(double* q) const;
  /// To and from the order of the files: a quaternion is w, x, y, z there and x, y, z, w here. May not alias.
  virtual void set_from_file(const double* file, double* q) const;
  virtual void get_for_file(const double* q, double* file) const;
  /// Generalized force (num_u) of springs of stiffness k (num_u) at rest at q_null (num_q), and returns their energy.
  /// Default: -k (q - q_null), energy ½ k (q - q_null)².
  virtual double calc_spring(const double* q, const double* q_null, const double* k, double* force) const;
  /// Returns true if every coordinate is a number whose rate is its speed (a motion can then be prescribed).
  virtual bool has_independent_coordinates() const { return true; }

 private:
  int num_q_, num_u_;
};

/// The numerics of a record. Reports a zero axis ("system.zero-axis") or parallel axes ("system.parallel-axes") and
/// returns nullptr then.
std::unique_ptr<const Hinge> make_hinge(const records::HingeRecord& record, Diagnostics& diagnostics);

}  // namespace bough::solver
