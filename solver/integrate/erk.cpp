// Explicit embedded pairs. The step is Bough's own and not that of ARKODE, for the sake of constraints: the error is
// the difference of both solutions along them. What a stage that is off the constraints adds across them is projected
// away and is no error; near a change point it is all there is.
#include <algorithm>
#include <cmath>

#include "solver/integrate/dormand_prince.hpp"
#include "solver/integrate/step_size.hpp"
#include "solver/integrate/sundials.hpp"

namespace bough::solver {
namespace {

constexpr double kSafety = 0.9, kMaxGrowth = 6, kMinGrowth = 0.2;
/// Weight of the error before in the next step (PI control: Hairer & Wanner II, IV.2). Where stability limits the step,
/// as of fast modes that have died out, every fifth step is rejected without it.
constexpr double kMemory = 0.04, kMinErrorBefore = 1e-4;
constexpr double kAfterFailure = 0.25;  // of the step, where a stage could not be evaluated
/// A step that would end this near its target, relative to its size, ends there: many equal steps add up their
/// rounding.
constexpr double kStretch = 1e-9;

class ErkStepper final : public Integrator {
 public:
  ErkStepper(Ode& ode, const StepperOptions& options)
      : ode_(ode),
        options_(options),
        table_(options.rk_order == 5 ? make_dormand_prince_54() : make_dormand_prince_87()),
        k_(Eigen::MatrixXd::Zero(ode.size(), table_.stages)) {
    BOUGH_DEMAND(options.absolute_tolerance.size() == ode.size());
    BOUGH_DEMAND(options.rk_order == 5 || options.rk_order == 8);
    for (VectorXd* v : {&y_, &last_y_, &trial_, &other_, &stage_, &next_first_}) v->setZero(ode.size());
    for (int j = 0; j < table_.stages; ++j)
      is_fsal_ = is_fsal_ && table_.A(table_.stages - 1, j) == (j + 1 < table_.stages ? table_.b[j] : 0);
  }

  void reset(double t, const Eigen::Ref<const VectorXd>& y, double t_stop, double left) override {
    y_ = last_y_ = y;
    t_ = last_ = t;
    h_ = 0;
    error_before_ = kMinErrorBefore;
    has_first_ = false;
    set_stop(t_stop, left);
  }

  void set_stop(double t_stop, double left) override {
    ode_.set_left_limit(left);
    t_stop_ = t_stop;
    smallest_ = detail::calc_smallest_step(options_, t_stop - t_);
  }

  void step(double t_target) override {
    last_ = t_;
    last_y_ = y_;
    ode_.begin_step();
    if (has_first_)
      k_.col(0) = next_first_;
    else if (ode_.calc(t_, y_.data(), k_.col(0).data()) != 0)
      fail("the derivative cannot be evaluated");
    if (h_ == 0) {
      h_ = detail::guess_first_step(ode_, options_, table_.q, t_, last_y_, k_.col(0), smallest_, t_stop_ - t_, stage_,
                                    next_first_);
      h_ = std::min(h_, t_stop_ - t_);
    }
    if (options_.step > 0) h_ = std::min(h_, options_.step);
    double h = h_;
    bool may_grow = true;
    for (int rejected = 0;; ++rejected) {
      const bool is_cut = t_ + h >= t_target - std::max(smallest_, kStretch * h);
      if (is_cut) h = t_target - t_;
      const double t_end = is_cut ? t_target : t_ + h;
      const bool is_evaluated = calc_step(t_, t_end, h, true);
      const double error = is_evaluated ? calc_error() : 0;
      if (is_evaluated && error <= 1) {
        const double growth = kSafety * std::pow(std::max(error, 1e-16), 0.75 * kMemory - 1.0 / table_.q) *
                              std::pow(error_before_, kMemory);
        error_before_ = std::max(error, kMinErrorBefore);
        const double next = h * std::clamp(growth, kMinGrowth, may_grow ? kMaxGrowth : 1.0);
        h_ = is_cut ? std::max(next, h_) : next;  // a shortened step does not limit the next one
        return accept(t_end, h);
      }
      may_grow = false;
      ++statistics_.num_rejected;
      const double shrink = is_evaluated ? kSafety * std::pow(error, -1.0 / table_.q) : kAfterFailure;
      h *= std::clamp(shrink, kMinGrowth, kSafety);
      h_ = h;
      if (rejected + 1 >= detail::kMaxRejections || h < smallest_ || t_ + h == t_) {
        h_ = 0;
        fail(detail::describe_rejection(h, error));
      }
    }
  }

  double time() const override { return t_; }
  double last_time() const override { return last_; }
  Eigen::Map<const VectorXd> state() const override { return {y_.data(), y_.size()}; }

  /// The last step again, but to t only.
  void calc_state(double t, Eigen::Ref<VectorXd> y) override {
    if (detail::copy_end_state(t, {last_, last_y_, t_, y_}, y)) return;
    ode_.begin_step();
    if (!calc_step(last_, t, t - last_, false)) fail("the derivative cannot be evaluated");
    y = trial_;
  }

  void set_last_tolerances(int count, double tolerance) override {
    options_.absolute_tolerance.tail(count).setConstant(tolerance);
  }
  StepStatistics statistics() const override {
    StepStatistics s = statistics_;
    s.order = options_.rk_order;
    s.num_evaluations = ode_.num_evaluations();
    return s;
  }

 private:
  // trial_ and, where the error is wanted, other_ from last_y_ and the first stage; both projected.
  bool calc_step(double t, double t_end, double h, bool with_error) {
    const int s = table_.stages;
    for (int i = 1; i < s; ++i) {
      stage_ = last_y_;
      for (int j = 0; j < i; ++j) {
        if (table_.A(i, j) != 0) stage_ += h * table_.A(i, j) * k_.col(j);
      }
      if (ode_.calc(table_.c[i] == 1 ? t_end : t + table_.c[i] * h, stage_.data(), k_.col(i).data()) != 0) return false;
    }
    trial_ = last_y_;
    for (int i = 0; i < s; ++i) {
      if (table_.b[i] != 0) trial_ += h * table_.b[i] * k_.col(i);
    }
    if (with_error) {
      other_ = last_y_;
      for (int i = 0; i < s; ++i) {
        if (table_.d[i] != 0) other_ += h * table_.d[i] * k_.col(i);
      }
    }
    has_moved_ = false;
    if (!ode_.has_projection()) return true;
    stage_ = trial_;
    if (ode_.project(t_end, trial_.data()) != 0) return false;
    has_moved_ = trial_ != stage_;
    if (!with_error) return true;
    other_ -= stage_;
    if (ode_.project_error(other_.data()) != 0) return false;
    other_ += trial_;
    return true;
  }

  /// In tolerances; remembers the state that errs most.
  double calc_error() {
    double sum = 0, max_value = -1;
    for (Eigen::Index i = 0; i < trial_.size(); ++i) {
      const double e = (trial_[i] - other_[i]) / detail::calc_error_weight(options_, last_y_, i);
      sum += e * e;
      if (std::abs(e) > max_value) {
        max_value = std::abs(e);
        worst_ = static_cast<int>(i);
      }
    }
    return std::sqrt(sum / static_cast<double>(std::max<Eigen::Index>(1, trial_.size())));
  }

  void accept(double t_end, double h) {
    // The last stage is the first one of the next step, unless the projection has changed the state.
    has_first_ = is_fsal_ && !has_moved_;
    if (has_first_) next_first_ = k_.col(table_.stages - 1);
    y_ = trial_;
    t_ = t_end;
    statistics_.step = h;
    ++statistics_.num_steps;
  }

  [[noreturn]] void fail(std::string what) { detail::throw_failure(ode_, t_, std::move(what), worst_); }

  GuardedOde ode_;
  StepperOptions options_;
  ButcherTable table_;
  Eigen::MatrixXd k_;  // a stage per column
  VectorXd y_, last_y_, trial_, other_, stage_, next_first_;
  double t_ = 0, last_ = 0, t_stop_ = 0, h_ = 0, smallest_ = 0, error_before_ = kMinErrorBefore;
  bool is_fsal_ = true, has_first_ = false, has_moved_ = false;
  int worst_ = -1;
  StepStatistics statistics_;
};

}  // namespace

std::unique_ptr<Integrator> make_erk_stepper(Ode& ode, const StepperOptions& options) {
  return std::make_unique<ErkStepper>(ode, options);
}

}  // namespace bough::solver
