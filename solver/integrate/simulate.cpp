#include "solver/integrate/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "solver/integrate/linear_limit.hpp"
#include "solver/integrate/plan.hpp"
#include "solver/integrate/recorder.hpp"
#include "solver/integrate/stepper.hpp"
#include "solver/integrate/system_ode.hpp"

namespace bough::solver {
namespace {

/// Samples between checkpoints.
constexpr int kCheckpointEvery = 100;

std::string text_of(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

std::string short_text(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

records::ResultsHeader make_header(const records::SystemSpec& spec, const RunPlan& plan, const Recorder& recorder) {
  const auto& s = spec.simulation;
  records::ResultsHeader header;
  header.system_text = spec.text;
  header.channels = recorder.channels();
  header.settings = {{"integrator", s.integrator},
                     {"start", text_of(s.start)},
                     {"duration", text_of(s.duration)},
                     {"output_step", text_of(plan.output_step)},
                     {"step", text_of(plan.step)},
                     {"relative_tolerance", text_of(s.relative_tolerance)},
                     {"absolute_tolerance", text_of(s.absolute_tolerance)},
                     {"divergence_limit", text_of(s.divergence_limit)},
                     {"gravity", text_of(s.gravity.x()) + " " + text_of(s.gravity.y()) + " " + text_of(s.gravity.z())}};
  return header;
}

/// One run: the state of the loop and what it writes to.
class Run {
 public:
  Run(const System& system, const records::SystemSpec& spec, RunPlan plan, Sensors sensors, records::ResultSink& sink,
      const SimulateOptions& options, Diagnostics& diagnostics)
      : spec_(spec),
        sink_(sink),
        options_(options),
        diagnostics_(diagnostics),
        plan_(std::move(plan)),
        ode_(system),
        recorder_(system, std::move(sensors)),
        limit_(system) {
    StepperOptions o;
    o.relative_tolerance = spec.simulation.relative_tolerance;
    o.absolute_tolerance = VectorXd::Constant(ode_.size(), spec.simulation.absolute_tolerance);
    // The work is a quadrature: it follows the motion's accuracy and must not set the step.
    o.absolute_tolerance[ode_.size() - 1] = 1e100;
    o.step = plan_.step;
    stepper_ = make_stepper(spec.simulation.integrator, ode_, o);
    y_ = y_dot_ = VectorXd::Zero(ode_.size());
    progress_.start = plan_.outputs.front();
    progress_.end = plan_.outputs.back();
  }

  SimulateOutcome go() {
    y_ = ode_.make_initial_state();
    size_t next = 0;  // output
    double t = plan_.outputs.front();
    if (options_.resume) {
      next = find_resume_output();
      t = plan_.outputs[next];
    }
    checkpoint_ = {t, y_};
    sink_.begin(make_header(spec_, plan_, recorder_));
    set_energy_reference();
    if (options_.resume) {
      y_ = options_.resume->state;
      checkpoint_ = *options_.resume;
      checkpoint_.time = t;
      guard([&] { ode_.calc_derivative(t, y_, y_dot_); });
    } else {
      write_sample(t);
    }
    ++next;
    for (const Segment& segment : plan_.segments) {
      if (segment.end <= t) continue;
      stepper_->restart(t, y_, segment.end, segment.latest);
      for (; next < plan_.outputs.size() && plan_.outputs[next] <= segment.end; ++next) {
        const double t_out = plan_.outputs[next];
        if (!advance(t_out)) return stop();
        guard([&] { stepper_->calc_state(t_out, y_); });
        if (t_out == segment.end) cross_jump(segment);
        write_sample(t_out);
        if (next % kCheckpointEvery == 0) sink_.write_checkpoint(checkpoint_);
        if (is_stop_asked() && next + 1 < plan_.outputs.size()) return stop();
      }
      t = segment.end;
      if (plan_.outputs[next - 1] == t) continue;
      if (!advance(t)) return stop();
      stepper_->calc_state(t, y_);
      cross_jump(segment);
    }
    sink_.write_checkpoint(checkpoint_);
    sink_.end(true, "");
    return {true, t, "", progress_};
  }

 private:
  bool is_stop_asked() const { return options_.stop && options_.stop->load(std::memory_order_relaxed); }

  size_t find_resume_output() {
    const records::Checkpoint& c = *options_.resume;
    const double tolerance = 1e-9 * plan_.output_step;
    const auto it = std::lower_bound(plan_.outputs.begin(), plan_.outputs.end(), c.time - tolerance);
    const bool on_grid = it != plan_.outputs.end() && std::abs(*it - c.time) <= tolerance;
    if (on_grid && c.state.size() == ode_.size() && c.state.allFinite())
      return static_cast<size_t>(it - plan_.outputs.begin());
    throw InputError("run.bad-checkpoint", spec_.simulation.at,
                     "the checkpoint at t = " + short_text(c.time) + " with " + std::to_string(c.state.size()) +
                         " states does not belong to this system, which has " + std::to_string(ode_.size()) +
                         " and samples every " + short_text(plan_.output_step),
                     "resume with the system file the run was started with, or start it again");
  }

  /// Steps until t; false when a stop was asked for. Checks every step.
  bool advance(double t) {
    while (stepper_->time() < t) {
      if (is_stop_asked()) return false;
      const double before = stepper_->time();
      guard([&] { stepper_->step(t); });
      const auto coordinates = stepper_->state().head(ode_.num_coordinates());
      int row = 0;
      const double largest = coordinates.cwiseAbs().maxCoeff(&row);
      if (!(largest <= spec_.simulation.divergence_limit)) fail_diverged(stepper_->time(), row);
      const double taken = stepper_->time() - before;
      num_tiny_ = taken < 1e-11 * (progress_.end - progress_.start) ? num_tiny_ + 1 : 0;
      if (num_tiny_ > 1000) fail_stalled(before, "1000 steps in a row were shorter than " + short_text(taken));
    }
    return true;
  }

  void cross_jump(const Segment& segment) {
    if (segment.end >= progress_.end) return;
    guard([&] {
      for (const auto& what : ode_.cross_jump(segment.latest, segment.end, y_)) sink_.write_event({segment.end, what});
    });
  }

  void write_sample(double t) {
    guard([&] { ode_.calc_derivative(t, y_, y_dot_); });
    const int num_q = ode_.num_q();
    const auto q = y_.head(num_q), u = y_.segment(num_q, ode_.num_coordinates() - num_q);
    const double work = y_[ode_.size() - 1];
    sink_.write_sample(recorder_.calc_sample(t, ode_.data(), q, u, work));
    checkpoint_.time = t;
    checkpoint_.state = y_;
    watch_linear_limit(t, q);
    update_progress(t, work);
    if (options_.progress) options_.progress(progress_);
  }

  void watch_linear_limit(double t, const Eigen::Ref<const VectorXd>& q) {
    while (const auto crossing = limit_.find_crossing(q)) {
      const std::string what = "body '" + crossing->body + "' deflects by " + short_text(crossing->deflection) +
                               " at node " + std::to_string(crossing->node) + " at t = " + short_text(t) +
                               ", more than 10 % of its size " + short_text(crossing->size);
      sink_.write_event({t, what});
      diagnostics_.warning("run.linear-limit", spec_.simulation.at, what,
                           "linear modes lose their meaning there; split the body into several");
    }
  }

  void set_energy_reference() {
    guard([&] { ode_.calc_derivative(plan_.outputs.front(), y_, y_dot_); });
    const Energies e = calc_energies(ode_.system(), ode_.data());
    energy_start_ = e.kinetic + e.strain + e.potential;
  }

  void update_progress(double t, double work) {
    const Energies& e = recorder_.energies();
    for (double part : {e.kinetic, e.strain, e.potential, work})
      energy_scale_ = std::max(energy_scale_, std::abs(part));
    const double error = e.kinetic + e.strain + e.potential - work - energy_start_;
    const StepStatistics s = stepper_->statistics();
    progress_.time = t;
    progress_.step = s.step;
    progress_.order = s.order;
    progress_.num_steps = s.num_steps;
    progress_.num_rejected = s.num_rejected;
    progress_.num_evaluations = s.num_evaluations;
    progress_.energy_error = energy_scale_ > 0 ? error / energy_scale_ : 0;
  }

  SimulateOutcome stop() {
    sink_.write_checkpoint(checkpoint_);
    const std::string reason = "stopped on request at t = " + short_text(checkpoint_.time);
    sink_.end(false, reason);
    return {false, checkpoint_.time, reason, progress_};
  }

  /// Runs what evaluates the equations; on failure closes the sink first, so that the samples so far are kept.
  template <class Action>
  void guard(const Action& action) {
    try {
      action();
    } catch (const StepFailure& failure) {
      if (failure.kind == StepFailure::Kind::Stalled) fail_stalled(failure.time, failure.detail);
      fail_diverged(failure.time, find_largest_row());
    } catch (const Failure& failure) {
      sink_.end(false, failure.what());
      throw;
    }
  }

  int find_largest_row() const {
    int row = 0;
    stepper_->state().head(ode_.num_coordinates()).cwiseAbs().maxCoeff(&row);
    return row;
  }

  [[noreturn]] void fail_diverged(double t, int row) {
    const double value = stepper_->state()[row];
    const std::string what = "the run diverged at t = " + short_text(t) + ": " + ode_.name_row(row) + " reached " +
                             short_text(value) + ", limit " + short_text(spec_.simulation.divergence_limit);
    finish_failed(t, "run.diverged", what,
                  "look for an unstable system, missing stiffening or a step that is too long; [simulation] "
                  "divergence_limit sets the limit");
  }

  [[noreturn]] void fail_stalled(double t, const std::string& detail) {
    const bool explicit_method = spec_.simulation.integrator != "bdf";
    finish_failed(t, "run.stalled", "the integrator makes no progress at t = " + short_text(t) + ": " + detail,
                  explicit_method
                      ? "loosen relative_tolerance, or use integrator = \"bdf\" when fast modes are damped out"
                      : "loosen relative_tolerance, or leave out the fastest modes");
  }

  [[noreturn]] void finish_failed(double t, const char* id, const std::string& what, const std::string& advice) {
    sink_.write_event({t, what});
    sink_.end(false, what);
    throw ComputationError(id, spec_.simulation.at, what, advice);
  }

  const records::SystemSpec& spec_;
  records::ResultSink& sink_;
  const SimulateOptions& options_;
  Diagnostics& diagnostics_;
  RunPlan plan_;
  SystemOde ode_;
  Recorder recorder_;
  LinearLimit limit_;
  std::unique_ptr<Stepper> stepper_;
  VectorXd y_, y_dot_;
  records::Checkpoint checkpoint_;
  Progress progress_;
  double energy_start_ = 0, energy_scale_ = 0;
  int num_tiny_ = 0;
};

}  // namespace

SimulateOutcome simulate(const System& system, const records::SystemSpec& spec, records::ResultSink& sink,
                         const SimulateOptions& options, Diagnostics& diagnostics) {
  const int errors = diagnostics.num_errors();
  Sensors sensors = Sensors::build(system, spec, diagnostics);
  RunPlan plan = make_run_plan(spec.simulation, system.breakpoints(), diagnostics);
  if (diagnostics.num_errors() > errors) diagnostics.throw_if_errors();
  return Run(system, spec, std::move(plan), std::move(sensors), sink, options, diagnostics).go();
}

}  // namespace bough::solver
