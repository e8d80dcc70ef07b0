#include "solver/simulate/event_actions.hpp"

#include <algorithm>

#include "solver/system/system.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {
namespace {

using records::EventAction;

template <class Name>
std::string find_near(const std::string& requested, int count, const Name& get_name) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back(get_name(i));
  return suggest_name(requested, names, "declare it");
}

void report(const records::UserEventRecord& r, const char* id, const std::string& what, const std::string& advice,
            Diagnostics& diagnostics) {
  diagnostics.error(id, r.at, "event '" + r.name + "' " + what, advice);
}

/// Returns true if the file has a record of this name: one that is not in the system has an error already.
template <class Record>
bool has_record(const std::vector<Record>& records, const std::string& name) {
  return std::any_of(records.begin(), records.end(), [&](const Record& record) { return record.name == name; });
}

/// Rows of u of the coordinates an event names: all of an orientation, or none of it.
std::vector<int> find_rows(const System& system, int body, const records::UserEventRecord& r,
                           Diagnostics& diagnostics) {
  const TreeBody& tb = system.tree[body];
  const int num = tb.num_hinge_u();
  std::vector<bool> named(static_cast<size_t>(num), r.coordinates.empty());
  for (const int c : r.coordinates) {
    if (c >= 1 && c <= num)
      named[static_cast<size_t>(c) - 1] = true;
    else
      report(r, "run.bad-event",
             "names coordinate " + std::to_string(c) + " of hinge '" + r.target + "', which has " + std::to_string(num),
             "coordinates count from 1, as in 'rate'", diagnostics);
  }
  if (num == 0)
    report(r, "run.bad-event", "names hinge '" + r.target + "', which has no coordinates",
           "connect a body that an event releases by a free hinge that starts locked", diagnostics);
  if (!tb.hinge->has_independent_coordinates() && (named[0] != named[1] || named[0] != named[2]))
    report(r, "run.bad-event", "names some of the three rates of the orientation of hinge '" + r.target + "'",
           "name all three or none", diagnostics);
  std::vector<int> rows;
  for (int i = 0; i < num; ++i) {
    if (named[static_cast<size_t>(i)]) rows.push_back(tb.u_offset + i);
  }
  return rows;
}

/// Place of a controller in the signal graph; -1 with errors reported.
int find_controller(const System& system, const records::UserEventRecord& r, Diagnostics& diagnostics) {
  const auto& places = system.signals.places;
  const std::string folder = "/controllers/";
  std::vector<std::string> names;
  for (size_t i = 0; i < places.size(); ++i) {
    const Block& block = *places[i].block;
    if (!block.path.starts_with(folder)) continue;
    names.push_back(block.name);
    if (block.name != r.target) continue;
    if (r.action != EventAction::Switch) return static_cast<int>(i);
    if (r.choice >= 1 && r.choice <= block.num_choices()) return static_cast<int>(i);
    report(r, "run.bad-event",
           block.num_choices() == 0 ? "switches controller '" + r.target + "', whose input no event chooses"
                                    : "names input " + std::to_string(r.choice) + " of controller '" + r.target +
                                          "', which has " + std::to_string(block.num_choices()),
           "a controller of type switch with two inputs is switched by events; they count from 1", diagnostics);
    return -1;
  }
  report(r, "run.unknown-target", "names controller '" + r.target + "', which does not exist",
         find_near(r.target, static_cast<int>(names.size()), [&](int i) { return names[static_cast<size_t>(i)]; }),
         diagnostics);
  return -1;
}

/// Body of a level event; -1 with errors reported.
int find_levels(const System& system, const records::SystemSpec& spec, const records::UserEventRecord& r,
                Diagnostics& diagnostics) {
  const int body = system.find_body(r.target);
  if (body < 0) {
    if (!has_record(spec.bodies, r.target))
      report(r, "run.unknown-target", "names body '" + r.target + "', which does not exist",
             find_near(r.target, system.num_bodies(), [&](int i) { return system.body_name(i); }), diagnostics);
    return -1;
  }
  const int count = system.num_levels.empty() ? 1 : system.num_levels[static_cast<size_t>(body)];
  if (count > 1 && r.choice >= 1 && r.choice <= count) return body;
  report(r, "run.bad-event",
         count == 1 ? "switches the level of body '" + r.target + "', which has none"
                    : "names level " + std::to_string(r.choice) + " of body '" + r.target + "', which has " +
                          std::to_string(count),
         "give the body levels, a list of files; they count from 1", diagnostics);
  return -1;
}

}  // namespace

EventActions EventActions::build(const System& system, const records::SystemSpec& spec, bool is_valid,
                                 Diagnostics& diagnostics) {
  EventActions made;
  for (const auto& r : spec.events) {
    Change change;
    change.action = r.action;
    const bool is_hinge = r.action == EventAction::Lock || r.action == EventAction::Release;
    const bool is_constraint = r.action == EventAction::Break || r.action == EventAction::Close;
    if (is_hinge) {
      const int body = system.find_hinge(r.target);
      if (body >= 0 && is_valid)
        change.rows = find_rows(system, body, r, diagnostics);
      else if (body < 0 && is_valid && !has_record(spec.hinges, r.target))
        report(r, "run.unknown-target", "names hinge '" + r.target + "', which does not exist",
               find_near(r.target, system.num_bodies(), [&](int i) { return system.hinge_name(i); }), diagnostics);
      change.text = "hinge '" + r.target + "'";
      for (size_t i = 0; i < r.coordinates.size(); ++i)
        change.text += (i == 0 ? ": coordinate " : ", ") + std::to_string(r.coordinates[i]);
      change.text += r.action == EventAction::Lock ? " is locked" : " is released";
    } else if (is_constraint) {
      change.constraint = system.find_constraint(r.target);
      if (change.constraint < 0 && is_valid && !has_record(spec.constraints, r.target))
        report(r, "run.unknown-target", "names constraint '" + r.target + "', which does not exist",
               find_near(r.target, system.num_constraints(), [&](int i) { return system.constraint_name(i); }),
               diagnostics);
      change.text = "constraint '" + r.target + (r.action == EventAction::Break ? "' is broken" : "' is to close");
    } else if (r.action == EventAction::Level) {
      if (is_valid) change.body = find_levels(system, spec, r, diagnostics);
      change.choice = r.choice - 1;
      change.text = "body '" + r.target + "' gets level " + std::to_string(r.choice);
    } else if (r.action == EventAction::Enable || r.action == EventAction::Disable || r.action == EventAction::Switch) {
      if (is_valid) change.place = find_controller(system, r, diagnostics);
      change.choice = r.choice - 1;
      change.text = "controller '" + r.target + "'" +
                    (r.action == EventAction::Enable    ? " is enabled"
                     : r.action == EventAction::Disable ? " is disabled"
                                                        : " passes on its input " + std::to_string(r.choice));
    }
    made.changes_.push_back(std::move(change));
  }
  return made;
}

DiscreteState EventActions::apply(size_t trigger, HybridSystem& ode, double t, const VectorXd& y) const {
  const Change& change = changes_[trigger];
  if (change.place >= 0) {
    const BlockSlot& p = ode.system().signals.places[static_cast<size_t>(change.place)];
    VectorXd& memory = ode.data().signals.memory;
    if (change.action == EventAction::Switch)
      p.block->choose(change.choice, memory.data() + p.memory);
    else
      memory[p.activity] = change.action == EventAction::Enable ? 1 : 0;
  }
  DiscreteState next = get_discrete(ode.data());
  for (const int row : change.rows)
    next.mode[static_cast<size_t>(row)] = change.action == EventAction::Lock ? HingeMode::Locked : HingeMode::Free;
  if (change.body >= 0) {
    const System& system = ode.system();
    const int variant = system.find_variant(system.variant, change.body, change.choice);
    if (variant != system.variant) next.variant = variant;
  }
  if (change.constraint < 0) return next;
  ConstraintState& state = next.constraints[static_cast<size_t>(change.constraint)];
  if (change.action == EventAction::Break) state.is_closed = false;
  if (change.action == EventAction::Close && !state.is_closed) state = ode.find_as_closed(t, y, change.constraint);
  return next;
}

}  // namespace bough::solver
