#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Eigenvalues>

#include "fe/linear/complex_factor.hpp"
#include "fe/linear/null_space.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "modal/response/accuracy.hpp"
#include "modal/response/direct_model.hpp"
#include "modal/response/support_motion.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::response {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::VectorXcd;
using Matrix3cd = Eigen::Matrix3cd;

constexpr int kStages = 3;
/// Times whose solutions are held at a time.
constexpr Index kHeldTimes = 64;
/// The time in which a jump is over, per step: its error in a mode is of the size of its square.
constexpr double kJumpShare = 1e-5;

/// Hairer & Wanner, table IV.5.6, and G = A⁻ᵀ = P Λ P⁻¹: the real eigenvalue first, then one of the pair.
struct Radau {
  Radau() {
    const double r = std::sqrt(6.0);
    c << (4 - r) / 10, (4 + r) / 10, 1;
    Matrix3d A;
    A << (88 - 7 * r) / 360, (296 - 169 * r) / 1800, (-2 + 3 * r) / 225,  //
        (296 + 169 * r) / 1800, (88 + 7 * r) / 360, (-2 - 3 * r) / 225,   //
        (16 - r) / 36, (16 + r) / 36, 1.0 / 9;
    G = A.inverse().transpose();
    const Eigen::EigenSolver<Matrix3d> eigen(G);
    int real = 0;
    for (int j = 0; j < kStages; ++j)
      if (std::abs(eigen.eigenvalues()(j).imag()) < std::abs(eigen.eigenvalues()(real).imag())) real = j;
    const int one = (real + 1) % kStages, other = (real + 2) % kStages;
    for (int to = 0; const int j : {real, one, other}) {
      s(to) = eigen.eigenvalues()(j);
      P.col(to++) = eigen.eigenvectors().col(j);
    }
    P_inverse = P.inverse();
  }
  Eigen::Vector3d c;
  Matrix3d G;
  Eigen::Vector3cd s;
  Matrix3cd P, P_inverse;
};

void accumulate(linear::SymmetricMatrix& sum, double factor, const linear::SymmetricMatrix& A) {
  if (factor != 0 && A) sum = linear::add(sum, factor, A);
}

/// Along a motion with negligible stiffness, damping and mass, the answer to any load is
/// round-off.
void demand_held(const linear::SymmetricFactor& factor, const VectorXd& D) {
  const VectorXd size = D.cwiseMax(detail::kIdleDof * D.maxCoeff()).cwiseSqrt();
  bool is_free = factor.is_singular();
  if (!is_free) {
    const VectorXd load = size.cwiseProduct(make_probe(D.size()));
    const VectorXd x = factor.solve(load);
    is_free = !(std::abs(x.dot(load)) > linear::kMechanismEnergy * x.cwiseProduct(size).squaredNorm());
  }
  if (is_free)
    throw ComputationError("modal.unbounded-response", {},
                           "the model has a motion with neither mass nor stiffness nor damping",
                           "hold it, or give it mass (bough modes lists it); one by modes (--modal) leaves it out");
}

/// The factors of one size of step: s² M + s B + K.
struct StepFactors {
  StepFactors(const DirectModel& m, const Radau& radau, double h) : real(make_real(m, radau.s(0).real() / h)) {
    demand_held(real, m.K_diagonal + std::norm(radau.s(0) / h) * m.M_diagonal);
    const auto s = radau.s(1) / h;
    linear::SymmetricMatrix A = m.K, B = linear::scale(m.M, (s * s).imag());
    accumulate(A, (s * s).real(), m.M);
    accumulate(A, s.real(), m.B);
    accumulate(B, s.imag(), m.B);
    pair.emplace(A, B);
  }
  static linear::SymmetricFactor make_real(const DirectModel& m, double s) {
    linear::SymmetricMatrix A = m.K;
    accumulate(A, s * s, m.M);
    accumulate(A, s, m.B);
    return {A, false};
  }
  linear::SymmetricFactor real;
  std::optional<linear::ComplexFactor> pair;
};

/// d over a step as the cubic through values and rates at both ends.
struct Cubic {
  VectorXd d0, v0, d1, v1;
  double h;
  VectorXd value(double c) const {
    return d0 + c * c * (3 - 2 * c) * (d1 - d0) + h * c * (1 - c) * ((1 - c) * v0 - c * v1);
  }
  VectorXd rate(double c) const {
    return 6 * c * (1 - c) / h * (d1 - d0) + (1 - c) * (1 - 3 * c) * v0 + c * (3 * c - 2) * v1;
  }
  VectorXd second(double c) const { return ((6 - 12 * c) / h * (d1 - d0) + (6 * c - 4) * v0 + (6 * c - 2) * v1) / h; }
};

class DirectMotion {
 public:
  DirectMotion(const fe::Model& model, const DirectModel& direct, const Excitation& excitation, const TimeGrid& grid)
      : model_(model),
        m_(direct),
        excitation_(excitation),
        grid_(grid),
        supports_(sample_support_motion(excitation, grid)),
        forces_(sample_forces(excitation, grid)),
        n_(model.num_fdofs()) {}

  void run(const StartMotion& start, const std::function<void(const MotionBlock<MatrixXd>&)>& take) {
    u_ = start.u_free.size() > 0 ? start.u_free : VectorXd::Zero(n_);
    v_ = start.v_free.size() > 0 ? start.v_free : VectorXd::Zero(n_);
    a_ = VectorXd::Zero(n_);
    begin_block(0);
    Index next = 0;
    const auto num = static_cast<Index>(grid_.shown.size());
    for (Index i = 0; i < grid_.time.size(); ++i) {
      if (i > 0) {
        advance(i);
        check(i);
      }
      const bool is_shown = next < num && grid_.shown[static_cast<std::size_t>(next)] == i;
      jump(i, is_shown ? next - first_ : -1);
      if (!is_shown) continue;
      if (++next - first_ == block_.x.size()) {
        take(block_);
        begin_block(next);
      }
    }
  }
  double residual() const { return residual_.worst(); }

 private:
  void begin_block(Index first) {
    first_ = first;
    const Index count = std::min(kHeldTimes, static_cast<Index>(grid_.shown.size()) - first);
    block_.x.resize(count);
    for (auto* u : {&block_.u, &block_.u_dot, &block_.u_ddot}) u->resize(model_.num_gdofs(), count);
    block_.p.resize(m_.F.cols(), count);
  }

  MatrixXd times(const linear::SymmetricMatrix& A, const MatrixXd& X) const {
    return A && n_ > 0 ? linear::multiply(A, X) : MatrixXd::Zero(X.rows(), X.cols());
  }

  VectorXd calc_load(const VectorXd& p, const VectorXd& d, const VectorXd& d_dot, const VectorXd& d_ddot) const {
    return m_.F * p - m_.K_X * d - m_.B_X * d_dot - m_.M_X * d_ddot;
  }

  /// Forces of the loads between the steps, and at the end of one.
  VectorXd calc_forces(Index i, int stage, double h) const {
    if (stage == kStages - 1) return forces_.before.col(i);
    return sample_forces_within(excitation_, grid_.time(i - 1) + radau_.c(stage) * h);
  }

  const StepFactors& find_factors(double h) {
    const auto key = std::llround(std::log(h) * 1e9);
    const auto found = factors_.find(key);
    if (found != factors_.end()) return found->second;
    // Step sizes at kinks of a table occur once; the number of stored factors is bounded.
    if (factors_.size() >= 4) factors_.clear();
    return factors_.emplace(std::piecewise_construct, std::tuple(key), std::forward_as_tuple(m_, radau_, h))
        .first->second;
  }

  void advance(Index i) {
    if (n_ == 0) return;
    const double h = calc_step_before(grid_, i);
    const Cubic d{supports_.d.after.col(i - 1), supports_.d_dot.after.col(i - 1), supports_.d.before.col(i),
                  supports_.d_dot.before.col(i), h};
    MatrixXd F(n_, kStages);
    for (int stage = 0; stage < kStages; ++stage) {
      const double c = radau_.c(stage);
      F.col(stage) = calc_load(calc_forces(i, stage, h), d.value(c), d.rate(c), d.second(c));
    }
    end_acceleration_ = d.second(1);
    F.colwise() -= times(m_.K, u_).col(0);
    const VectorXd M_v = times(m_.M, v_);
    const Eigen::RowVector3cd w = Eigen::RowVector3cd::Ones() * radau_.P;
    MatrixXcd Z(n_, kStages);
    for (int j = 0; j < 2; ++j) {
      const auto s = radau_.s(j) / h;
      const VectorXcd side = F * radau_.P.col(j) + w(j) * s * M_v;
      const auto& factors = find_factors(h);
      if (j == 0) {
        // The eigenvector of the real eigenvalue is real but for a factor.
        MatrixXd parts(n_, 2);
        parts << side.real(), side.imag();
        parts = factors.real.solve(parts);
        Z.col(0).real() = parts.col(0);
        Z.col(0).imag() = parts.col(1);
      } else {
        Z.col(1) = factors.pair->solve(side);
      }
    }
    // The pair's eigenvectors are conjugate but for a factor.
    Index row = 0;
    radau_.P.col(1).cwiseAbs().maxCoeff(&row);
    Z.col(2) = Z.col(1).conjugate() * (radau_.P(row, 2) / std::conj(radau_.P(row, 1)));
    const MatrixXd change = (Z * radau_.P_inverse).real();  // of u at the stages
    MatrixXd V = change * radau_.G / h;
    u_ += change.col(kStages - 1);
    a_ = (V.colwise() - v_) * radau_.G.col(kStages - 1) / h;
    v_ = V.col(kStages - 1);
  }

  /// The last stage is the end of the step, where the equation of motion holds.
  void check(Index i) {
    if (n_ == 0) return;
    const double h = calc_step_before(grid_, i);
    const VectorXd load =
        calc_load(forces_.before.col(i), supports_.d.before.col(i), supports_.d_dot.before.col(i), end_acceleration_);
    const VectorXd A_x = times(m_.K, u_) + times(m_.B, v_) + times(m_.M, a_);
    VectorXd D = m_.K_diagonal + m_.M_diagonal / (h * h);
    const double largest = D.maxCoeff();
    D = (D.array() > detail::kIdleDof * largest).select(D, largest > 0 ? largest : 1.0);
    residual_.add(D, u_, A_x, load);
  }

  /// (M + δB + δ²K)⁻¹, δ a time far below the step: M⁻¹ where there is mass, what is stiff otherwise.
  MatrixXd solve_quick(const MatrixXd& F) {
    if (n_ == 0) return F;
    if (!quick_) {
      linear::SymmetricMatrix A = m_.M;
      accumulate(A, delta(), m_.B);
      accumulate(A, delta() * delta(), m_.K);
      quick_.emplace(A, false);
      demand_held(*quick_, m_.M_diagonal + delta() * delta() * m_.K_diagonal);
    }
    return quick_->solve(F);
  }
  double delta() const { return kJumpShare * calc_step_before(grid_, 1); }
  /// M⁻¹ F, nothing if there is no mass.
  MatrixXd divide_by_mass(const MatrixXd& F) { return solve_quick(times(m_.M, solve_quick(F))); }

  /// Jump at step i; `column`: its position in the output, or -1. The output is the mean of both limits, at the start
  /// the right limit.
  void jump(Index i, Index column) {
    const auto change = [i](const Sides& s) -> VectorXd { return s.after.col(i) - s.before.col(i); };
    const VectorXd d = change(supports_.d), d_dot = change(supports_.d_dot);
    VectorXd u_shown = u_, v_shown = v_, a_shown = a_;
    const double mean = i == 0 ? 1.0 : 0.5;
    const bool is_moved = !d.isZero(0) || !d_dot.isZero(0);
    const bool jumps = i == 0 || is_moved || !change(forces_).isZero(0) || !change(supports_.d_ddot).isZero(0);
    if (jumps && n_ > 0) {
      if (is_moved) {
        const VectorXd du = -solve_quick(m_.M_X * d + delta() * (m_.B_X * d) + delta() * delta() * (m_.K_X * d));
        const VectorXd dv = -divide_by_mass(m_.M_X * d_dot + m_.B_X * d + times(m_.B, du));
        u_ += du;
        v_ += dv;
        u_shown = u_;
        v_shown += mean * dv;
        // An impulse of the supports counts as spread over its step.
        if (i > 0) a_shown += dv / (0.5 * (calc_step_before(grid_, i) + calc_step_after(grid_, i)));
      }
      const VectorXd load = calc_load(forces_.after.col(i), supports_.d.after.col(i), supports_.d_dot.after.col(i),
                                      supports_.d_ddot.after.col(i));
      const VectorXd rest = load - times(m_.K, u_) - times(m_.B, v_) - times(m_.M, a_);
      const VectorXd du = delta() * delta() * solve_quick(rest);
      u_ += du;
      u_shown += mean * du;
      a_shown += mean * divide_by_mass(rest);
    }
    if (column >= 0) put(i, column, u_shown, v_shown, a_shown);
  }

  void put(Index i, Index column, const VectorXd& u, const VectorXd& v, const VectorXd& a) {
    const auto take = [&](const Sides& s) -> VectorXd {
      return i == 0 ? VectorXd(s.after.col(i)) : VectorXd(0.5 * (s.after.col(i) + s.before.col(i)));
    };
    VectorXd d_ddot = take(supports_.d_ddot);
    if (i > 0)
      d_ddot += (supports_.d_dot.after.col(i) - supports_.d_dot.before.col(i)) /
                (0.5 * (calc_step_before(grid_, i) + calc_step_after(grid_, i)));
    block_.x(column) = grid_.time(i);
    block_.u.col(column) = model_.T() * u + m_.X * supports_.d.after.col(i);
    block_.u_dot.col(column) = model_.T() * v + m_.X * take(supports_.d_dot);
    block_.u_ddot.col(column) = model_.T() * a + m_.X * d_ddot;
    block_.p.col(column) = take(forces_);
  }

  const fe::Model& model_;
  const DirectModel& m_;
  const Excitation& excitation_;
  const TimeGrid& grid_;
  const Radau radau_;
  SupportMotion supports_;
  Sides forces_;
  Index n_, first_ = 0;
  std::map<long long, StepFactors> factors_;
  std::optional<linear::SymmetricFactor> quick_;
  VectorXd u_, v_, a_, end_acceleration_;
  ResidualRecord residual_{true};
  MotionBlock<MatrixXd> block_;
};

}  // namespace

double solve_history(const fe::Model& model, const DirectModel& direct, const Excitation& excitation,
                     const StartMotion& start, const TimeGrid& grid,
                     const std::function<void(const MotionBlock<MatrixXd>&)>& take) {
  DirectMotion motion(model, direct, excitation, grid);
  motion.run(start, take);
  return motion.residual();
}

}  // namespace bough::modal::response
