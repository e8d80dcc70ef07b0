#include "analysis/common/start_modes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "solver/builder/build.hpp"

namespace bough::analysis {
namespace {

using records::ConstraintRecord;
using records::HingeRecord;
using solver::HingeMode;

constexpr Eigen::Index kConstraintNumbers = 22;  ///< of HybridSystem::get_memory(): closed, R, p, gap, q
constexpr Eigen::Index kContactNumbers = 4;      ///< of JointContacts::get_memory(): 2 where the contact sticks

/// Inboard hinge of a body of the earlier run.
struct EarlierHinge {
  const HingeRecord* record = nullptr;  ///< nullptr: the free hinge of a body without one
  std::string name, body;
  Eigen::Index row = 0;  ///< of its first rate in u; those of the modes of the body follow
  int num_u = 6;
  Eigen::Index num_modes = 0;
};

struct EarlierRows {
  std::vector<EarlierHinge> hinges;  ///< in the order of the tree
  Eigen::Index num_q = 0, num_u = 0;
};

constexpr double kSameTime = 1e-12;  ///< of the time

bool has_event_at_end(const hdf5::ResultsFile& results, double t) {
  return std::any_of(results.events.begin(), results.events.end(), [&](const records::EventRecord& event) {
    return event.time >= t - kSameTime * std::abs(t) && event.source.starts_with("event ");
  });
}

EarlierRows find_rows(const records::SystemSpec& before, const hdf5::ResultsFile& results) {
  Diagnostics ignored;  // the run reported them
  const auto order = solver::order_tree(before, ignored);
  EarlierRows rows;
  for (std::size_t b = 0; b < order.body.size(); ++b) {
    const auto& body = before.bodies[static_cast<std::size_t>(order.body[b])];
    EarlierHinge hinge{nullptr, body.name, body.name, rows.num_u};
    int num_q = 7;
    if (order.hinge[b] >= 0) {
      hinge.record = &before.hinges[static_cast<std::size_t>(order.hinge[b])];
      hinge.name = hinge.record->name;
      const auto made = solver::make_hinge(*hinge.record, ignored);
      hinge.num_u = made ? made->num_u() : 0;
      num_q = made ? made->num_q() : 0;
    }
    if (const auto eta = results.channels.find("/bodies/" + body.name + "/eta"); eta != results.channels.end())
      hinge.num_modes = eta->second.cols();
    rows.num_q += num_q + hinge.num_modes;
    rows.num_u += hinge.num_u + hinge.num_modes;
    rows.hinges.push_back(std::move(hinge));
  }
  return rows;
}

bool is_given(const std::vector<std::string>& motion, int i) {
  return static_cast<std::size_t>(i) < motion.size() && !motion[static_cast<std::size_t>(i)].empty();
}

HingeMode get_first_mode(const EarlierHinge& hinge, int i) {
  if (!hinge.record) return HingeMode::Free;
  const auto& locked = hinge.record->locked;
  if (static_cast<std::size_t>(i) < locked.size() && locked[static_cast<std::size_t>(i)]) return HingeMode::Locked;
  return is_given(hinge.record->motion, i) ? HingeMode::Prescribed : HingeMode::Free;
}

/// Returns true if both constrain the same bodies alike; their initial state (closed or open) may differ.
bool is_same(const ConstraintRecord& a, const ConstraintRecord& b) {
  const auto is_same_term = [](const ConstraintRecord::Term& x, const ConstraintRecord::Term& y) {
    return x.hinge == y.hinge && x.coordinate == y.coordinate && x.ratio == y.ratio;
  };
  return a.type == b.type && a.hinge == b.hinge && a.parent == b.parent && a.child == b.child &&
         a.parent_node == b.parent_node && a.child_node == b.child_node && a.parent_position == b.parent_position &&
         a.child_position == b.child_position && a.parent_rotation == b.parent_rotation &&
         a.child_rotation == b.child_rotation && a.axis == b.axis && a.axis2 == b.axis2 && a.rotations == b.rotations &&
         a.translations == b.translations && a.pitch == b.pitch && a.length == b.length && a.offset == b.offset &&
         std::equal(a.terms.begin(), a.terms.end(), b.terms.begin(), b.terms.end(), is_same_term);
}

class ModeSetter {
 public:
  ModeSetter(records::SystemSpec& spec, std::string path, Diagnostics& diagnostics)
      : spec_(spec), path_(std::move(path)), diagnostics_(diagnostics) {}

  const StartModes& found() const { return found_; }

  /// \param modes  of its rates, at the end of the run.
  void set_hinge(const EarlierHinge& hinge, const std::vector<HingeMode>& modes) {
    std::vector<int> locked, released;
    for (int i = 0; i < hinge.num_u; ++i) {
      const HingeMode mode = modes[static_cast<std::size_t>(i)];
      if (mode != get_first_mode(hinge, i)) (mode == HingeMode::Locked ? locked : released).push_back(i);
    }
    if (locked.empty() && released.empty()) return;
    const std::string text = describe(hinge, locked, "locked") + (locked.empty() || released.empty() ? "" : ", ") +
                             describe(hinge, released, "released");
    const auto has_name = [&](const HingeRecord& h) { return h.name == hinge.name; };
    const auto found = std::find_if(spec_.hinges.begin(), spec_.hinges.end(), has_name);
    if (found == spec_.hinges.end()) return warn(text + ", but this system has no such hinge");
    Diagnostics ignored;
    const auto made = solver::make_hinge(*found, ignored);
    if (!made || made->num_u() != hinge.num_u || found->type != (hinge.record ? hinge.record->type : found->type))
      return warn(text + ", but in this system the hinge is of another type");
    found->locked.resize(modes.size(), false);
    for (const int i : locked) found->locked[static_cast<std::size_t>(i)] = true;
    for (const int i : released) found->locked[static_cast<std::size_t>(i)] = false;
    for (const auto* changed : {&locked, &released})
      for (const int i : *changed)
        if (is_given(found->motion, i)) found->motion[static_cast<std::size_t>(i)].clear();
    add(text);
  }

  /// \param variant  of the fill levels, at the end of the run (solver::System::get_level).
  void set_levels(const records::SystemSpec& before, const EarlierRows& rows, int variant) {
    for (const auto& hinge : rows.hinges) {
      const auto is_it = [&](const records::BodyRecord& body) { return body.name == hinge.body; };
      const auto old = std::find_if(before.bodies.begin(), before.bodies.end(), is_it);
      const int count = old == before.bodies.end() ? 1 : std::max(1, static_cast<int>(old->levels.size()));
      const auto level = static_cast<std::size_t>(variant % count);
      variant /= count;
      if (count == 1 || old->levels[level] == old->file) continue;
      const std::string text = fmt::format("body '{}' at level {}", hinge.body, level + 1);
      const auto body = std::find_if(spec_.bodies.begin(), spec_.bodies.end(), is_it);
      if (body == spec_.bodies.end() || static_cast<int>(body->levels.size()) != count) {
        warn(text + ", but in this system it has other levels");
        continue;
      }
      body->file = body->levels[level];
      add(text);
    }
  }

  /// \param numbers  kConstraintNumbers of the checkpoint.
  void set_constraint(const ConstraintRecord& before, const Eigen::VectorXd& numbers) {
    const bool is_closed = numbers[0] > 0.5;
    solver::ConstraintState state;
    state.R = numbers.segment<9>(1).reshaped(3, 3);
    state.p = numbers.segment<3>(10);
    state.gap = numbers.segment<2>(13);
    const bool has_offset = is_closed && !(state.R.isIdentity(0) && state.p.isZero(0) && state.gap.isZero(0));
    if (is_closed == before.active && !has_offset) return;
    const std::string text = fmt::format("constraint '{}' {}", before.name, is_closed ? "closed" : "open");
    const auto has_name = [&](const ConstraintRecord& c) { return c.name == before.name; };
    const auto found = std::find_if(spec_.constraints.begin(), spec_.constraints.end(), has_name);
    if (found == spec_.constraints.end()) return warn(text + ", but this system has no such constraint");
    if (!is_same(*found, before)) return warn(text + ", but in this system the constraint is another one");
    found->active = is_closed && !has_offset;
    if (has_offset) found_.closed.push_back({before.name, state});
    add(text);
  }

  /// \param state  [q; u; ...] of the checkpoint.
  void set_rates(const EarlierRows& rows, const Eigen::VectorXd& state) {
    if (state.size() < rows.num_q + rows.num_u) return;
    const auto get = [&](Eigen::Index row, Eigen::Index size) {
      const auto values = state.segment(rows.num_q + row, size);
      return std::vector<double>(values.begin(), values.end());
    };
    for (const auto& hinge : rows.hinges) {
      found_.hinge_rates[hinge.name] = get(hinge.row, hinge.num_u);
      found_.eta_dot[hinge.body] = get(hinge.row + hinge.num_u, hinge.num_modes);
    }
  }

  void warn(const std::string& message) const {
    diagnostics_.warning("cli.start-modes", {path_}, "its events left " + message,
                         "give the start by locked, motion and active in the system file");
  }

 private:
  static std::string describe(const EarlierHinge& hinge, const std::vector<int>& coordinates, const char* mode) {
    if (coordinates.empty()) return "";
    if (std::ssize(coordinates) == hinge.num_u) return fmt::format("hinge '{}' {}", hinge.name, mode);
    std::string list;
    for (const int i : coordinates) list += (list.empty() ? "" : ", ") + std::to_string(i + 1);
    return fmt::format("coordinate {} of hinge '{}' {}", list, hinge.name, mode);
  }
  void add(const std::string& text) { found_.text += (found_.text.empty() ? "" : ", ") + text; }

  records::SystemSpec& spec_;
  std::string path_;
  Diagnostics& diagnostics_;
  StartModes found_;
};

}  // namespace

StartModes set_start_modes(records::SystemSpec& spec, const records::SystemSpec& before,
                           const hdf5::ResultsFile& results, const std::string& path, Diagnostics& diagnostics) {
  const auto checkpoint = hdf5::find_checkpoint(path);
  const auto* discrete = checkpoint ? checkpoint->find("discrete") : nullptr;
  if (!discrete || results.time.size() == 0) return {};
  ModeSetter setter(spec, path, diagnostics);
  const double t = results.time[results.time.size() - 1];
  const auto is_later = [&](const records::EventRecord& event) {
    return event.time > t + kSameTime * std::abs(t) && event.source.starts_with("event ");
  };
  const auto later = std::find_if(results.events.begin(), results.events.end(), is_later);
  if (later != results.events.end()) {
    setter.warn(fmt::format("modes that are not known at its last sample, t = {:g}: {} came at t = {:g}", t,
                            later->source, later->time));
    return {};
  }
  const auto rows = find_rows(before, results);
  const bool has_levels = std::any_of(before.bodies.begin(), before.bodies.end(),
                                      [](const records::BodyRecord& body) { return !body.levels.empty(); });
  if (discrete->size() != rows.num_u + kConstraintNumbers * std::ssize(before.constraints) + (has_levels ? 1 : 0)) {
    setter.warn("modes of hinges and constraints that do not fit the system in the file");
    return {};
  }
  const auto* contacts = checkpoint->find("latches");
  Eigen::Index contact = 0;
  for (const auto& hinge : rows.hinges) {
    std::vector<HingeMode> modes;
    for (int i = 0; i < hinge.num_u; ++i) {
      auto mode = static_cast<HingeMode>(std::lround((*discrete)[hinge.row + i]));
      if (hinge.record && solver::has_joint_contact(hinge.record->law, i)) {
        // A contact that sticks has locked its coordinate, not an event.
        const Eigen::Index at = kContactNumbers * contact++;
        const bool sticks = contacts && at < contacts->size() && (*contacts)[at] == 2;
        if (sticks && mode == HingeMode::Locked) mode = HingeMode::Free;
      }
      modes.push_back(mode);
    }
    setter.set_hinge(hinge, modes);
  }
  if (has_event_at_end(results, t) && std::abs(checkpoint->time - t) <= kSameTime * std::abs(t))
    setter.set_rates(rows, checkpoint->state);
  Eigen::Index at = rows.num_u;
  for (const auto& constraint : before.constraints) {
    setter.set_constraint(constraint, discrete->segment(at, kConstraintNumbers));
    at += kConstraintNumbers;
  }
  if (has_levels) setter.set_levels(before, rows, static_cast<int>(std::lround((*discrete)[discrete->size() - 1])));
  return setter.found();
}

}  // namespace bough::analysis
