#include <algorithm>

#include "solver/simulate/run.hpp"

namespace bough::solver {

void Run::check_resume() {
  const records::Checkpoint& c = *options_.resume;
  const double slack = 1e-9 * setup_.plan.output_step;
  if (c.time >= time_events_.start() - slack && c.time <= time_events_.end() + slack && c.state.size() == ode_.size() &&
      c.state.allFinite() && is_memory_good(c))
    return;
  throw InputError("run.bad-checkpoint", spec_.simulation.at,
                   "the checkpoint at t = " + short_text(c.time) + " with " + std::to_string(c.state.size()) +
                       " states does not belong to this system, which has " + std::to_string(ode_.size()) +
                       " and runs from " + short_text(time_events_.start()) + " to " + short_text(time_events_.end()),
                   "resume with the system file the run was started with, or start it again");
}

bool Run::is_memory_good(const records::Checkpoint& c) const {
  return std::all_of(checkpoint_.memory.begin(), checkpoint_.memory.end(), [&](const auto& part) {
    const VectorXd* found = c.find(part.first);
    return !found || found->size() == part.second.size();
  });
}

double Run::restore(const records::Checkpoint& c) {
  checkpoint_.time = c.time;
  checkpoint_.state = y_ = c.state;
  if (const auto* m = c.find("energy")) monitor_.set_memory(*m);
  if (const auto* m = c.find("quaternions")) setup_.recorder.quaternions = *m;
  if (const auto* m = c.find("limits")) limit_.set_memory(*m);
  if (const auto* m = c.find("stepper")) restored_.memory = {{"stepper", *m}};
  if (const auto* m = c.find("discrete")) {
    ode_.set_memory(*m);
    if (!ode_.system().num_levels.empty()) set_variant();
  }
  if (const auto* m = c.find("latches")) joint_contacts_.set_memory(*m, ode_);
  time_events_.skip_outputs(c.time);
  if (const auto* m = c.find("control")) set_control_memory(*m);
  take_samples(c.time);
  iterate_contacts(c.time);
  start_signal_events(c.time);
  if (const auto* m = c.find("events")) {
    passed_ = (*m)[0];
    setup_.triggers.signs = m->tail(m->size() - 1);
  }
  return c.time;
}

void Run::fill_checkpoint(double t) {
  checkpoint_.time = t;
  checkpoint_.state = y_;
  monitor_.get_memory(checkpoint_.memory[0].second);
  checkpoint_.memory[1].second = setup_.recorder.quaternions;
  limit_.get_memory(checkpoint_.memory[2].second);
  checkpoint_.memory[3].second[0] = passed_;
  checkpoint_.memory[3].second.tail(setup_.triggers.signs.size()) = setup_.triggers.signs;
  checkpoint_.memory[4].second = integrator_->memory();
  ode_.get_memory(checkpoint_.memory[5].second);
  get_control_memory(checkpoint_.memory[6].second);
  joint_contacts_.get_memory(checkpoint_.memory[7].second);
}

void Run::save(double t) {
  fill_checkpoint(t);
  sink_.write_energy_error(monitor_.worst());
  sink_.write_checkpoint(checkpoint_);
  saved_at_ = std::chrono::steady_clock::now();
}

void Run::save_now_and_then() {
  if (std::chrono::steady_clock::now() - saved_at_ < options_.checkpoint_after) return;
  y_ = integrator_->state();
  save(integrator_->time());
}

SimulateOutcome Run::halt(double t) {
  save(t);
  const std::string reason = "stopped on request at t = " + short_text(t);
  sink_.end(false, reason);
  return {false, t, reason, progress_, monitor_.worst(), true};
}

}  // namespace bough::solver
