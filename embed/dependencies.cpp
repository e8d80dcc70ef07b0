#include "embed/dependencies.hpp"

#include <algorithm>

#include "formats/records/signal_name.hpp"

namespace bough::embed {
namespace {

using solver::BlockKind;
using solver::BlockSlot;
using solver::TreeBody;

void fill(std::vector<bool>& rows, int first, int count) { std::fill_n(rows.begin() + first, count, true); }

bool reads_motion(const BlockSlot& place) { return place.block->kind == BlockKind::Sensor || place.actuator >= 0; }

}  // namespace

void DependencyGraph::Set::add(const Set& other) {
  const auto merge = [](std::vector<bool>& to, const std::vector<bool>& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = to[i] || from[i];
  };
  merge(q, other.q);
  merge(u, other.u);
  merge(z, other.z);
  merge(inputs, other.inputs);
}

DependencyGraph::Set DependencyGraph::make_set() const {
  const auto zeros = [](std::size_t n) { return std::vector<bool>(n, false); };
  return {zeros(static_cast<std::size_t>(system_.num_q())), zeros(static_cast<std::size_t>(system_.num_u())),
          zeros(static_cast<std::size_t>(system_.num_z())), zeros(spec_.inputs.size())};
}

DependencyGraph::DependencyGraph(const solver::System& system, const records::SystemSpec& spec)
    : system_(system), spec_(spec) {
  const auto& places = system.signals.places;
  block_of_.resize(static_cast<std::size_t>(system.signals.num_values));
  int num_inputs = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::fill_n(block_of_.begin() + places[i].out, places[i].block->sizes.outputs, static_cast<int>(i));
    input_of_.push_back(places[i].block->kind == BlockKind::Input ? num_inputs++ : -1);
  }
  BOUGH_DEMAND(num_inputs == static_cast<int>(spec.inputs.size()));
  // Nothing leads from accelerations to loads without a sample or a state: they come second.
  accelerations_ = make_set();
  follow_signals();
  // Every acceleration depends on all positions, rates and loads: the recursion and closed loops couple them.
  Set all = make_set();
  all.q.assign(all.q.size(), true);
  all.u.assign(all.u.size(), true);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].actuator < 0) continue;
    all.add(of_outputs_[i]);
    fill(all.z, places[i].state, places[i].block->sizes.states);
    if (places[i].block->sizes.has_feedthrough && !places[i].is_sampled()) add_sources(places[i], all);
  }
  accelerations_ = std::move(all);
  follow_signals();
}

void DependencyGraph::follow_signals() {
  const auto& signals = system_.signals;
  of_outputs_.assign(signals.places.size(), make_set());
  for (const int i : signals.order) {
    const auto at = static_cast<std::size_t>(i);
    of_outputs_[at] = find_of_block(signals.places[at]);
  }
}

void DependencyGraph::add_source(int value, Set& set) const {
  set.add(of_outputs_[static_cast<std::size_t>(block_of_[static_cast<std::size_t>(value)])]);
}

void DependencyGraph::add_sources(const BlockSlot& place, Set& set) const {
  for (const int value : place.sources) add_source(value, set);
}

void DependencyGraph::add_motion(const BlockSlot& place, Set& set) const {
  place.block->mark_motion(system_.tree, set.q, set.u);
  if (place.block->sizes.reads_acceleration) set.add(accelerations_);
}

DependencyGraph::Set DependencyGraph::find_of_block(const BlockSlot& place) const {
  Set set = make_set();
  const auto& sizes = place.block->sizes;
  const auto index = static_cast<std::size_t>(&place - system_.signals.places.data());
  if (input_of_[index] >= 0) set.inputs[static_cast<std::size_t>(input_of_[index])] = true;
  if (place.is_sampled()) return set;
  fill(set.z, place.state, sizes.states);
  // Outputs of actuators without feedthrough may read the motion, as the back EMF of a motor with a lag does.
  if (reads_motion(place) && (sizes.has_feedthrough || place.actuator >= 0)) add_motion(place, set);
  if (sizes.has_feedthrough) add_sources(place, set);
  return set;
}

void DependencyGraph::add_chain(int body, bool with_rates, Set& set) const {
  for (int b = body; b >= 0; b = system_.tree[b].parent) {
    const TreeBody& tb = system_.tree[b];
    fill(set.q, tb.q_offset, tb.num_hinge_q() + tb.num_modes());
    if (with_rates) fill(set.u, tb.u_offset, tb.num_hinge_u() + tb.num_modes());
  }
}

Dependencies DependencyGraph::make(const Set& set) const {
  Dependencies found;
  int row = 0;
  for (const auto* rows : {&set.q, &set.u, &set.z})
    for (const bool is_in : *rows) {
      if (is_in) found.states.push_back(row);
      ++row;
    }
  for (std::size_t i = 0; i < set.inputs.size(); ++i)
    if (set.inputs[i]) found.inputs.push_back(static_cast<int>(i));
  return found;
}

Dependencies DependencyGraph::find_of_derivative(int row) const {
  const int num_q = system_.num_q(), num_u = system_.num_u(), num_z = system_.num_z();
  Set set = make_set();
  if (row < num_q) {  // q_dot = N(q) u of one hinge; of a mode, its rate
    for (const TreeBody& tb : system_.tree.bodies) {
      const int mode = row - tb.eta_offset();
      if (mode >= 0 && mode < tb.num_modes()) return {{num_q + tb.eta_dot_offset() + mode}, {}, false, true};
      if (row < tb.q_offset || row >= tb.eta_offset()) continue;
      fill(set.q, tb.q_offset, tb.num_hinge_q());
      fill(set.u, tb.u_offset, tb.num_hinge_u());
      Dependencies found = make(set);
      found.on_time = !tb.motion.empty();
      return found;
    }
  }
  if (row < num_q + num_u || row >= num_q + num_u + num_z - system_.num_momentum_out()) {
    set = accelerations_;
    // Power of what is applied: all that loads depend on, and accelerations where a motion is prescribed.
    return make(set);
  }
  for (const auto& place : system_.signals.places) {
    const int state = row - num_q - num_u - place.state;
    if (state < 0 || state >= place.block->sizes.states) continue;
    fill(set.z, place.state, place.block->sizes.states);
    add_sources(place, set);
    if (reads_motion(place)) add_motion(place, set);
    if (place.actuator >= 0) set.add(accelerations_);
    return make(set);
  }
  return make(accelerations_);
}

std::optional<Dependencies> DependencyGraph::find_of_channel(const std::string& path) const {
  if (const auto* place = system_.signals.find(path))
    return make(of_outputs_[static_cast<std::size_t>(place - system_.signals.places.data())]);
  const int work = system_.layout().work();
  if (path == "/energy/work") return Dependencies{{work}, {}, false, true};
  if (path == "/energy/dissipated") return Dependencies{{work + 1}, {}, false, true};
  if (path == "/time") return Dependencies{};
  const auto end = path.rfind('/');
  const std::string what = path.substr(end + 1);
  Set set = make_set();
  for (int b = 0; b < system_.num_bodies(); ++b) {
    const TreeBody& tb = system_.tree[b];
    if (path.compare(0, end, "/hinges/" + system_.hinge_name(b)) == 0) {
      if (what != "q" && what != "qdot") return std::nullopt;
      fill(set.q, tb.q_offset, tb.num_hinge_q());
      if (what == "qdot") fill(set.u, tb.u_offset, tb.num_hinge_u());
      return make(set);
    }
    if (path.compare(0, end, "/bodies/" + system_.body_name(b)) == 0) {
      const bool is_rate = what == "velocity" || what == "angular_velocity";
      if (what == "eta" || what == "strain_energy")
        fill(set.q, tb.eta_offset(), tb.num_modes());
      else if (what == "eta_dot")
        fill(set.u, tb.eta_dot_offset(), tb.num_modes());
      else if (is_rate || what == "position" || what == "quaternion")
        add_chain(b, is_rate, set);
      else
        return std::nullopt;
      return make(set);
    }
  }
  return std::nullopt;
}

std::optional<Dependencies> DependencyGraph::find_of_event_function(int i, int count) const {
  // Kinks of forces, switches of blocks, joint contacts, events of signals.
  for (const auto& element : system_.elements) {
    if (i < element->num_kinks()) {
      Set set = make_set();
      set.q.assign(set.q.size(), true);
      set.u.assign(set.u.size(), true);
      return make(set);
    }
    i -= element->num_kinks();
    count -= element->num_kinks();
  }
  for (const auto& place : system_.signals.places) {
    const auto& sizes = place.block->sizes;
    if (i < sizes.event_functions) {
      Set set = make_set();
      fill(set.z, place.state, sizes.states);
      add_sources(place, set);
      if (reads_motion(place)) add_motion(place, set);
      return make(set);
    }
    i -= sizes.event_functions;
    count -= sizes.event_functions;
  }
  const int event = i - (count - static_cast<int>(spec_.events.size()));
  if (event < 0) return std::nullopt;
  const auto& record = spec_.events[static_cast<std::size_t>(event)];
  if (record.time) return Dependencies{};
  return find_of_channel(records::parse_signal_name(record.signal).path);
}

}  // namespace bough::embed
