// Directional derivatives of a run that an integrator of the host leads.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/simulate/run.hpp"
#include "solver/system/law_difference.hpp"
#include "solver/system/system.hpp"
#include "solver/tree/coordinates.hpp"

namespace bough::solver {
namespace {

/// Change of a value of a signal, relative to it: linear models take as much.
constexpr double kSignalStep = 1e-2;

}  // namespace

VectorXd Run::calc_state_steps() const {
  const System& system = ode_.system();
  const int num_q = ode_.num_q(), num_u = ode_.num_coordinates() - num_q;
  VectorXd steps = calc_displacement_steps(system.tree);
  const double far = calc_far_step(ode_.data().tree);
  for (const TreeBody& tb : system.tree.bodies)
    for (int i = 0; i < tb.num_hinge_u(); ++i)
      if (is_translation(tb, i)) steps[tb.u_offset + i] = std::max(steps[tb.u_offset + i], far);
  VectorXd all = VectorXd::Constant(ode_.size(), std::numeric_limits<double>::infinity());
  const double fastest = num_u > 0 ? y_.segment(num_q, num_u).lpNorm<Eigen::Infinity>() : 0;
  all.segment(num_q, num_u) = steps * std::max(1.0, fastest);
  for (const TreeBody& tb : system.tree.bodies) {
    // A quaternion has one coordinate more than rates and comes first.
    const int more = tb.num_hinge_q() - tb.num_hinge_u();
    for (int i = 0; i < tb.num_hinge_q() + tb.num_modes(); ++i)
      all[tb.q_offset + i] = steps[tb.u_offset + std::max(0, i - more)];
  }
  for (int i = 0; i < ode_.num_z(); ++i) {
    const int row = ode_.num_coordinates() + i;
    all[row] = 0.1 * std::max(1.0, std::abs(y_[row]));
  }
  return all;
}

VectorXd Run::differentiate(const VectorXd& dx, const std::vector<std::pair<int, double>>& dmemory) {
  BOUGH_DEMAND(dx.size() == ode_.size());
  const double t = calc_seen_time();
  const int num_q = ode_.num_q(), num_u = ode_.num_coordinates() - num_q;
  SystemData& data = ode_.data();
  VectorXd& memory = data.signals.memory;
  const VectorXd memory_here = memory;
  VectorXd x = y_, x_dot = y_dot_;
  double step = std::numeric_limits<double>::infinity();
  const VectorXd steps = calc_state_steps();
  for (Eigen::Index i = 0; i < dx.size(); ++i)
    if (dx[i] != 0) step = std::min(step, steps[i] / std::abs(dx[i]));
  for (const auto& [row, change] : dmemory)
    step = std::min(step, kSignalStep * std::max(1.0, std::abs(memory[row])) / std::abs(change));
  if (!std::isfinite(step)) step = 1;  // work and dissipated energy: nothing depends on them
  evaluated_.number = -1;
  struct Restore {
    VectorXd& memory;
    const VectorXd& here;
    ~Restore() { memory = here; }
  } restore{memory, memory_here};
  LawTangents tangents;
  const Difference d = differentiate_system(
      data, tangents,
      [&](double h) {
        x = y_ + h * dx;
        memory = memory_here;
        for (const auto& [row, change] : dmemory) memory[row] += h * change;
        ode_.calc_derivative(t, x, x_dot);
        calc_signals(ode_.system(), data);
        const VectorXd& sample = setup_.recorder.calc_sample(
            {t, data, x.head(num_q), x.segment(num_q, num_u), ode_.get_work(x), ode_.get_dissipated(x)});
        VectorXd all(x_dot.size() + sample.size());
        all << x_dot, sample;
        return all;
      },
      step, lies_far(ode_.system().tree, data.tree));
  return d.calc_clean();
}

}  // namespace bough::solver
