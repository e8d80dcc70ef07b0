#include "modal/response/support_motion.hpp"

#include <tuple>

#include "modal/response/sampled_curve.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::response {
namespace {

std::pair<double, double> evaluate_sides(const ExcitationTerm& term, const TimeGrid& grid, Eigen::Index i) {
  const double t = grid.time(i),
               reach = detail::kSideOfStep * std::min(calc_step_before(grid, i), calc_step_after(grid, i));
  return {i > 0 ? calc_history(term, t, Side::Before, reach) : 0, calc_history(term, t, Side::After, reach)};
}

void add_sides(Sides& s, const ExcitationTerm& term, Eigen::Index i, double before, double after) {
  s.before(term.column, i) += before;
  s.after(term.column, i) += after;
}

void sample_motion(const ExcitationTerm& term, const TimeGrid& grid, SupportMotion& motion) {
  using MotionType = records::DynamicLoad::Excitation;
  const auto type = term.card->excitation;
  const auto nt = grid.time.size();
  VectorXd before(nt), after(nt);
  for (Eigen::Index i = 0; i < nt; ++i) std::tie(before(i), after(i)) = evaluate_sides(term, grid, i);
  const auto curve = type == MotionType::Acceleration ? SampledCurve{} : make_curve(grid.time, before, after);
  double d = 0, v = 0;
  for (Eigen::Index i = 0; i < nt; ++i) {
    const double h = calc_step_before(grid, i);
    if (i > 0 && type == MotionType::Acceleration) {
      d += h * v + h * h * (after(i - 1) / 3 + before(i) / 6);
      v += 0.5 * h * (after(i - 1) + before(i));
    }
    if (i > 0 && type == MotionType::Velocity)
      d += 0.5 * h * (after(i - 1) + before(i)) + h * h / 12 * (curve.slope_after(i - 1) - curve.slope_before(i));
    if (type == MotionType::Acceleration) {
      add_sides(motion.d, term, i, d, d);
      add_sides(motion.d_dot, term, i, v, v);
      add_sides(motion.d_ddot, term, i, before(i), after(i));
    } else if (type == MotionType::Velocity) {
      add_sides(motion.d, term, i, d, d);
      add_sides(motion.d_dot, term, i, before(i), after(i));
      add_sides(motion.d_ddot, term, i, curve.slope_before(i), curve.slope_after(i));
    } else {
      add_sides(motion.d, term, i, before(i), after(i));
      add_sides(motion.d_dot, term, i, curve.slope_before(i), curve.slope_after(i));
      add_sides(motion.d_ddot, term, i, curve.curvature_before(i), curve.curvature_after(i));
    }
  }
}

}  // namespace

double calc_step_before(const TimeGrid& grid, Eigen::Index i) {
  const auto k = std::max<Eigen::Index>(i, 1);
  return grid.time(k) - grid.time(k - 1);
}
double calc_step_after(const TimeGrid& grid, Eigen::Index i) {
  return i + 1 < grid.time.size() ? grid.time(i + 1) - grid.time(i) : calc_step_before(grid, i);
}

SupportMotion sample_support_motion(const Excitation& excitation, const TimeGrid& grid) {
  SupportMotion motion;
  for (auto* s : {&motion.d, &motion.d_dot, &motion.d_ddot})
    s->before = s->after = MatrixXd::Zero(excitation.D.cols(), grid.time.size());
  for (const auto& term : excitation.motions) sample_motion(term, grid, motion);
  return motion;
}

Sides sample_forces(const Excitation& excitation, const TimeGrid& grid) {
  Sides p;
  p.before = p.after = MatrixXd::Zero(excitation.F.cols(), grid.time.size());
  for (Eigen::Index i = 0; i < grid.time.size(); ++i)
    for (const auto& term : excitation.forces) {
      const auto [before, after] = evaluate_sides(term, grid, i);
      add_sides(p, term, i, before, after);
    }
  return p;
}

VectorXd sample_forces_within(const Excitation& excitation, double t) {
  VectorXd p = VectorXd::Zero(excitation.F.cols());
  for (const auto& term : excitation.forces) p(term.column) += calc_history(term, t, Side::Mean, 0);
  return p;
}

}  // namespace bough::modal::response
