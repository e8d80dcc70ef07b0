#include "solver/simulate/stiffening_advice.hpp"

#include <algorithm>

#include "solver/motion/stiffening_terms.hpp"
#include "solver/simulate/modal_range_monitor.hpp"
#include "solver/simulate/run.hpp"
#include "solver/system/derivative.hpp"

namespace bough::solver {
namespace {

constexpr int kNumLooks = 400;

/// The start, and where a force or a prescribed motion has its extreme value among evenly spaced times and its jumps.
std::vector<double> list_times(const System& system, const FunctionCopies& functions, double start, double end) {
  std::vector<double> looks, times = {start};
  for (int i = 0; i <= kNumLooks; ++i) looks.push_back(start + (end - start) * i / kNumLooks);
  for (const auto* list : {&system.jump_times, &system.mesh_times})
    for (const double t : *list)
      if (t > start && t <= end) looks.push_back(t);
  const auto add_extremes = [&](const auto& calc) {
    const auto is_less = [&](double a, double b) { return calc(a) < calc(b); };
    const auto [min_time, max_time] = std::minmax_element(looks.begin(), looks.end(), is_less);
    if (calc(*min_time) != calc(start)) times.push_back(*min_time);
    if (calc(*max_time) != calc(start)) times.push_back(*max_time);
  };
  for (const AppliedForce& force : system.forces)
    if (force.function != nullptr) add_extremes([&](double t) { return functions[*force.function].calc(t).f; });
  for (const TreeBody& tb : system.tree.bodies)
    for (const TimeFunction* motion : tb.motion) {
      if (motion == nullptr || system.loops.size() > 0) continue;
      add_extremes([&](double t) { return functions[*motion].calc(t).f_dot; });
      add_extremes([&](double t) { return functions[*motion].calc(t).f_ddot; });
    }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// -min eig of K⁻¹ K_G: the loads over the critical ones; 0 where no multiple of them is critical.
double calc_share(const MatrixXd& K, const MatrixXd& KG) {
  const Eigen::LLT<MatrixXd> factor(0.5 * (K + K.transpose()));
  if (factor.info() != Eigen::Success || !KG.allFinite()) return 0;
  const MatrixXd half = factor.matrixL().solve(KG), both = factor.matrixL().solve(half.transpose());
  return std::max(0.0, -Eigen::SelfAdjointEigenSolver<MatrixXd>(both, Eigen::EigenvaluesOnly).eigenvalues()[0]);
}

}  // namespace

std::set<int> warn_of_unstiffened_bodies(const System& system, double start, double end, const SourceLocation& at,
                                         Diagnostics& diagnostics) {
  ModalRangeMonitor limit(system);
  std::set<int> spinning;
  const auto is_null = [](const auto& terms) { return terms == nullptr; };
  if (!limit.watches_spins() && std::all_of(system.left_out.begin(), system.left_out.end(), is_null)) return spinning;
  struct Worst {
    double share = 0, time = 0;
  };
  std::vector<Worst> worst(system.left_out.size());
  const auto data = system.make_data();
  const VectorXd z = data->signals.z;
  VectorXd q = VectorXd::Zero(system.num_q()), u = VectorXd::Zero(system.num_u()), u_dot = u;
  for (const double t : list_times(system, data->tree.functions, start, end)) {
    try {
      system.calc_initial_state(q, u);
      calc_motion(system, *data, t, q, u, z, u_dot, [] {});
    } catch (const Failure&) {
      continue;  // the run itself reports it
    }
    for (const ModalRangeMonitor::Crossing& spin : limit.find_spins(t, *data)) {
      diagnostics.warning(spin.id, at, spin.what, spin.advice);
      spinning.insert(spin.body);
    }
    for (size_t b = 0; b < worst.size(); ++b) {
      if (system.left_out[b] == nullptr) continue;
      VectorXd loads(system.left_out[b]->num_loads());
      system.left_out[b]->calc_loads(get_motion(system, *data), loads.data());
      const double share =
          calc_share(system.tree[static_cast<int>(b)].body.K(), system.left_out[b]->calc_stiffness(loads.data()));
      if (share > worst[b].share) worst[b] = {share, t};
    }
  }
  for (size_t b = 0; b < worst.size(); ++b) {
    if (!(worst[b].share > kLoadLimit)) continue;
    diagnostics.warning("run.unstiffened-load", at,
                        "body '" + system.body_name(static_cast<int>(b)) +
                            "' has no stiffening and its loads at t = " + short_text(worst[b].time) + " are " +
                            short_text(worst[b].share) + " of the critical ones (from 1 on it buckles)",
                        "set stiffening = true for this body");
  }
  return spinning;
}

}  // namespace bough::solver
