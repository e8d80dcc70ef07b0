#include "analysis/common/start_state.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/common/channels.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/toml/specs.hpp"
#include "solver/loops/loops.hpp"

namespace bough::analysis {
namespace {

class Starter {
 public:
  Starter(const hdf5::ResultsFile& results, std::string path, SourceLocation at, Diagnostics& diagnostics)
      : results_(results), path_(std::move(path)), at_(std::move(at)), diagnostics_(diagnostics) {}

  bool has(const std::string& channel) const { return results_.channels.count(channel) > 0; }

  /// The last row; `expected` 0: any size.
  std::vector<double> read(const std::string& channel, std::size_t expected) {
    const auto found = results_.channels.find(channel);
    if (found == results_.channels.end() || found->second.rows() == 0) {
      fail(channel + " is missing");
      return {};
    }
    const Eigen::RowVectorXd row = found->second.bottomRows(1);
    const auto size = static_cast<std::size_t>(row.size());
    if (expected == 0 || size == expected) return {row.begin(), row.end()};
    fail(channel + " has " + std::to_string(size) + " values, expected " + std::to_string(expected));
    return {};
  }

 private:
  void fail(const std::string& what) {
    diagnostics_.error("cli.start-mismatch", at_, "--start-from names " + path_ + ", in which " + what,
                       "start from a file of this system, made by bough run or bough equilibrium");
  }

  const hdf5::ResultsFile& results_;
  std::string path_;
  SourceLocation at_;
  Diagnostics& diagnostics_;
};

/// Returns true for a checkpoint of a run: it contains the energy balance; one of equilibrium does not.
bool is_of_run(const records::Checkpoint& checkpoint) { return checkpoint.find("energy") != nullptr; }

/// Reports the time of the state; warns if the run continued after it.
/// \param modes  changes by its events, as text; empty: none.
void report_time(const records::SystemSpec& spec, const hdf5::ResultsFile& results, const std::string& path,
                 const std::string& modes, Diagnostics& diagnostics) {
  if (results.time.size() == 0) return;  // missing channels are reported one by one
  const double t = results.time[results.time.size() - 1];
  double reached = t;
  bool is_run = true;
  try {
    const auto checkpoint = hdf5::read_checkpoint(path);
    reached = checkpoint.time;
    is_run = is_of_run(checkpoint);
  } catch (const Failure&) {
    // It has none: the last sample is all there is.
  }
  const bool has_memory = std::any_of(spec.sensors.begin(), spec.sensors.end(), [](const auto& sensor) {
    return sensor.chain.has("lag") || sensor.chain.has("delay") || sensor.chain.has("random_walk");
  });
  diagnostics.note(
      "cli.start-state", {path},
      fmt::format("the start is its state at t = {:g}{}", t, modes.empty() ? "" : "; its events left " + modes),
      spec.controllers.empty() && spec.actuators.empty() && !has_memory ? ""
      : !is_run    ? "controllers, actuators and lags start from the states in which they rest there"
      : has_memory ? "controllers, actuators and lag, delay and random walk of sensors start from no state of their "
                     "own, but for momentum of wheels and gimbal angles; bough run --resume continues with their states"
                   : "controllers and lags of actuators start as in the system file; momentum of wheels and gimbal "
                     "angles are those of the file");
  if (reached > t + 1e-12 * std::max(std::abs(reached), std::abs(results.time[0])))
    diagnostics.warning(
        "cli.start-earlier", {path},
        fmt::format("its last sample is of t = {:g}, its run came to t = {:g}: the start is the former", t, reached),
        "take samples up to the end of that run (output_until, output_every), or resume it");
}

/// Momentum of wheels and gimbal angles of gyroscopes, which belong to the motion of the system as its rates do.
void set_rotors(records::SystemSpec& spec, Starter& starter) {
  struct Rotor {
    const char *type, *key;
    std::size_t column, size;  ///< of the channel /actuators/NAME
  };
  constexpr Rotor rotors[] = {
      {"wheel", "momentum", 1, 1}, {"cmg", "angle", 1, 1}, {"double_gimbal_cmg", "angle", 2, 2}};
  for (auto& actuator : spec.actuators) {
    const std::string channel = "/actuators/" + actuator.name;
    const auto* rotor =
        std::find_if(std::begin(rotors), std::end(rotors), [&](const Rotor& one) { return actuator.type == one.type; });
    if (rotor == std::end(rotors) || !starter.has(channel)) continue;
    // Later versions append outputs.
    auto row = starter.read(channel, 0);
    if (row.size() < rotor->column + rotor->size) row = starter.read(channel, rotor->column + rotor->size);
    if (row.empty()) continue;
    const auto first = row.begin() + static_cast<std::ptrdiff_t>(rotor->column);
    std::vector<double> start(first, first + static_cast<std::ptrdiff_t>(rotor->size));
    // Past its limit by rounding after the event at which the wheel reached it.
    const double limit = actuator.settings.get("momentum_limit", 0);
    if (actuator.type == "wheel" && limit > 0) start[0] = std::clamp(start[0], -limit, limit);
    actuator.settings.numbers[rotor->key] = start;
  }
}

}  // namespace

StartPoint set_start_state(records::SystemSpec& spec, const std::string& path, Diagnostics& diagnostics) {
  const auto results = hdf5::read_results(path);
  warn_incomplete(path, diagnostics);
  Starter starter(results, path, spec.simulation.at, diagnostics);
  for (const auto& body : spec.bodies) {
    const auto carries = [&](const records::HingeRecord& hinge) { return hinge.child == body.name; };
    const bool floats = std::none_of(spec.hinges.begin(), spec.hinges.end(), carries);
    if (!floats || !starter.has("/hinges/" + body.name + "/q")) continue;
    records::HingeRecord hinge;
    hinge.name = hinge.child = body.name;
    hinge.type = records::HingeType::Free;
    hinge.at = body.at;
    spec.hinges.push_back(hinge);
  }
  Diagnostics ignored;  // the text was run: its errors were reported then
  const auto before = toml_files::read_system_spec_text(results.system_text, path, ignored);
  auto modes = set_start_modes(spec, before, results, path, diagnostics);
  report_time(spec, results, path, modes.text, diagnostics);
  const auto read_rate = [&](const std::string& channel, std::size_t expected,
                             const std::map<std::string, std::vector<double>>& after, const std::string& name) {
    auto rate = starter.read(channel, expected);
    const auto found = after.find(name);
    return found != after.end() && found->second.size() == rate.size() ? found->second : rate;
  };
  for (auto& body : spec.bodies) {
    if (body.file.empty() || body.num_modes == 0) continue;
    const auto expected = static_cast<std::size_t>(std::max(0, body.num_modes));
    body.eta = starter.read("/bodies/" + body.name + "/eta", expected);
    body.eta_dot = read_rate("/bodies/" + body.name + "/eta_dot", expected, modes.eta_dot, body.name);
  }
  for (auto& tank : spec.tanks) {
    const std::string channel = "/tanks/" + tank.name + "/mass";
    if (!tank.function.empty() || !starter.has(channel)) continue;
    const auto mass = starter.read(channel, 1);
    // Below zero by rounding where a run passed the event at which it was empty.
    if (!mass.empty()) tank.mass = std::max(0.0, mass.front());
  }
  set_rotors(spec, starter);
  StartPoint start;
  start.closed = std::move(modes.closed);
  if (results.time.size() > 0) start.time = results.time[results.time.size() - 1];
  for (auto& hinge : spec.hinges) {
    if (hinge.type == records::HingeType::Fixed) continue;
    const auto is_free = [](const std::string& function) { return function.empty(); };
    const bool is_prescribed = !hinge.motion.empty() && std::none_of(hinge.motion.begin(), hinge.motion.end(), is_free);
    const std::string channel = "/hinges/" + hinge.name;
    if (!is_prescribed) {
      hinge.position = starter.read(channel + "/q", 0);
      hinge.rate = read_rate(channel + "/qdot", 0, modes.hinge_rates, hinge.name);
    }
    if (!hinge.motion.empty() && starter.has(channel + "/q")) start.q[hinge.name] = starter.read(channel + "/q", 0);
  }
  return start;
}

namespace {

void close_constraints(const StartPoint& start, const std::string& path, solver::System& system,
                       Diagnostics& diagnostics) {
  if (start.closed.empty()) return;
  Eigen::VectorXd q(system.num_q()), u(system.num_u());
  system.calc_initial_state(q, u);
  const auto data = system.make_data();
  solver::calc_kinematics(system, *data, system.start, q, u);
  auto states = solver::get_constraint_states(data->loops);
  for (const auto& [name, state] : start.closed) {
    const int i = system.find_constraint(name);
    auto& closed = states[static_cast<std::size_t>(i)];
    closed = solver::find_as_closed(system.loops, system.tree, data->tree, i);  // its q is near
    closed.R = state.R;
    closed.p = state.p;
    closed.gap = state.gap;
  }
  system.initial_constraints = states;
  solver::set_constraint_states(system.loops, system.tree, states, data->loops);
  solver::calc_closure_positions(system.loops, system.tree, data->tree, data->loops);
  constexpr double kClosed = 1e-6;  // a run projects onto the constraints from there
  for (const auto& one : start.closed)
    if (solver::calc_gap(system.loops, data->loops, system.find_constraint(one.name)) > kClosed)
      diagnostics.warning("cli.start-modes", {path},
                          "its events closed constraint '" + one.name + "', which is off in the start of this system",
                          "start from a file of this system, or leave its loops as they are there");
}

void warn_of_jumps(const StartPoint& start, const std::string& path, const solver::System& system,
                   Diagnostics& diagnostics) {
  constexpr double kSame = 1e-9;  // of the larger value; the samples are those of the functions
  Eigen::VectorXd q(system.num_q()), u(system.num_u());
  system.calc_initial_state(q, u);
  for (const auto& tb : system.tree.bodies) {
    const auto found = start.q.find(tb.hinge_name);
    if (found == start.q.end()) continue;
    for (int i = 0; i < std::min<int>(tb.num_hinge_u(), static_cast<int>(found->second.size())); ++i) {
      if (tb.mode[static_cast<std::size_t>(i)] != solver::HingeMode::Prescribed) continue;
      const double before = found->second[static_cast<std::size_t>(i)], after = q[tb.q_offset + i];
      if (std::abs(before - after) <= kSame * std::max({1e-3, std::abs(before), std::abs(after)})) continue;
      diagnostics.warning(
          "cli.start-motion", {path},
          fmt::format("coordinate {} of hinge '{}' starts at {:g} by its prescribed motion, and its state "
                      "at t = {:g} is {:g}",
                      i + 1, tb.hinge_name, after, start.time, before),
          start.time == system.start ? "change the function, or the start would differ from that state"
                                     : fmt::format("set start = {:g} in [simulation]", start.time));
    }
  }
}

}  // namespace

void finish_start(const StartPoint& start, const std::string& path, solver::System& system, Diagnostics& diagnostics) {
  close_constraints(start, path, system, diagnostics);
  warn_of_jumps(start, path, system, diagnostics);
}

std::optional<records::Checkpoint> find_start_control(const std::string& path, const solver::System& system,
                                                      double time, Diagnostics& diagnostics) {
  if (path.empty()) return {};
  records::Checkpoint found;
  try {
    found = hdf5::read_checkpoint(path);
  } catch (const Failure&) {
    return {};
  }
  if (is_of_run(found)) return {};
  const int nq = system.num_q(), nu = system.num_u(), nz = system.num_z();
  const auto* control = found.find("control");
  const Eigen::VectorXd initial = system.signals.make_data().memory;
  const Eigen::Index held = initial.size();
  // An equilibrium has no momentum of expelled mass: it starts at zero.
  const int own = nz - system.num_momentum_out();
  if (found.state.size() != nq + nu + own + 2 || (control ? control->size() - 1 : 0) != held) {
    diagnostics.note("cli.start-state", {path}, "it has other controllers or actuators than this system",
                     "they start as in the system file");
    return {};
  }
  records::Checkpoint start;
  start.time = time;
  start.state = Eigen::VectorXd::Zero(nq + nu + nz + 2);
  system.calc_initial_state(start.state.head(nq), start.state.segment(nq, nu));
  start.state.segment(nq + nu, own) = found.state.segment(nq + nu, own);
  start.memory.emplace_back("start", Eigen::VectorXd::Zero(1));
  if (control) {
    Eigen::VectorXd memory = *control;
    // Inputs start at the values of the system file, as hosts and --set give them.
    for (const auto& place : system.signals.places) {
      const int rows = place.block->kind == solver::BlockKind::Input ? place.block->sizes.memory : 0;
      memory.segment(1 + place.memory, rows) = initial.segment(place.memory, rows);
    }
    start.memory.emplace_back("control", memory);
  }
  return start;
}

}  // namespace bough::analysis
