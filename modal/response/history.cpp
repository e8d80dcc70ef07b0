#include <algorithm>
#include <cmath>
#include <map>

#include <unsupported/Eigen/MatrixFunctions>

#include "modal/response/coordinates.hpp"
#include "modal/response/support_motion.hpp"

namespace bough::modal::response {
namespace {

/// x_1 = E x_0 + P0 f_0 + P1 (f_1 - f_0) + P2 (f_m - (f_0 + f_1) / 2) over a step with the load f_m at its middle, x =
/// [ω0 q; q̇] of the coordinates `part`.
struct Step {
  MatrixXd E, P0, P1, P2;
};

/// ω0 keeps the entries of A of one size.
VectorXd calc_scale(const VectorXd& lambda, double h) { return lambda.cwiseAbs().cwiseSqrt().cwiseMax(1 / h); }

Step make_step(const VectorXd& lambda, const MatrixXd& D, double h) {
  const auto n = lambda.size();
  const VectorXd scale = calc_scale(lambda, h);
  MatrixXd A = MatrixXd::Zero(5 * n, 5 * n);
  A.block(0, n, n, n) = (h * scale).asDiagonal();
  A.block(n, 0, n, n) = (-h * lambda.cwiseQuotient(scale)).asDiagonal();
  A.block(n, n, n, n) = -h * D;
  // Forces in units of a unit rate over the step, so that they do not govern the scaling of the exponential.
  A.block(n, 2 * n, n, n).setIdentity();
  A.block(2 * n, 3 * n, n, n).setIdentity();
  A.block(3 * n, 4 * n, n, n).setIdentity();
  const MatrixXd e = A.exp();
  // The parabola through both ends and the middle: the line plus a multiple of 4 s (1 - s).
  return {e.topLeftCorner(2 * n, 2 * n), h * e.block(0, 2 * n, 2 * n, n), h * e.block(0, 3 * n, 2 * n, n),
          h * (4 * e.block(0, 3 * n, 2 * n, n) - 8 * e.block(0, 4 * n, 2 * n, n))};
}

class Motion {
 public:
  Motion(const ResponseModel& model, const Excitation& excitation, const TimeGrid& grid)
      : model_(model),
        excitation_(excitation),
        grid_(grid),
        n_(model.num_dynamic()),
        P_(model.P.topRows(n_)),
        D_(model.D.topLeftCorner(n_, n_)),
        p_(sample_forces(excitation, grid)) {
    auto supports = sample_support_motion(excitation, grid);
    d_ = std::move(supports.d);
    d_dot_ = std::move(supports.d_dot);
    d_ddot_ = std::move(supports.d_ddot);
  }

  History run() {
    const auto num = static_cast<Eigen::Index>(grid_.shown.size());
    History h;
    h.time = grid_.time(grid_.shown);
    for (auto* m : {&h.q, &h.q_dot, &h.q_ddot}) m->setZero(model_.lambda.size(), num);
    const Eigen::Index k = excitation_.D.cols();
    for (auto* m : {&h.d, &h.d_dot, &h.d_ddot}) m->resize(k, num);
    h.a.resize(model_.P.cols(), num);
    if (grid_.time.size() > 1) h.step_error = calc_step_error(step_before(1));
    q_ = model_.u0.size() > 0 ? model_.u0 : VectorXd::Zero(n_);
    v_ = model_.v0.size() > 0 ? model_.v0 : VectorXd::Zero(n_);
    Eigen::Index next = 0;
    for (Eigen::Index i = 0; i < grid_.time.size(); ++i) {
      if (i > 0) advance(i);
      jump(i);
      if (next < num && grid_.shown[static_cast<std::size_t>(next)] == i) put(i, next++, h);
    }
    return h;
  }

 private:
  double step_before(Eigen::Index i) const { return calc_step_before(grid_, i); }
  double step_after(Eigen::Index i) const { return calc_step_after(grid_, i); }

  VectorXd collect(Eigen::Index i, bool is_after) const {
    const auto pick = [&](const Sides& s) -> VectorXd { return is_after ? s.after.col(i) : s.before.col(i); };
    VectorXd a(model_.P.cols());
    a << pick(p_), -pick(d_ddot_), -pick(d_dot_), VectorXd::Zero(excitation_.D.cols());
    return a;
  }

  const std::vector<Step>& find_steps(double h) {
    const auto [found, is_new] = steps_.try_emplace(std::llround(std::log(h) * 1e9));
    if (!is_new) return found->second;
    if (model_.is_coupled) {
      found->second.push_back(make_step(model_.lambda.head(n_), D_, h));
    } else {
      for (Eigen::Index j = 0; j < n_; ++j)
        found->second.push_back(make_step(model_.lambda.segment(j, 1), D_.block(j, j, 1, 1), h));
    }
    return found->second;
  }

  /// Two halves of a step are the step: of the exponentials, their scaling and the integrals of the loads.
  double calc_step_error(double h) {
    const Eigen::Index size = model_.is_coupled ? n_ : 1;
    const auto whole = find_steps(h), half = find_steps(h / 2);
    double worst = 0;
    for (std::size_t part = 0; part < whole.size(); ++part) {
      const auto first = static_cast<Eigen::Index>(part) * size;
      const VectorXd lambda = model_.lambda.segment(first, size);
      VectorXd turn = VectorXd::Ones(2 * size);  // from the scale of the half to that of the whole
      turn.head(size) = calc_scale(lambda, h).cwiseQuotient(calc_scale(lambda, h / 2));
      const MatrixXd E = turn.asDiagonal() * half[part].E * turn.cwiseInverse().asDiagonal();
      const MatrixXd P0 = turn.asDiagonal() * half[part].P0, P1 = turn.asDiagonal() * half[part].P1;
      // Loads f0, then f1 as well: the middle has their mean.
      const MatrixXd E_off = E * E - whole[part].E, P0_off = E * P0 + P0 - whole[part].P0;
      const MatrixXd P1_off = 0.5 * (E * P1 + P0 + P1) - whole[part].P1;
      // The parabola is a line to 1 and back with a quarter of a parabola on each half.
      const MatrixXd P2 = 0.25 * turn.asDiagonal() * half[part].P2;
      const MatrixXd P2_off = E * (P1 + P2) + P0 - P1 + P2 - whole[part].P2;
      worst = std::max(
          {worst, E_off.norm() / std::max(1.0, whole[part].E.norm()),
           std::max({P0_off.norm(), P1_off.norm(), P2_off.norm()}) / (whole[part].P0.norm() + whole[part].P1.norm())});
    }
    return worst;
  }

  void advance(Eigen::Index i) {
    const double h = step_before(i);
    const auto& steps = find_steps(h);
    const VectorXd f0 = P_ * collect(i - 1, true), f1 = P_ * collect(i, false);
    // Supports are lines between the steps; forces are known at their middle too.
    const VectorXd bump =
        P_.leftCols(p_.after.rows()) * (sample_forces_within(excitation_, grid_.time(i - 1) + 0.5 * h) -
                                        0.5 * (p_.after.col(i - 1) + p_.before.col(i)));
    const Eigen::Index size = model_.is_coupled ? n_ : 1;
    for (std::size_t part = 0; part < steps.size(); ++part) {
      const auto first = static_cast<Eigen::Index>(part) * size;
      const auto& s = steps[part];
      const VectorXd scale = calc_scale(model_.lambda.segment(first, size), h);
      VectorXd x(2 * size);
      x << scale.cwiseProduct(q_.segment(first, size)), v_.segment(first, size);
      const VectorXd y = s.E * x + s.P0 * f0.segment(first, size) +
                         s.P1 * (f1.segment(first, size) - f0.segment(first, size)) + s.P2 * bump.segment(first, size);
      q_.segment(first, size) = y.head(size).cwiseQuotient(scale);
      v_.segment(first, size) = y.tail(size);
    }
  }

  /// Supports may jump, the structure does not: Φ q jumps against Ψ d.
  void jump(Eigen::Index i) {
    const auto m = excitation_.F.cols(), k = excitation_.D.cols();
    if (k == 0) return;
    const VectorXd d = d_.after.col(i) - d_.before.col(i), v = d_dot_.after.col(i) - d_dot_.before.col(i);
    const auto P_M = P_.middleCols(m, k), P_B = P_.middleCols(m + k, k);
    q_ -= P_M * d;
    v_ -= P_M * v + P_B * d - D_ * (P_M * d);
  }

  /// Where something jumps, the mean of before and after.
  void put(Eigen::Index i, Eigen::Index column, History& h) const {
    const auto m = excitation_.F.cols(), k = excitation_.D.cols();
    const bool is_first = i == 0;
    VectorXd jump_v = VectorXd::Zero(k);
    if (!is_first) jump_v = d_dot_.after.col(i) - d_dot_.before.col(i);
    const VectorXd v = v_ + 0.5 * (P_.middleCols(m, k) * jump_v);
    h.a.col(column) = is_first ? collect(i, true) : VectorXd(0.5 * (collect(i, true) + collect(i, false)));
    // An impulse of the supports counts as spread over the step.
    h.a.block(m, column, k, 1) -= jump_v / (0.5 * (step_before(i) + step_after(i)));
    h.q.col(column).head(n_) = q_;
    // Massless coordinates follow their loads without delay.
    h.q.col(column).tail(model_.num_massless) = model_.P.bottomRows(model_.num_massless) * h.a.col(column);
    h.q_dot.col(column).head(n_) = v;
    h.q_ddot.col(column).head(n_) = P_ * h.a.col(column) - D_ * v - model_.lambda.head(n_).cwiseProduct(q_);
    h.d.col(column) = d_.after.col(i);
    h.d_dot.col(column) = d_dot_.after.col(i) - 0.5 * jump_v;
    h.d_ddot.col(column) = -h.a.block(m, column, k, 1);
  }

  const ResponseModel& model_;
  const Excitation& excitation_;
  const TimeGrid& grid_;
  Eigen::Index n_;  ///< coordinates with mass
  MatrixXd P_, D_;  ///< their rows
  Sides p_, d_, d_dot_, d_ddot_;
  std::map<long long, std::vector<Step>> steps_;
  VectorXd q_, v_;
};

}  // namespace

History calc_history(const ResponseModel& model, const Excitation& excitation, const TimeGrid& grid) {
  return Motion(model, excitation, grid).run();
}

}  // namespace bough::modal::response
