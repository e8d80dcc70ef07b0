// Corners of forces: steps of adaptive methods end where a contact closes or opens, a stop is met, a cable goes taut.
// Error estimates look at few moments of a step (Fehlberg's 8(7) at its two ends only), and would miss what is between.
#include "solver/integrate/locate.hpp"
#include "solver/integrate/run.hpp"
#include "solver/system/impl.hpp"

namespace bough::solver {
namespace {
/// Of the largest value so far: a function that trembles about zero within that has no corner.
constexpr double kTremble = 1e-12;
}  // namespace

void Run::start_corners(double t) {
  int num = 0;
  // At fixed steps results depend on the targets only.
  if (setup_.integrator != "rk4" && setup_.integrator != "implicit")
    for (const auto& element : ode_.system().impl().elements) num += element->num_corners();
  corners_ = last_corners_ = largest_corners_ = corners_at_end_ = VectorXd::Zero(num);
  if (num == 0) return;
  last_corners_ = calc_corners(t);
  largest_corners_ = last_corners_.cwiseAbs();
}

const VectorXd& Run::calc_corners(double t) {
  guard([&] { ode_.calc_derivative(t, y_, y_dot_); });
  const System::Impl& impl = ode_.system().impl();
  double* g = corners_.data();
  for (const auto& element : impl.elements) {
    element->calc_corners(impl.tree, ode_.data().tree, g);
    g += element->num_corners();
  }
  return corners_;
}

void Run::leave_corners(double t) {
  if (corners_.size() > 0) last_corners_ = calc_corners(t);
}

double Run::find_corner(const Stop& stop) {
  const double from = stepper_->last_time(), to = stepper_->time();
  if (corners_.size() == 0) return to;
  const auto calc = [&](double t) -> const VectorXd& {
    guard([&] { stepper_->calc_state(t, y_); });
    return calc_corners(std::min(t, stop.latest));
  };
  corners_at_end_ = calc(to);
  double first = to;
  for (Eigen::Index i = 0; i < corners_at_end_.size(); ++i) {
    const double before = last_corners_[i], after = corners_at_end_[i];
    largest_corners_[i] = std::max(largest_corners_[i], std::abs(after));
    const bool trembles = std::max(std::abs(before), std::abs(after)) < kTremble * largest_corners_[i];
    if (before * after >= 0 || trembles) continue;
    const double at =
        locate_crossing([&](double t) { return calc(t)[i]; }, from, before, to, after, timeline_.resolution());
    first = std::min(first, at);
  }
  last_corners_ = first < to ? calc(first) : corners_at_end_;
  return first;
}

}  // namespace bough::solver
