#include "solver/simulate/simulator.hpp"

#include <algorithm>

#include "solver/signals/input_block.hpp"
#include "solver/simulate/run.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {

RunSetup prepare(const System& system, const records::SystemSpec& spec, Diagnostics& diagnostics) {
  Diagnostics found;
  RunSetup setup = prepare_run(system, spec, found);
  for (const auto& item : found.items()) diagnostics.add_new(item);
  found.throw_if_errors();
  return setup;
}

}  // namespace

Simulator::Simulator(const System& system, const records::SystemSpec& spec, records::ResultSink& sink,
                     const SimulateOptions& options, Diagnostics& diagnostics)
    : run_(std::make_unique<Run>(system, spec, prepare(system, spec, diagnostics), sink, options, diagnostics)) {
  for (const auto& place : system.signals.places) {
    const auto* block = dynamic_cast<const InputBlock*>(place.block.get());
    if (block) inputs_.push_back({block, place.memory});
  }
  rows_.reserve(inputs_.size() * InputBlock::kNumRows);
  run_->begin();
  for (int i = 0; i < num_inputs(); ++i) next_.push_back(get_input(i));
}

Simulator::~Simulator() = default;

double Simulator::time() const { return run_->time(); }
double Simulator::resolution() const { return run_->resolution(); }
std::size_t Simulator::max_step_size() const { return static_cast<std::size_t>(2 + run_->num_states()); }
const std::optional<SimulateOutcome>& Simulator::outcome() const { return run_->outcome(); }
const std::vector<records::Channel>& Simulator::channels() const { return run_->recorder().channels(); }
const Eigen::VectorXd& Simulator::calc_outputs() {
  apply_inputs();
  return run_->is_led() ? run_->calc_continuous_outputs() : run_->calc_outputs();
}

const Eigen::VectorXd& Simulator::calc_outputs(std::span<const int> rows) {
  apply_inputs();
  return run_->calc_outputs(rows);
}

double Simulator::get_input(int i) const {
  const int row = inputs_[static_cast<std::size_t>(i)].memory;
  return InputBlock::calc_value(run_->time(), run_->memory().data() + row);
}

void Simulator::set_inputs(int first, std::span<const double> values) {
  BOUGH_DEMAND(first >= 0 && first + std::ssize(values) <= std::ssize(next_));
  std::copy(values.begin(), values.end(), next_.begin() + first);
  is_set_ = true;
}

void Simulator::hold_inputs(double t) {
  // A value that is reached at t, not at once, waits for a t that lies ahead.
  const double now = run_->time();
  bool has_waiting = false;
  has_slopes_ = false;
  rows_.clear();
  for (int i = 0; i < num_inputs(); ++i) {
    const auto& input = inputs_[static_cast<std::size_t>(i)];
    const double next = next_[static_cast<std::size_t>(i)], value = get_input(i);
    const double* memory = run_->memory().data() + input.memory;
    const bool is_ramp = input.block->is_linear();
    const bool has_slope = memory[InputBlock::kNext] != memory[InputBlock::kValue];
    if (is_ramp && t <= now) {
      has_waiting = has_waiting || next != value;
      has_slopes_ = has_slopes_ || has_slope;
      continue;
    }
    // A constant value needs no new row, and dividing a run then changes nothing; but after a slope the line has a kink
    // here, which ends the step.
    if (next == value && memory[InputBlock::kNext] == next && memory[InputBlock::kUntil] <= now && !has_slope) continue;
    has_slopes_ = has_slopes_ || (is_ramp && next != value);
    const double line[] = {now, is_ramp ? value : next, is_ramp ? t : now, next};
    for (int k = 0; k < InputBlock::kNumRows; ++k) rows_.emplace_back(input.memory + k, line[k]);
  }
  is_set_ = has_waiting;
  if (!rows_.empty()) run_->set_held(rows_);
}

void Simulator::advance_to(double t) {
  if (is_set_ || has_slopes_) hold_inputs(t);
  run_->advance_to(t);
}

int Simulator::num_states() const { return run_->num_states(); }
const Eigen::VectorXd& Simulator::state() const { return run_->state(); }
std::string Simulator::name_state(int row) const { return run_->name_state(row); }
int Simulator::num_event_functions() const { return run_->num_event_functions(); }
std::vector<std::string> Simulator::list_event_functions() const { return run_->list_event_functions(); }
double Simulator::next_event_time() { return run_->next_event_time(); }
bool Simulator::needs_projection() { return run_->needs_projection(); }

void Simulator::set_continuous(double t, const Eigen::Ref<const Eigen::VectorXd>& x) { run_->set_continuous(t, x); }

void Simulator::calc_derivatives(Eigen::Ref<Eigen::VectorXd> x_dot) {
  apply_inputs();
  run_->calc_derivatives(x_dot);
}

void Simulator::calc_event_functions(Eigen::Ref<Eigen::VectorXd> g) {
  apply_inputs();
  run_->calc_event_functions(g);
}

Eigen::VectorXd Simulator::differentiate(const Eigen::VectorXd& dx, std::span<const double> du) {
  BOUGH_DEMAND(run_->is_led() && std::ssize(du) == num_inputs());
  apply_inputs();
  std::vector<std::pair<int, double>> rows;
  for (int i = 0; i < num_inputs(); ++i) {
    const double change = du[static_cast<std::size_t>(i)];
    if (change == 0) continue;
    for (const int row : {InputBlock::kValue, InputBlock::kNext})
      rows.emplace_back(inputs_[static_cast<std::size_t>(i)].memory + row, change);
  }
  return run_->differentiate(dx, rows);
}

bool Simulator::update_discrete() {
  run_->lead();
  apply_inputs();
  return run_->update_discrete();
}

void Simulator::apply_inputs() {
  if (!is_set_) return;
  if (run_->is_led())
    put_inputs();
  else
    hold_inputs(run_->time());
}

void Simulator::put_inputs() {
  for (int i = 0; i < num_inputs(); ++i) {
    const double next = next_[static_cast<std::size_t>(i)];
    const double line[] = {0, next, 0, next};
    for (int k = 0; k < InputBlock::kNumRows; ++k)
      run_->put_memory(inputs_[static_cast<std::size_t>(i)].memory + k, line[k]);
  }
  is_set_ = false;
}

records::Checkpoint Simulator::save() const {
  auto saved = run_->save_state();
  saved.memory.emplace_back("inputs", Eigen::Map<const Eigen::VectorXd>(next_.data(), std::ssize(next_)));
  return saved;
}

void Simulator::restore(const records::Checkpoint& saved) {
  run_->restore_state(saved);
  const auto* next = saved.find("inputs");
  if (next && next->size() == std::ssize(next_)) std::copy_n(next->data(), next->size(), next_.begin());
  is_set_ = true;
}

}  // namespace bough::solver
