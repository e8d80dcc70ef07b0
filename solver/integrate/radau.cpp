// Radau IIA with five stages, of order 9: collocation at the Radau points, solved by simplified Newton iteration with a
// Jacobian of difference quotients that is kept as long as the iteration converges well. Each step costs one real and
// two complex factors where its length or the Jacobian has changed. States within a step are those of the collocation
// polynomial. Source: Hairer and Wanner, "Solving Ordinary Differential Equations II", IV.8.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "solver/integrate/radau_table.hpp"
#include "solver/integrate/step_size.hpp"
#include "solver/integrate/sundials.hpp"

namespace bough::solver {
namespace {

constexpr int kStages = 5, kMaxIterations = 10;
constexpr double kSafety = 0.9, kMaxGrowth = 8, kMinGrowth = 0.2;
/// A step that may grow by less than this keeps its length and with it the factors.
constexpr double kMinWorthwhileGrowth = 1.2;
/// Shares of the step that is tried next, where a stage could not be evaluated or the iteration does not converge.
constexpr double kAfterFailure = 0.25, kAfterDivergence = 0.5;
/// The iteration ends where its error is below this share of a tolerance.
constexpr double kIterationError = 1e-3;
/// A Jacobian that lets the iteration converge at this rate or faster is kept.
constexpr double kGoodRate = 0.02;
constexpr double kStretch = 1e-9;

using Eigen::MatrixXd;
using Eigen::VectorXcd;

class RadauStepper final : public Integrator {
 public:
  RadauStepper(Ode& ode, const StepperOptions& options)
      : ode_(ode), options_(options), table_(make_radau_table(kStages)), jacobian_(ode.size(), ode.size()) {
    BOUGH_DEMAND(options.absolute_tolerance.size() == ode.size());
    const int n = ode.size();
    for (VectorXd* v : {&y_, &last_y_, &y_dot_, &stage_, &trial_, &error_, &real_, &real_delta_}) v->setZero(n);
    for (MatrixXd* m : {&Z_, &last_Z_, &F_, &delta_}) m->setZero(n, kStages);
    complex_.setZero(n);
    complex_delta_.setZero(n);
    real_matrix_.setZero(n, n);
    complex_matrix_.setZero(n, n);
    real_factor_ = Eigen::PartialPivLU<MatrixXd>(n);
    for (auto& factor : complex_factors_) factor = Eigen::PartialPivLU<Eigen::MatrixXcd>(n);
  }

  void reset(double t, const Eigen::Ref<const VectorXd>& y, double t_stop, double left) override {
    y_ = last_y_ = y;
    t_ = last_ = t;
    h_ = last_h_ = 0;
    error_before_ = 0;
    has_polynomial_ = is_jacobian_current_ = false;
    set_stop(t_stop, left);
  }

  void set_stop(double t_stop, double left) override {
    ode_.set_left_limit(left);
    t_stop_ = t_stop;
    smallest_ = detail::calc_smallest_step(options_, t_stop - t_);
  }

  void step(double) override {
    // The polynomial of the last step serves the first guess, until a step is accepted.
    ode_.begin_step();
    if (ode_.calc(t_, y_.data(), y_dot_.data()) != 0) fail("the derivative cannot be evaluated");
    is_jacobian_current_ = false;
    if (h_ == 0)
      h_ = detail::guess_first_step(ode_, options_, kStages, t_, y_, y_dot_, smallest_, t_stop_ - t_, stage_, trial_);
    bool was_rejected = false;
    for (int rejected = 0;; ++rejected) {
      const double h = choose_length();
      const bool ends_at_stop = t_ + h >= t_stop_ - std::max(smallest_, kStretch * h);
      const double t_end = ends_at_stop ? t_stop_ : t_ + h;
      double next = 0;
      const Iteration result = iterate(t_end, h);
      bool is_estimated = false;
      if (result == Iteration::Converged) {
        is_estimated = finish_step(t_end, h, was_rejected);
        const double growth = is_estimated ? calc_growth(h) : kAfterFailure;
        if (is_estimated && error_norm_ <= 1) return accept(t_end, h, was_rejected ? std::min(1.0, growth) : growth);
        next = h * std::min(growth, kSafety);
        was_rejected = true;
      } else if (is_jacobian_current_) {
        next = h * (result == Iteration::NotEvaluated ? kAfterFailure : kAfterDivergence);
      } else {  // with a Jacobian of here it may converge
        needs_jacobian_ = true;
        next = h;
      }
      ++statistics_.num_rejected;
      h_ = next;
      if (rejected + 1 >= detail::kMaxRejections || h_ < smallest_ || t_ + h_ == t_) {
        h_ = 0;
        fail(is_estimated ? detail::describe_rejection(h, error_norm_) : "the equations of a step cannot be solved");
      }
    }
  }

  double time() const override { return t_; }
  double last_time() const override { return last_; }
  Eigen::Map<const VectorXd> state() const override { return {y_.data(), y_.size()}; }

  void calc_state(double t, Eigen::Ref<VectorXd> y) override {
    if (detail::copy_end_state(t, {last_, last_y_, t_, y_}, y)) return;
    y = last_y_;
    const auto weights = calc_polynomial_weights((t - last_) / last_h_);
    for (int i = 0; i < kStages; ++i) y += weights[static_cast<size_t>(i)] * last_Z_.col(i);
    if (!ode_.has_projection()) return;
    ode_.begin_step();
    if (ode_.project(t, y.data()) != 0) fail("the projection is not finite");
  }

  void set_last_tolerances(int count, double tolerance) override {
    options_.absolute_tolerance.tail(count).setConstant(tolerance);
  }

  StepStatistics statistics() const override {
    StepStatistics s = statistics_;
    s.order = 2 * kStages - 1;
    s.num_evaluations = ode_.num_evaluations();
    return s;
  }

 private:
  enum class Iteration { Converged, Diverged, NotEvaluated };

  /// h_ within the largest step and the stop. Two steps share a rest that is shorter than they are.
  double choose_length() const {
    const double rest = t_stop_ - t_, h = options_.step > 0 ? std::min(h_, options_.step) : h_;
    if (h >= rest * (1 - kStretch)) return rest;
    return h > rest / 2 ? rest / 2 : h;
  }

  /// Values at x, in steps from the start of the last one, of the Lagrange polynomials of the nodes (that of the start
  /// is not needed: Z is 0 there).
  std::array<double, kStages> calc_polynomial_weights(double x) const {
    std::array<double, kStages> weights{};
    double sum = table_.barycentric[0] / x;
    for (int i = 0; i < kStages; ++i) {
      const double distance = x - table_.c[i];
      if (distance == 0) {
        weights.fill(0);
        weights[static_cast<size_t>(i)] = 1;
        return weights;
      }
      weights[static_cast<size_t>(i)] = table_.barycentric[i + 1] / distance;
      sum += weights[static_cast<size_t>(i)];
    }
    for (double& w : weights) w /= sum;
    return weights;
  }

  /// Z_ of the last step's polynomial, minus its end.
  void guess_stages(double h) {
    if (!has_polynomial_) {
      Z_.setZero();
      return;
    }
    for (int i = 0; i < kStages; ++i) {
      const auto weights = calc_polynomial_weights(1 + table_.c[i] * h / last_h_);
      Z_.col(i) = -last_Z_.col(kStages - 1);
      for (int j = 0; j < kStages; ++j) Z_.col(i) += weights[static_cast<size_t>(j)] * last_Z_.col(j);
    }
  }

  /// ∂f/∂y at (t_, y_) by difference quotients. Returns false where f cannot be evaluated.
  bool calc_jacobian() {
    const double root = std::sqrt(std::numeric_limits<double>::epsilon());
    stage_ = y_;
    for (Eigen::Index j = 0; j < y_.size(); ++j) {
      const double scale =
          options_.relative_tolerance > 0 ? options_.absolute_tolerance[j] / options_.relative_tolerance : 1;
      const double step = root * std::max({std::abs(y_[j]), scale, 1e-100});
      stage_[j] = y_[j] + step;
      const double taken = stage_[j] - y_[j];
      if (ode_.calc(t_, stage_.data(), jacobian_.col(j).data()) != 0) return false;
      jacobian_.col(j) = (jacobian_.col(j) - y_dot_) / taken;
      stage_[j] = y_[j];
    }
    is_jacobian_current_ = true;
    needs_jacobian_ = false;
    factored_h_ = 0;
    return true;
  }

  void factor(double h) {
    if (h == factored_h_) return;
    real_matrix_ = -h * jacobian_;
    real_matrix_.diagonal().array() += table_.real_value;
    real_factor_.compute(real_matrix_);
    for (size_t k = 0; k < complex_factors_.size(); ++k) {
      complex_matrix_ = (-h * jacobian_).cast<std::complex<double>>();
      complex_matrix_.diagonal().array() += table_.pairs[k].value;
      complex_factors_[k].compute(complex_matrix_);
    }
    factored_h_ = h;
  }

  bool calc_stages(double t_end, double h) {
    for (int i = 0; i < kStages; ++i) {
      stage_ = y_ + Z_.col(i);
      if (ode_.calc(i + 1 == kStages ? t_end : t_ + table_.c[i] * h, stage_.data(), F_.col(i).data()) != 0)
        return false;
    }
    return true;
  }

  /// delta_ of one iteration from F_ and Z_.
  void solve(double h) {
    real_.noalias() = h * (F_ * table_.real_left.transpose());
    real_.noalias() -= table_.real_value * (Z_ * table_.real_left.transpose());
    real_delta_ = real_factor_.solve(real_);
    delta_.noalias() = real_delta_ * table_.real_right.transpose();
    for (size_t k = 0; k < complex_factors_.size(); ++k) {
      const auto& pair = table_.pairs[k];
      complex_.setZero();
      for (int i = 0; i < kStages; ++i)
        complex_ += (h * pair.left[i]) * F_.col(i) - (pair.value * pair.left[i]) * Z_.col(i);
      complex_delta_ = complex_factors_[k].solve(complex_);
      for (int i = 0; i < kStages; ++i) delta_.col(i) += 2 * (pair.right[i] * complex_delta_).real();
    }
  }

  /// Takes the increments of states without a rate, at the start and at every stage, as the exact zero that they are:
  /// the factors with exchanged rows, and those of a Jacobian from before a coordinate was locked, leave round-off
  /// there, by which a locked coordinate would drift and meet events.
  void hold_constant_rows() {
    for (Eigen::Index i = 0; i < y_.size(); ++i)
      if (y_dot_[i] == 0 && F_.row(i).isZero(0)) delta_.row(i) = -Z_.row(i);
  }

  /// Z_ of a step from t_ to t_end.
  Iteration iterate(double t_end, double h) {
    if (needs_jacobian_ && !calc_jacobian()) return Iteration::NotEvaluated;
    factor(h);
    guess_stages(h);
    double before = 0, rate = 1;
    for (num_iterations_ = 1; num_iterations_ <= kMaxIterations; ++num_iterations_) {
      if (!calc_stages(t_end, h)) return Iteration::NotEvaluated;
      solve(h);
      hold_constant_rows();
      double sum = 0;
      for (int i = 0; i < kStages; ++i) {
        stage_ = delta_.col(i);
        sum += std::pow(detail::calc_error_norm(options_, y_, stage_), 2);
      }
      const double size = std::sqrt(sum / kStages);
      if (!std::isfinite(size)) return Iteration::Diverged;
      Z_ += delta_;
      if (num_iterations_ > 1) {
        rate = size / before;
        rate_ = num_iterations_ == 2 ? rate : std::sqrt(rate * rate_);
        if (rate_ >= 0.99) return Iteration::Diverged;
        const double rest = rate_ / (1 - rate_) * size;
        if (rest <= kIterationError) return Iteration::Converged;
        if (rest * std::pow(rate_, kMaxIterations - 1 - num_iterations_) > kIterationError) return Iteration::Diverged;
      } else {
        rate_ = 0;
        if (size <= 0.1 * kIterationError) return Iteration::Converged;
      }
      before = size;
    }
    return Iteration::Diverged;
  }

  /// trial_ and error_norm_ of a converged step. Returns false where f or the projection cannot be evaluated.
  bool finish_step(double t_end, double h, bool was_rejected) {
    trial_ = y_ + Z_.col(kStages - 1);
    real_.noalias() = Z_ * table_.error;
    stage_ = (h / table_.real_value) * y_dot_ + real_;
    filter_error();
    if (ode_.has_projection()) {
      if (ode_.project(t_end, trial_.data()) != 0) return false;
      if (ode_.project_error(error_.data()) != 0) return false;
    }
    error_norm_ = detail::calc_error_norm(options_, y_, error_);
    if (error_norm_ <= 1 || (!was_rejected && last_h_ > 0)) return true;
    // Second filter of the error estimate for stiff components: f at the start state plus the first estimate.
    stage_ = y_ + error_;
    if (ode_.calc(t_, stage_.data(), real_delta_.data()) != 0) return true;
    stage_.noalias() = Z_ * table_.error;
    stage_ += (h / table_.real_value) * real_delta_;
    filter_error();
    if (ode_.has_projection() && ode_.project_error(error_.data()) != 0) return false;
    error_norm_ = detail::calc_error_norm(options_, y_, error_);
    return true;
  }

  /// error_ = (1 - h J / real_value)⁻¹ stage_, which bounds the estimate of fast decaying motion.
  void filter_error() {
    stage_ *= table_.real_value;
    error_ = real_factor_.solve(stage_);
  }

  /// Growth of the next step by the errors of this one and the one before (Gustafsson).
  double calc_growth(double h) const {
    const double error = std::max(error_norm_, 1e-10), order = kStages + 1;
    const double safety = kSafety * (2 * kMaxIterations + 1) / (2 * kMaxIterations + num_iterations_);
    double growth = safety * std::pow(error, -1 / order);
    if (error_norm_ <= 1 && error_before_ > 0)
      growth = std::min(growth, kSafety * h / last_h_ * std::pow(error_before_ / (error * error), 1 / order));
    return std::clamp(growth, kMinGrowth, kMaxGrowth);
  }

  void accept(double t_end, double h, double growth) {
    error_before_ = std::max(error_norm_, 1e-2);
    needs_jacobian_ = rate_ > kGoodRate;
    if (growth >= 1 && growth < kMinWorthwhileGrowth && !needs_jacobian_) growth = 1;
    // A step that a stop has cut short does not shorten the next.
    h_ = growth >= 1 ? std::max(h_, growth * h) : growth * h;
    last_ = t_;
    last_h_ = h;
    last_y_ = y_;
    last_Z_.swap(Z_);
    has_polynomial_ = true;
    y_ = trial_;
    t_ = t_end;
    statistics_.step = h;
    ++statistics_.num_steps;
  }

  [[noreturn]] void fail(std::string what) { detail::throw_failure(ode_, t_, std::move(what), find_worst()); }

  /// The state that errs most in its tolerance; -1 if the last step has no estimate.
  int find_worst() const {
    int row = -1;
    double worst = 0;
    for (Eigen::Index i = 0; i < error_.size(); ++i) {
      const double e = std::abs(error_[i]) / detail::calc_error_weight(options_, y_, i);
      if (e > worst) {
        worst = e;
        row = static_cast<int>(i);
      }
    }
    return row;
  }

  GuardedOde ode_;
  StepperOptions options_;
  RadauTable table_;
  MatrixXd jacobian_, real_matrix_;
  Eigen::MatrixXcd complex_matrix_;
  Eigen::PartialPivLU<MatrixXd> real_factor_;
  std::array<Eigen::PartialPivLU<Eigen::MatrixXcd>, kStages / 2> complex_factors_;
  MatrixXd Z_, last_Z_, F_, delta_;  // a stage per column
  VectorXd y_, last_y_, y_dot_, stage_, trial_, error_, real_, real_delta_;
  VectorXcd complex_, complex_delta_;
  double t_ = 0, last_ = 0, t_stop_ = 0, h_ = 0, last_h_ = 0, factored_h_ = 0, smallest_ = 0;
  double error_norm_ = 0, error_before_ = 0, rate_ = 0;
  int num_iterations_ = 0;
  bool has_polynomial_ = false, is_jacobian_current_ = false, needs_jacobian_ = true;
  StepStatistics statistics_;
};

}  // namespace

std::unique_ptr<Integrator> make_radau_stepper(Ode& ode, const StepperOptions& options) {
  return std::make_unique<RadauStepper>(ode, options);
}

}  // namespace bough::solver
