// Wires, forces that follow signals, controllers that events switch, lags that start at rest, units.
#include "solver/builder/build_system.hpp"
#include "solver/system/derivative.hpp"
#include "tests/solver/control/support.hpp"

namespace bough::solver::testing {
namespace {

using records::EventAction;
using records::SensorType;
using ::testing::HasSubstr;

records::ConnectRecord make_wire(const std::string& from, const std::string& to, double gain = 1, int line = 60) {
  return {from, to, gain, {"system.toml", line, 1}};
}

records::UserEventRecord make_timed_event(double time, EventAction action, const std::string& target, int choice = 0) {
  auto e = make_event(target + std::to_string(time), action, target);
  e.time = time;
  e.choice = choice;
  return e;
}

records::SystemSpec make_servo() {
  auto spec = make_axis();
  spec.functions = {make_step("target", 0.5, 0)};
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {6}}, {"kd", {4}}})};
  spec.controllers[0].reference = "target";
  spec.controllers[0].rate = "rate";
  return spec;
}

std::vector<Diagnostic> collect_messages(const records::SystemSpec& spec) {
  Diagnostics diagnostics;
  draft_system(spec, {}, diagnostics);
  return diagnostics.items();
}

std::string find_message(const records::SystemSpec& spec, const std::string& id, int line = 60) {
  for (const auto& item : collect_messages(spec)) {
    if (item.id != id) continue;
    EXPECT_EQ(item.where.line, line) << item.what;
    return item.what + "; " + item.advice;
  }
  ADD_FAILURE() << "no " << id;
  for (const auto& item : collect_messages(spec)) ADD_FAILURE() << item.id << " " << item.what;
  return {};
}

TEST(Connect, IsWhatTheKeysAre) {
  const RunResult keys = run(make_servo());
  auto spec = make_servo();
  spec.controllers[0].inputs.clear();
  spec.controllers[0].reference.clear();
  spec.controllers[0].rate.clear();
  spec.actuators[0].input.clear();
  spec.connects = {make_wire("law", "drive"), make_wire("rate", "law:rate"),
                   make_wire("target", "/controllers/law:reference"), make_wire("/sensors/angle", "law:1")};
  const RunResult wires = run(spec);
  for (const char* path : {"/sensors/angle", "/controllers/law", "/actuators/drive"})
    EXPECT_EQ(keys.sink.get(path), wires.sink.get(path)) << path;
}

TEST(Connect, HasAGain) {
  auto spec = make_servo();
  spec.actuators[0].input.clear();
  spec.connects = {make_wire("law", "drive", -0.25)};
  const RunResult r = run(spec);
  const MatrixXd law = r.sink.get("/controllers/law"), drive = r.sink.get("/actuators/drive");
  EXPECT_LT((drive + 0.25 * law).cwiseAbs().maxCoeff(), 1e-15 * law.cwiseAbs().maxCoeff());
}

TEST(Connect, FillsInputsInTheirOrder) {
  auto spec = make_servo();
  spec.controllers.push_back(make_law("error", "sum", {}, {{"weights", {1, 10}}}));
  spec.connects = {make_wire("rate", "error:2"), make_wire("angle", "error")};
  const RunResult r = run(spec);
  const MatrixXd expected = r.sink.get("/sensors/angle") + 10 * r.sink.get("/sensors/rate");
  EXPECT_LT((r.sink.get("/controllers/error") - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Connect, FaultsAreNamedWhereTheWireIs) {
  const auto with = [](const records::ConnectRecord& wire) {
    auto spec = make_servo();
    spec.connects = {wire};
    return spec;
  };
  const char* id = "control.bad-connect";
  EXPECT_THAT(find_message(with(make_wire("law", "drve")), id), HasSubstr("did you mean 'drive'?"));
  EXPECT_THAT(find_message(with(make_wire("law", "drive")), id), HasSubstr("another signal does"));
  EXPECT_THAT(find_message(with(make_wire("law", "law:reference")), id), HasSubstr("another signal does"));
  EXPECT_THAT(find_message(with(make_wire("law", "law:3")), id), HasSubstr("no input 2"));
  EXPECT_THAT(find_message(with(make_wire("law", "law:first")), id), HasSubstr("count its inputs"));
  EXPECT_THAT(find_message(with(make_wire("law", "angle")), id), HasSubstr("no input"));
  EXPECT_THAT(find_message(with(make_wire("law", "drive:2")), id), HasSubstr("it has one"));
  auto spec = make_servo();
  spec.actuators[0].input.clear();
  spec.connects = {make_wire("lew", "drive")};
  EXPECT_THAT(find_message(spec, "control.unknown-signal"), HasSubstr("did you mean 'law'?"));
}

TEST(Connect, AlgebraicLoopsThroughWiresAreNamed) {
  auto spec = make_servo();
  spec.controllers.push_back(make_law("a", "sum", {"angle"}));
  spec.controllers.push_back(make_law("b", "gain", {}, {{"gain", {2}}, {"outputs", {1}}}));
  spec.connects = {make_wire("b", "a"), make_wire("a", "b")};
  EXPECT_THAT(find_message(spec, "control.algebraic-loop", 40), HasSubstr("a -> b -> a"));
}

TEST(ForceOfASignal, IsTheActuatorOfTheSameSignal) {
  auto spec = make_axis();
  spec.hinges[0].type = records::HingeType::Free;
  spec.bodies[0].cg = {0.2, 0.1, -0.3};
  spec.sensors.clear();
  spec.functions = {make_function("law", "sine", {{"amplitude", 0.4}, {"omega", 2}})};
  spec.actuators[0] = {};
  spec.actuators[0].name = "drive";
  spec.actuators[0].type = "force";
  spec.actuators[0].body = "rotor";
  spec.actuators[0].input = "law";
  spec.actuators[0].settings.numbers["axis"] = {0, 3, 4};
  const RunResult actuator = run(spec);
  spec.actuators.clear();
  spec.forces = {make_force("push", "rotor", {0, 0.6, 0.8})};
  spec.forces[0].signal = "law";
  const RunResult signal = run(spec);
  EXPECT_LT(signal.outcome.energy_error, 1e-9);
  EXPECT_LT((signal.sink.get("/bodies/rotor/position") - actuator.sink.get("/bodies/rotor/position")).norm(), 1e-9);
  // A function gives the same force, and a wire with a gain of two half of it.
  spec.forces[0].signal.clear();
  spec.forces[0].function = "law";
  const RunResult function = run(spec);
  EXPECT_LT((function.sink.get("/bodies/rotor/position") - signal.sink.get("/bodies/rotor/position")).norm(), 1e-8);
  spec.forces[0].function.clear();
  spec.forces[0].direction /= 2;
  spec.connects = {make_wire("law", "push", 2)};
  const RunResult wired = run(spec);
  EXPECT_LT((wired.sink.get("/bodies/rotor/position") - signal.sink.get("/bodies/rotor/position")).norm(), 1e-9);
  EXPECT_EQ(wired.sink.get("/forces/push"), 2 * wired.sink.get("/signals/law"));
}

// kp angle + kd rate about 0.5, in parts: with it, without it (the rotor coasts), with it again.
TEST(Event, EnablesAndDisablesAController) {
  auto spec = make_servo();
  spec.events = {make_timed_event(1, EventAction::Disable, "law"), make_timed_event(2, EventAction::Enable, "law")};
  const RunResult r = run(spec);
  const VectorXd t = r.sink.time(), angle = r.sink.get("/sensors/angle").col(0),
                 drive = r.sink.get("/actuators/drive").col(0);
  MatrixXd A(2, 2);
  A << 0, 1, -3, -2;
  const VectorXd one = propagate(A, Eigen::Vector2d(0, 1.5), Eigen::Vector2d(0, 0), 1);
  const Eigen::Vector2d two(one[0] + one[1], one[1]);
  for (int i = 0; i < t.size(); ++i) {
    if (t[i] > 1 + 1e-9 && t[i] < 2 - 1e-9) {
      EXPECT_NEAR(angle[i], one[0] + one[1] * (t[i] - 1), 1e-9) << t[i];
      EXPECT_EQ(drive[i], 0) << t[i];
    }
    if (t[i] > 2 + 1e-9) {
      EXPECT_NEAR(angle[i], propagate(A, Eigen::Vector2d(0, 1.5), two, t[i] - 2)[0], 1e-9) << t[i];
    }
  }
  EXPECT_LT(r.outcome.energy_error, 1e-9);
  // One that starts at rest is the same from the time at which it is enabled.
  auto late = make_servo();
  late.controllers[0].active = false;
  late.events = {make_timed_event(1.5, EventAction::Enable, "law")};
  const RunResult s = run(late);
  EXPECT_NEAR(get_last(s.sink, "/sensors/angle"), propagate(A, Eigen::Vector2d(0, 1.5), Eigen::Vector2d(0, 0), 3.5)[0],
              1e-9);
}

TEST(Event, DisablesASampledController) {
  auto spec = make_servo();
  spec.controllers[0].rate.clear();
  spec.controllers[0].settings.numbers = {{"kp", {6}}, {"kd", {4}}, {"sample_time", {0.1}}, {"delay", {0.05}}};
  spec.events = {make_timed_event(1.02, EventAction::Disable, "law"),
                 make_timed_event(2.02, EventAction::Enable, "law")};
  const RunResult r = run(spec);
  const VectorXd t = r.sink.time(), drive = r.sink.get("/actuators/drive").col(0);
  for (int i = 0; i < t.size(); ++i) {
    if (t[i] > 1.03 && t[i] < 2.14) {
      EXPECT_EQ(drive[i], 0) << t[i];  // it samples again at 2.1, which appears at 2.15
    }
  }
  EXPECT_NE(drive[10], 0);
  EXPECT_NE(drive[drive.size() - 1], 0);
}

TEST(Event, SwitchesAFunction) {
  auto spec = make_axis();
  spec.functions = {make_step("first", 1, 0), make_step("second", -3, 0)};
  spec.controllers = {make_law("law", "switch", {"first", "second"})};
  spec.events = {make_timed_event(2, EventAction::Switch, "law", 2),
                 make_timed_event(4, EventAction::Switch, "law", 1)};
  const RunResult r = run(spec);
  // Inertia 2: rates 1, then 1 - 3, then -2 + 0.5.
  EXPECT_NEAR(r.sink.get("/sensors/rate")(40, 0), 1, 1e-9);
  EXPECT_NEAR(r.sink.get("/sensors/rate")(80, 0), -2, 1e-9);
  EXPECT_NEAR(get_last(r.sink, "/sensors/rate"), -1.5, 1e-9);
}

std::string run_and_fail(const records::SystemSpec& spec) {
  Diagnostics diagnostics;
  const System system = draft_system(spec, {}, diagnostics);
  check_run(system, spec, diagnostics);
  std::string all;
  for (const auto& item : diagnostics.items()) all += item.id + " " + item.what + "\n";
  return all;
}

TEST(Event, NamesWhatItCannotSwitch) {
  auto spec = make_servo();
  spec.events = {make_timed_event(1, EventAction::Switch, "law", 1)};
  EXPECT_THAT(run_and_fail(spec), HasSubstr("run.bad-event event 'law1.000000' switches controller 'law'"));
  spec.controllers.push_back(make_law("pick", "switch", {"angle", "rate"}));
  spec.events = {make_timed_event(1, EventAction::Switch, "pick", 3)};
  EXPECT_THAT(run_and_fail(spec), HasSubstr("input 3 of controller 'pick', which has 2"));
  spec.events = {make_timed_event(1, EventAction::Disable, "lew")};
  EXPECT_THAT(run_and_fail(spec), HasSubstr("run.unknown-target"));
}

TEST(Lag, StartsWhereItIsAsked) {
  auto spec = make_axis();
  spec.hinges[0].position = {0.8};
  spec.hinges[0].rate = {0.3};
  spec.sensors[0].chain.numbers = {{"lag", {0.5}}};
  spec.functions = {make_step("law", 2, 0)};
  spec.actuators[0].settings.numbers = {{"lag", {0.25}}};
  const auto start = [](const records::SystemSpec& s, const char* path) { return run(s).sink.get(path)(0, 0); };
  EXPECT_EQ(start(spec, "/sensors/angle"), 0);
  EXPECT_EQ(start(spec, "/actuators/drive"), 0);
  spec.sensors[0].chain.numbers["initial"] = {0.7};
  spec.actuators[0].settings.numbers["initial"] = {-1};
  EXPECT_EQ(start(spec, "/sensors/angle"), 0.7);
  EXPECT_EQ(start(spec, "/actuators/drive"), -1);
  spec.sensors[0].chain.numbers.erase("initial");
  spec.actuators[0].settings.numbers.erase("initial");
  spec.sensors[0].chain.words["initial"] = {"steady"};
  spec.actuators[0].settings.words["initial"] = {"steady"};
  EXPECT_EQ(start(spec, "/sensors/angle"), 0.8);
  EXPECT_EQ(start(spec, "/actuators/drive"), 2);
  const RunResult r = run(spec);  // ẏ = (u - y) / 0.25 stays at rest: the angle is 0.8 + 0.3 t + t² / 2
  EXPECT_NEAR(get_last(r.sink, "/actuators/drive"), 2, 1e-12);
  EXPECT_NEAR(get_last(r.sink, "/hinges/axis/q"), 0.8 + 1.5 + 12.5, 1e-8);
}

TEST(Lag, FollowsASampleAtRest) {
  auto spec = make_servo();
  spec.controllers[0].settings.numbers["sample_time"] = {0.1};
  spec.actuators[0].settings.numbers = {{"lag", {0.25}}};
  spec.actuators[0].settings.words["initial"] = {"steady"};
  const RunResult r = run(spec);
  EXPECT_EQ(r.sink.get("/actuators/drive")(0, 0), 3);  // kp (0.5 - 0)
}

TEST(Lag, RefusesWhatItDoesNotKnow) {
  auto spec = make_axis();
  spec.functions = {make_step("law", 2, 0)};
  spec.sensors[0].chain.words["initial"] = {"stady"};
  spec.sensors[0].chain.numbers = {{"lag", {0.5}}};
  EXPECT_THAT(find_message(spec, "sensor.bad-value", 30), HasSubstr("steady"));
  spec.sensors[0].chain = {};
  spec.actuators[0].settings.numbers["initial"] = {1};
  EXPECT_THAT(find_message(spec, "control.bad-value", 50), HasSubstr("no lag"));
}

TEST(Units, OfWhatIsAddedAndDrivenAreCompared) {
  auto spec = make_servo();
  spec.controllers.push_back(make_law("error", "sum", {"angle", "rate"}));
  EXPECT_THAT(find_message(spec, "control.units", 40), HasSubstr("angle (1) and rate (1/T)"));
  // A gain makes another quantity of it.
  spec.controllers.back().inputs = {"angle"};
  spec.connects = {make_wire("rate", "error", 3)};
  EXPECT_THAT(collect_messages(spec), ::testing::IsEmpty());
  spec = make_servo();
  spec.controllers[0].rate = "angle";
  EXPECT_THAT(find_message(spec, "control.units", 40), HasSubstr("takes angle (1) for the rate of angle (1)"));
  spec = make_servo();
  spec.actuators[0].type = "moment";
  spec.actuators[0].hinge.clear();
  spec.actuators[0].body = "rotor";
  spec.actuators[0].input = "rate";
  spec.actuators[0].settings.numbers["axis"] = {0, 0, 1};
  EXPECT_THAT(find_message(spec, "control.units", 50), HasSubstr("takes F L and gets rate (1/T)"));
  spec.actuators[0].settings.numbers["scale"] = {-2};
  EXPECT_THAT(collect_messages(spec), ::testing::IsEmpty());
}

// A state holds all that an evaluation depends on: modes of hinges, and what a relay remembers.
TEST(State, IsRestoredWhole) {
  auto spec = make_axis();
  spec.controllers = {make_law("law", "relay", {"angle"}, {{"on", {1}}, {"off", {0.5}}, {"value", {5}}})};
  const System system = build(spec);
  State state = system.make_initial_state();
  ASSERT_EQ(state.discrete.memory.size(), 1);
  state.discrete.memory[0] = 1;  // on
  auto data = system.make_data();
  set_modes(system, *data, state.discrete);
  EXPECT_EQ(get_discrete(*data).memory, state.discrete.memory);
  VectorXd x_dot(system.layout().size());
  calc_derivative(system, *data, state.t, state.x, x_dot);
  EXPECT_NEAR(get_u(system.layout(), x_dot)[0], 5.0 / 2, 1e-14);
  state.discrete.mode[0] = HingeMode::Locked;
  set_modes(system, *data, state.discrete);
  calc_derivative(system, *data, state.t, state.x, x_dot);
  EXPECT_EQ(get_u(system.layout(), x_dot)[0], 0);
  EXPECT_EQ(get_discrete(*data).mode, state.discrete.mode);
}

}  // namespace
}  // namespace bough::solver::testing
