#include "solver/simulate/run_options.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "solver/forces/central_gravity.hpp"
#include "solver/simulate/stiffening_advice.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

namespace {

// Largest frequency of a body's modes with its frame held; 0 without modes.
double calc_largest_frequency(const Body& body) {
  const int n = body.num_modes();
  if (n == 0) return 0;
  const MatrixXd M = body.make_inertia().M_modal.topLeftCorner(n, n), K = 0.5 * (body.K() + body.K().transpose());
  if (Eigen::LLT<MatrixXd>(M).info() != Eigen::Success) return 0;
  const VectorXd values =
      Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M, Eigen::EigenvaluesOnly).eigenvalues();
  return std::sqrt(std::max(0.0, values[n - 1]));
}

// Explicit steps follow every mode, wanted or not.
void hint_at_fast_modes(const System& system, const RunSetup& setup, const SourceLocation& at,
                        Diagnostics& diagnostics) {
  double fastest = 0;
  int where = 0;
  for (int b = 0; b < system.num_bodies(); ++b) {
    const double own = calc_largest_frequency(system.tree[b].body);
    if (own <= fastest) continue;
    fastest = own;
    where = b;
  }
  const double turned = fastest * setup.plan.output_step;
  if (turned <= kFastMode) return;
  std::ostringstream what;
  what << "integrator " << setup.integrator << " follows the fastest mode of body '" << system.body_name(where) << "', "
       << fastest << " rad per unit of time, " << turned << " rad between samples";
  diagnostics.note("run.fast-modes", at, what.str(),
                   "integrator = \"auto\", \"bdf\" or \"radau\" damps such modes out, \"implicit\" at a fixed step; or "
                   "keep fewer modes");
}

/// Samples of a run are counted before it starts: each ends a step.
void check_samples(const System& system, const RunPlan& plan, Diagnostics& diagnostics) {
  constexpr double kMaxSamples = 1e8, kMaxWithoutWarning = 1e7;
  const BlockSlot* finest = nullptr;
  for (const BlockSlot& p : system.signals.places) {
    if (!p.is_sampled()) continue;
    if (!finest || p.block->sizes.sample_time < finest->block->sizes.sample_time) finest = &p;
  }
  if (!finest) return;
  const double count = (plan.end - plan.start) / finest->block->sizes.sample_time;
  if (!(count > kMaxWithoutWarning)) return;
  std::ostringstream what;
  what << finest->block->label << " has a sample_time of " << finest->block->sizes.sample_time << ", which makes "
       << count << " samples in the run";
  if (count > kMaxSamples)
    diagnostics.error("run.many-samples", finest->block->at, what.str() + ", more than 1e8",
                      "give a longer sample_time or a shorter duration");
  else
    diagnostics.warning("run.many-samples", finest->block->at, what.str(),
                        "each ends a step of the integrator; a longer sample_time is faster");
}

}  // namespace

RunSetup prepare_run(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics) {
  bool is_valid = true;
  for (int b = 0; b < system.num_bodies(); ++b) is_valid = is_valid && system.is_valid(b);
  is_valid = is_valid && system.signals_are_valid;
  RunSetup setup{make_run_plan(spec.simulation, diagnostics), Outputs(system), {}, {}, {}, {}};
  if (is_valid) setup.recorder.choose(spec.simulation.record, spec.simulation.at, diagnostics);
  setup.triggers = UserEvents::build(spec, setup.recorder, is_valid, diagnostics);
  setup.changes = EventActions::build(system, spec, is_valid, diagnostics);
  if (is_valid && diagnostics.num_errors() == 0)
    setup.spins_reported =
        warn_of_unstiffened_bodies(system, setup.plan.start, setup.plan.end, spec.simulation.at, diagnostics);
  if (is_valid && diagnostics.num_errors() == 0) check_samples(system, setup.plan, diagnostics);
  setup.integrator = spec.simulation.integrator;
  if (setup.integrator == "adams" && system.num_constraints() > 0) {
    diagnostics.note("run.integrator-chosen", spec.simulation.at,
                     "integrator rk is taken: adams does not project onto constraints");
    setup.integrator = "rk";
  }
  if (setup.integrator == "auto" && diagnostics.num_errors() == 0)
    setup.integrator = choose_integrator(system, spec.simulation, setup.plan.output_step, diagnostics);
  else if ((setup.integrator == "adams" || setup.integrator == "rk") && is_valid && diagnostics.num_errors() == 0)
    hint_at_fast_modes(system, setup, spec.simulation.at, diagnostics);
  return setup;
}

double calc_fastest_frequency(const System& system) {
  const Tree& tree = system.tree;
  MatrixXd K = MatrixXd::Zero(tree.num_u, tree.num_u);
  for (const TreeBody& tb : tree.bodies) {
    const int n = tb.body.num_modes();
    K.block(tb.eta_dot_offset(), tb.eta_dot_offset(), n, n) = tb.body.K();
    for (int i = 0; i < std::min<int>(tb.num_hinge_u(), static_cast<int>(tb.stiffness.size())); ++i)
      if (tb.mode[static_cast<size_t>(i)] != HingeMode::Prescribed)
        K(tb.u_offset + i, tb.u_offset + i) = tb.stiffness[i];
  }
  if (K.isZero(0)) return 0;
  const auto data = system.make_data();
  VectorXd q(system.num_q()), u(system.num_u()), force;
  system.calc_initial_state(q, u);
  calc_kinematics(system, *data, system.start, q, u);
  add_forces(system, *data, system.start);
  MatrixXd M;
  calc_dense_equations(tree, data->tree, M, force);
  const Eigen::LLT<MatrixXd> factor(M);
  if (factor.info() != Eigen::Success) return 0;
  // The largest eigenvalue of L⁻¹ K L⁻ᵀ.
  MatrixXd A = factor.matrixL().solve(MatrixXd(0.5 * (K + K.transpose())));
  A = factor.matrixL().solve(MatrixXd(A.transpose()));
  const double largest = Eigen::SelfAdjointEigenSolver<MatrixXd>(0.5 * (A + A.transpose()), Eigen::EigenvaluesOnly)
                             .eigenvalues()
                             .tail(1)[0];
  return std::sqrt(std::max(0.0, largest));
}

std::string choose_integrator(const System& system, const records::SimulationRecord& simulation, double output_step,
                              Diagnostics& diagnostics) {
  const double fastest = calc_fastest_frequency(system);
  std::ostringstream why;
  std::string choice = "adams";
  if (fastest * output_step > kFastMode) {
    const auto is_central = [](const auto& e) { return dynamic_cast<const CentralGravity*>(e.get()) != nullptr; };
    const bool is_orbit = std::any_of(system.elements.begin(), system.elements.end(), is_central);
    choice = is_orbit ? "radau" : "bdf";
    why << "the fastest mode swings at " << fastest << " rad per unit of time, " << fastest * output_step
        << " rad between samples, which explicit steps would have to follow; " << choice << " damps it out"
        << (is_orbit ? ", at an order for long orbits" : "");
  } else if (system.num_constraints() > 0) {
    choice = "rk";
    why << "it projects onto constraints, and steps can follow the fastest mode, " << fastest
        << " rad per unit of time";
  } else if (simulation.relative_tolerance < 1e-10) {
    choice = "rk";
    why << "relative_tolerance " << simulation.relative_tolerance << " is cheaper to meet at order 8";
  } else {
    why << "the fastest mode swings at " << fastest << " rad per unit of time, which steps can follow";
  }
  diagnostics.note("run.integrator-chosen", simulation.at, "integrator " + choice + " is taken: " + why.str());
  return choice;
}

}  // namespace bough::solver
