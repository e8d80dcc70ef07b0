// Steppers on equations with closed solutions: order, tolerance, jumps, failures.
#include "solver/integrate/integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

namespace bough::solver {
namespace {

using Eigen::Vector2d;

class TestOde final : public Ode {
 public:
  using Function = std::function<void(double, const Eigen::Ref<const VectorXd>&, Eigen::Ref<VectorXd>)>;
  TestOde(int size, Function f) : size_(size), f_(std::move(f)) {}
  int size() const override { return size_; }
  void calc_derivative(double t, const Eigen::Ref<const VectorXd>& y, Eigen::Ref<VectorXd> y_dot) override {
    latest = std::max(latest, t);
    f_(t, y, y_dot);
  }
  double latest = -1e300;

 private:
  int size_;
  Function f_;
};

/// ÿ = -4 y: y = cos 2t.
TestOde make_oscillator() {
  return TestOde(2, [](double, const auto& y, auto y_dot) {
    y_dot[0] = y[1];
    y_dot[1] = -4 * y[0];
  });
}

StepperOptions make_options(int size, double tolerance, double step = 0) {
  StepperOptions o;
  o.relative_tolerance = tolerance;
  o.absolute_tolerance = VectorXd::Constant(size, tolerance);
  o.step = step;
  return o;
}

/// Integrates from y0 at 0 to t and returns the state there.
VectorXd integrate(Integrator& stepper, const VectorXd& y0, double t) {
  stepper.reset(0, y0, t, t);
  while (stepper.time() < t) stepper.step(t);
  VectorXd y(y0.size());
  stepper.calc_state(t, y);
  return y;
}

double calc_oscillator_error(const std::string& integrator, double tolerance, double step, int rk_order = 8) {
  TestOde ode = make_oscillator();
  auto options = make_options(2, tolerance, step);
  options.rk_order = rk_order;
  const auto stepper = make_integrator(integrator, ode, options);
  const VectorXd y = integrate(*stepper, Vector2d(1, 0), 10);
  return (y - Vector2d(std::cos(20.0), -2 * std::sin(20.0))).norm();
}

/// A method that keeps its tolerance errs by (|y| + 1) tolerance in each component of a step at most, |y| <= 2; an
/// undamped oscillator carries every error on, amplified by 2 at most.
double calc_error_bound(const std::string& integrator, double tolerance) {
  TestOde ode = make_oscillator();
  const auto stepper = make_integrator(integrator, ode, make_options(2, tolerance));
  integrate(*stepper, Vector2d(1, 0), 10);
  return 2 * 3 * std::sqrt(2.0) * tolerance * static_cast<double>(stepper->statistics().num_steps);
}

TEST(Integrator, Rk4HasOrderFour) {
  const double coarse = calc_oscillator_error("rk4", 0, 0.02), fine = calc_oscillator_error("rk4", 0, 0.01);
  EXPECT_NEAR(std::log2(coarse / fine), 4, 0.05);
}

TEST(Integrator, ErrorFollowsTheTolerance) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau"}) {
    double last = 1;
    for (double tolerance : {1e-5, 1e-7, 1e-9}) {
      const double error = calc_oscillator_error(integrator, tolerance, 0);
      EXPECT_LT(error, calc_error_bound(integrator, tolerance)) << integrator;
      EXPECT_LT(error, last / 10) << integrator;
      last = error;
    }
  }
  EXPECT_LT(calc_oscillator_error("rk", 1e-9, 0, 5), 3e-7);
}

/// A point that runs round the unit circle, ẏ = 2 ẑ × y, held there by projection when asked.
class Circle final : public Ode {
 public:
  explicit Circle(bool is_projected) : is_projected_(is_projected) {}
  int size() const override { return 2; }
  void calc_derivative(double, const Eigen::Ref<const VectorXd>& y, Eigen::Ref<VectorXd> y_dot) override {
    y_dot = Vector2d(-2 * y[1], 2 * y[0]);
  }
  bool has_projection() const override { return is_projected_; }
  void project(double, Eigen::Ref<VectorXd> y) override { y.normalize(); }

 private:
  bool is_projected_;
};

// Order 5: the last stage is the next first one, so that a step costs six evaluations and the start two (one for the
// first step's length), unless a projection has moved the state away from under it. Order 8 always takes thirteen.
TEST(Integrator, OrderFiveTakesItsLastStageOver) {
  for (const bool is_projected : {false, true}) {
    for (const int order : {5, 8}) {
      Circle ode(is_projected);
      auto options = make_options(2, 1e-9);
      options.rk_order = order;
      const auto stepper = make_integrator("rk", ode, options);
      const VectorXd y = integrate(*stepper, Vector2d(1, 0), 10);
      EXPECT_LT((y - Vector2d(std::cos(20.0), std::sin(20.0))).norm(), 3e-7);
      const StepStatistics s = stepper->statistics();
      EXPECT_GT(s.num_steps, 20);
      EXPECT_EQ(s.order, order);
      const long later = order == 5 ? 6 : 12, trials = s.num_steps + s.num_rejected;
      const long first = order == 5 && !is_projected ? 1 : s.num_steps;
      EXPECT_EQ(s.num_evaluations, 1 + first + later * trials) << order << is_projected;
    }
  }
}

// A reused derivative is that of the old equations after a jump, and of the last step after interpolation in it.
TEST(Integrator, OrderFiveForgetsItsLastStageWhereItStartsAfresh) {
  auto options = make_options(1, 1e-6, 0.3);
  options.rk_order = 5;
  TestOde jump(1, [](double t, const auto&, auto y_dot) { y_dot[0] = t < 1 ? 0 : 1; });
  const auto stepper = make_integrator("rk", jump, options);
  stepper->reset(0, VectorXd::Zero(1), 1, std::nextafter(1.0, 0.0));
  while (stepper->time() < 1) stepper->step(1);
  stepper->reset(1, VectorXd(stepper->state()), 2, 2);
  while (stepper->time() < 2) stepper->step(2);
  EXPECT_NEAR(stepper->state()[0], 1, 1e-14);

  const auto walk = [](bool looks_back) {
    TestOde ode = make_oscillator();
    auto own = make_options(2, 1e-9);
    own.rk_order = 5;
    const auto walker = make_integrator("rk", ode, own);
    walker->reset(0, Vector2d(1, 0), 10, 10);
    VectorXd between(2);
    while (walker->time() < 10) {
      walker->step(10);
      if (looks_back) walker->calc_state(0.5 * (walker->last_time() + walker->time()), between);
    }
    return VectorXd(walker->state());
  };
  EXPECT_EQ(walk(true), walk(false));
}

// At a largest step that the tolerance does not shorten: 2^5, and 2^8 at least (of the pair's own error of order 8 an
// oscillator shows little).
TEST(Integrator, PairsHaveTheirOrders) {
  EXPECT_NEAR(std::log2(calc_oscillator_error("rk", 1, 0.1, 5) / calc_oscillator_error("rk", 1, 0.05, 5)), 5, 0.3);
  EXPECT_GT(std::log2(calc_oscillator_error("rk", 1, 0.4, 8) / calc_oscillator_error("rk", 1, 0.2, 8)), 7.7);
}

TEST(Integrator, ImplicitMethodsTakeLongStepsOnAStiffEquation) {
  // ẏ = -1e6 (y - cos t) - sin t: y = cos t.
  const auto f = [](double t, const auto& y, auto y_dot) { y_dot[0] = -1e6 * (y[0] - std::cos(t)) - std::sin(t); };
  for (const std::string integrator : {"bdf", "radau"}) {
    TestOde ode(1, f);
    const auto stepper = make_integrator(integrator, ode, make_options(1, 1e-6));
    const VectorXd y = integrate(*stepper, VectorXd::Ones(1), 5);
    EXPECT_NEAR(y[0], std::cos(5.0), integrator == "bdf" ? 1e-5 : 1e-8);
    EXPECT_LT(stepper->statistics().num_steps, integrator == "bdf" ? 1000 : 20);  // an explicit method needs 5e6 / 3
    EXPECT_GE(stepper->statistics().order, 2);
  }
}

TEST(Integrator, RadauHasOrderNine) {
  const double coarse = calc_oscillator_error("radau", 1, 1), fine = calc_oscillator_error("radau", 1, 0.5);
  EXPECT_NEAR(std::log2(coarse / fine), 9, 0.3);
}

// A circle of radius 1e7 in 2π·1e3 next to an oscillator of 15 rad, damped by half a per cent, which dies out: steps
// then follow the circle alone. Every explicit step has ω h below 4.1.
TEST(Integrator, RadauStepsOverFastModesThatHaveDiedOut) {
  const double slow = 1e-3, fast = 15, ratio = 0.005;
  TestOde ode(6, [&](double, const auto& y, auto y_dot) {
    const double pull = slow * slow * 1e21 / std::pow(y.head(2).squaredNorm(), 1.5);
    y_dot << y.segment(2, 2), -pull * y.head(2), y[5], -fast * fast * y[4] - 2 * ratio * fast * y[5];
  });
  const auto stepper = make_integrator("radau", ode, make_options(6, 1e-10));
  VectorXd y(6);
  y << 1e7, 0, 0, 1e4, 1e-4, 0;
  const double end = 3 * 2 * std::acos(-1.0) / slow;
  y = integrate(*stepper, y, end);
  EXPECT_LT((y.head(2) - Vector2d(1e7, 0)).norm(), 0.01);
  EXPECT_LT(std::abs(y[4]), 1e-12);
  EXPECT_LT(stepper->statistics().num_steps, 4000);  // rk: 69,000
}

// Jacobians and factors that were kept do not survive a change of the equations wrongly: -5 y, then -5000 y.
TEST(Integrator, RadauConvergesWithEquationsThatHaveChanged) {
  double rate = 5;
  TestOde ode(1, [&](double, const auto& y, auto y_dot) { y_dot[0] = -rate * y[0]; });
  const auto stepper = make_integrator("radau", ode, make_options(1, 1e-10));
  VectorXd y = integrate(*stepper, VectorXd::Ones(1), 1);
  EXPECT_NEAR(y[0], std::exp(-5.0), 1e-9);
  rate = 5000;
  stepper->reset(1, VectorXd::Ones(1), 1.001, 1.001);
  while (stepper->time() < 1.001) stepper->step(1.001);
  EXPECT_NEAR(stepper->state()[0], std::exp(-5.0), 1e-9);
}

TEST(Integrator, InterpolatesAsWellAsItSteps) {
  TestOde ode = make_oscillator();
  const auto stepper = make_integrator("adams", ode, make_options(2, 1e-10));
  stepper->reset(0, Vector2d(1, 0), 10, 10);
  double at_steps = 0, between = 0;
  VectorXd y(2);
  for (int i = 1; i < 1000; ++i) {
    const double t = 0.01 * i;
    while (stepper->time() < t) {
      stepper->step(t);
      at_steps = std::max(at_steps, std::abs(stepper->state()[0] - std::cos(2 * stepper->time())));
    }
    stepper->calc_state(t, y);
    between = std::max(between, std::abs(y[0] - std::cos(2 * t)));
  }
  EXPECT_GT(at_steps, 0);
  EXPECT_LT(between, 1.5 * at_steps);
}

// ẏ = 0 before t = 1, 1 after: with the right-hand side held at its left limit the last step before the jump is exact.
TEST(Integrator, StepsSeeOneSideOfAJump) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4"}) {
    TestOde ode(1, [](double t, const auto&, auto y_dot) { y_dot[0] = t < 1 ? 0 : 1; });
    const auto stepper = make_integrator(integrator, ode, make_options(1, 1e-6, 0.3));
    const double latest = std::nextafter(1.0, 0.0);
    stepper->reset(0, VectorXd::Zero(1), 1, latest);
    while (stepper->time() < 1) stepper->step(1);
    EXPECT_EQ(stepper->time(), 1) << integrator;
    EXPECT_LE(ode.latest, latest) << integrator;
    VectorXd y(1);
    stepper->calc_state(1, y);
    EXPECT_EQ(y[0], 0) << integrator;
    stepper->reset(1, y, 2, 2);
    while (stepper->time() < 2) stepper->step(2);
    stepper->calc_state(2, y);
    EXPECT_NEAR(y[0], 1, 1e-12) << integrator;
  }
}

TEST(Integrator, CountsSurviveARestart) {
  for (const std::string integrator : {"adams", "rk", "radau", "rk4"}) {
    TestOde ode = make_oscillator();
    const auto stepper = make_integrator(integrator, ode, make_options(2, 1e-6, 0.1));
    const VectorXd y = integrate(*stepper, Vector2d(1, 0), 1);
    const long before = stepper->statistics().num_steps;
    EXPECT_GT(before, 0);
    stepper->reset(1, y, 2, 2);
    while (stepper->time() < 2) stepper->step(2);
    EXPECT_GT(stepper->statistics().num_steps, before) << integrator;
    EXPECT_GT(stepper->statistics().num_evaluations, stepper->statistics().num_steps) << integrator;
  }
}

TEST(Integrator, ExceptionsOfTheEquationsArrive) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4"}) {
    TestOde ode(1, [](double t, const auto& y, auto y_dot) {
      if (t > 0.5) throw std::domain_error("no further");
      y_dot[0] = -y[0];
    });
    const auto stepper = make_integrator(integrator, ode, make_options(1, 1e-8, 0.01));
    EXPECT_THROW(integrate(*stepper, VectorXd::Ones(1), 1), std::domain_error) << integrator;
    EXPECT_LE(stepper->time(), 0.5) << integrator;
    EXPECT_GT(stepper->time(), 0.4) << integrator;
  }
}

// At its largest step CVODE kept the order it came with: 1. Adams of order 1 at h = 1e-3 errs by 1e-3.
TEST(Integrator, OrderRisesAtTheLargestStep) {
  for (const std::string integrator : {"adams", "bdf"}) {
    TestOde ode = make_oscillator();
    const auto stepper = make_integrator(integrator, ode, make_options(2, 1e-10, 1e-3));
    const VectorXd y = integrate(*stepper, Vector2d(1, 0), 10);
    EXPECT_GE(stepper->statistics().order, 3) << integrator;
    EXPECT_LT((y - Vector2d(std::cos(20.0), -2 * std::sin(20.0))).norm(), 1e-8) << integrator;
  }
}

// A largest step below 1e-13 of the stretch is below the smallest one that is asked for.
TEST(Integrator, TinyLargestStepIsNoBrokenContract) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau"}) {
    TestOde ode = make_oscillator();
    const auto stepper = make_integrator(integrator, ode, make_options(2, 1e-8, 1e-12));
    stepper->reset(0, Vector2d(1, 0), 20, 20);
    for (int i = 0; i < 100; ++i) stepper->step(20);
    EXPECT_GT(stepper->time(), 0) << integrator;
    EXPECT_LT(stepper->time(), 2e-10) << integrator;
  }
}

// Anywhere within the last step as exactly as at its end.
TEST(Integrator, StatesWithinTheLastStep) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4"}) {
    TestOde ode = make_oscillator();
    const auto stepper = make_integrator(integrator, ode, make_options(2, 1e-9, integrator == "rk4" ? 0.01 : 0));
    stepper->reset(0, Vector2d(1, 0), 10, 10);
    VectorXd y(2);
    double worst = 0;
    while (stepper->time() < 10) {
      stepper->step(10);
      for (double share : {0.0, 0.3, 0.9, 1.0}) {
        const double t = stepper->last_time() + share * (stepper->time() - stepper->last_time());
        stepper->calc_state(std::min(t, stepper->time()), y);
        worst = std::max(worst, std::abs(y[0] - std::cos(2 * t)));
      }
    }
    EXPECT_LT(worst, calc_error_bound(integrator == "rk4" ? "rk" : integrator, 1e-9) * (integrator == "bdf" ? 2 : 1))
        << integrator;
  }
}

TEST(Integrator, PassesAStopWithItsHistory) {
  TestOde ode = make_oscillator();
  const auto stepper = make_integrator("adams", ode, make_options(2, 1e-9));
  stepper->reset(0, Vector2d(1, 0), 5, 5);
  while (stepper->time() < 5) stepper->step(5);
  EXPECT_EQ(stepper->time(), 5);
  const int order = stepper->statistics().order;
  EXPECT_GT(order, 3);
  stepper->set_stop(10, 10);
  stepper->step(10);
  EXPECT_GE(stepper->statistics().order, order - 1);
  while (stepper->time() < 10) stepper->step(10);
  EXPECT_NEAR(stepper->state()[0], std::cos(20.0), 1e-6);
}

// Trial steps may leave the domain of the equations; the step that fails later fails for its own reason.
TEST(Integrator, AnExceptionOfARejectedTrialIsForgotten) {
  int calls = 0;
  TestOde ode(1, [&](double, const auto&, auto y_dot) {
    if (++calls == 3) throw std::domain_error("a trial");
    y_dot[0] = calls < 40 ? 1 : std::nan("");
  });
  GuardedOde guarded(ode);
  const double y = 0;
  double y_dot = 0;
  int failures = 0;
  for (int i = 0; i < 5; ++i) failures += guarded.calc(i, &y, &y_dot);
  EXPECT_EQ(failures, 1);
  EXPECT_NO_THROW(guarded.throw_pending());
  calls = 50;
  EXPECT_EQ(guarded.calc(7, &y, &y_dot), 1);
  EXPECT_TRUE(guarded.was_non_finite());
  EXPECT_EQ(guarded.bad_time(), 7);
}

// ẏ = y² from 1: infinite at t = 1.
TEST(Integrator, BlowUpIsAFailureNotASilence) {
  for (const std::string integrator : {"adams", "bdf", "rk", "radau", "rk4"}) {
    TestOde ode(1, [](double, const auto& y, auto y_dot) { y_dot[0] = y[0] < 1e6 ? y[0] * y[0] : std::nan(""); });
    const auto stepper = make_integrator(integrator, ode, make_options(1, 1e-8, 0.001));
    try {
      integrate(*stepper, VectorXd::Ones(1), 2);
      ADD_FAILURE() << integrator;
    } catch (const StepFailure& failure) {
      EXPECT_EQ(failure.kind, StepFailure::Kind::NonFinite) << integrator;
      EXPECT_NEAR(failure.time, 1, 0.01) << integrator;
    }
  }
}

}  // namespace
}  // namespace bough::solver
