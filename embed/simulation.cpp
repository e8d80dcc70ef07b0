#include "embed/simulation.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/version.hpp"
#include "embed/state_bytes.hpp"

namespace bough::embed {
namespace {

void apply(const SimulationOptions& o, records::SimulationRecord& s) {
  if (!o.integrator.empty()) s.integrator = o.integrator;
  if (o.step > 0) s.step = o.step;
  if (o.relative_tolerance > 0) s.relative_tolerance = o.relative_tolerance;
  if (o.absolute_tolerance > 0) s.absolute_tolerance = o.absolute_tolerance;
  if (!(o.duration > 0)) return;
  // Samples stay where they are, since fixed steps divide the time between them.
  if (s.output_step == 0) s.output_step = s.duration / 1000;
  s.duration = o.duration;
  s.output_step = std::min(s.output_step, s.duration);
}

/// Hash of all that must be the same where a state is restored: text, options, version and bodies.
std::uint64_t calc_fingerprint(const LoadedSystem& loaded, const records::SystemSpec& spec) {
  const auto& s = spec.simulation;
  const std::string text = spec.text + '\0' + s.integrator + '\0' + std::string(get_version());
  std::uint64_t hash = calc_hash(std::as_bytes(std::span(text)));
  const auto add = [&](const auto& matrix) {
    hash = calc_hash(std::as_bytes(std::span(matrix.data(), static_cast<std::size_t>(matrix.size()))), hash);
  };
  const std::vector<double> numbers{s.start, s.duration,           s.output_step,
                                    s.step,  s.relative_tolerance, s.absolute_tolerance};
  add(numbers);
  for (const auto& [name, body] : loaded.flex) {
    add(std::vector<double>{body.mass});
    for (const auto* matrix : {&body.modal_mass, &body.modal_stiffness, &body.modal_damping, &body.node_xyz})
      add(*matrix);
    for (const auto& phi : body.phi) add(phi);
    add(body.inertia);
    add(body.cg);
  }
  return hash;
}

}  // namespace

std::string to_text(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 9).ptr;
  return {text, end};
}

std::string describe_fault(const SimulationOptions& o) {
  const std::pair<const char*, double> numbers[] = {{"step", o.step},
                                                    {"relative_tolerance", o.relative_tolerance},
                                                    {"absolute_tolerance", o.absolute_tolerance},
                                                    {"duration", o.duration}};
  for (const auto& [name, value] : numbers)
    if (!std::isfinite(value) || value < 0)
      return std::string("the option ") + name + " is " + to_text(value) +
             ": give a positive number, or 0 for that of the file";
  return {};
}

records::SystemSpec change_spec(records::SystemSpec spec, const SimulationOptions& options) {
  apply(options, spec.simulation);
  return spec;
}

Simulation::Simulation(const LoadedSystem& loaded, records::SystemSpec spec, solver::SimulateOptions run)
    : spec_(std::move(spec)), run_(std::move(run)) {
  fingerprint_ = calc_fingerprint(loaded, spec_);
  simulator_ = std::make_unique<solver::Simulator>(loaded.system, spec_, sink_, run_, diagnostics_);
  state_size_ = encode_state(simulator_->save(), 0).size() + simulator_->max_step_size() * sizeof(double);
}

bool Simulation::advance_to(double t) {
  const bool had_ended = simulator_->outcome().has_value();
  if (!had_ended) simulator_->advance_to(t);
  const auto& outcome = simulator_->outcome();
  if (!outcome) return true;
  if (!had_ended && !outcome->energy_is_kept) throw ComputationError({diagnostics_.items().back()});
  return false;
}

std::string Simulation::describe_past(double t) const {
  return "the time " + to_text(t) + " lies before " + to_text(simulator_->time()) + ", which is reached";
}

std::string Simulation::describe_event_before(double t) const {
  return "an event is due at t = " + to_text(simulator_->next_event_time()) + ", before " + to_text(t);
}

std::string Simulation::describe_end() const {
  const auto& outcome = *simulator_->outcome();
  if (!outcome.reason.empty()) return outcome.reason;
  return "the run has reached its end at t = " + to_text(outcome.time) +
         "; a longer duration may be given at its start";
}

void Simulation::save(std::span<std::byte> to) const {
  const auto bytes = encode_state(simulator_->save(), fingerprint_);
  BOUGH_DEMAND(bytes.size() <= to.size());
  std::copy(bytes.begin(), bytes.end(), to.begin());
  std::fill(to.begin() + std::ssize(bytes), to.end(), std::byte{0});
}

void Simulation::restore(std::span<const std::byte> from) {
  simulator_->restore(decode_state(from, fingerprint_, state_size_));
}

}  // namespace bough::embed
