// Errors of control systems, by name.
#include "solver/builder/build_system.hpp"
#include "tests/solver/control/support.hpp"

namespace bough::solver::testing {
namespace {

using records::SensorType;
using ::testing::HasSubstr;

/// The message of that id at building.
std::string build_and_fail(const records::SystemSpec& spec, const std::string& id) {
  Diagnostics diagnostics;
  draft_system(spec, {}, diagnostics);
  for (const auto& item : diagnostics.items()) {
    if (item.id == id) return item.what + "; " + item.advice;
  }
  ADD_FAILURE() << "no " << id;
  for (const auto& item : diagnostics.items()) ADD_FAILURE() << item.id << " " << item.what;
  return {};
}

records::SystemSpec make_loop() {
  auto spec = make_axis();
  spec.controllers = {make_law("law", "gain", {"angle"}, {{"gain", {-1}}})};
  return spec;
}

TEST(ControlErrors, NameTheSignalAndTheNearest) {
  auto spec = make_loop();
  spec.controllers[0].inputs = {"angel"};
  EXPECT_THAT(build_and_fail(spec, "control.unknown-signal"), HasSubstr("did you mean 'angle'?"));
  spec.controllers[0].inputs = {"angle:y"};
  EXPECT_THAT(build_and_fail(spec, "control.unknown-signal"), HasSubstr("component 'y'"));
}

TEST(ControlErrors, NameTheAlgebraicLoop) {
  auto spec = make_loop();
  spec.controllers.push_back(make_law("a", "sum", {"angle:1", "b:1"}));
  spec.controllers.push_back(make_law("b", "gain", {"a:1"}, {{"gain", {2}}, {"outputs", {1}}}));
  spec.controllers[1].settings.numbers["outputs"] = {1};
  const std::string what = build_and_fail(spec, "control.algebraic-loop");
  EXPECT_THAT(what, HasSubstr("a -> b -> a"));
  // A lag in one of them opens it.
  spec.controllers[2].type = "transfer_function";
  spec.controllers[2].settings.numbers = {{"numerator", {1}}, {"denominator", {1, 1}}, {"outputs", {1}}};
  Diagnostics none;
  draft_system(spec, {}, none);
  EXPECT_EQ(none.num_errors(), 0);
}

TEST(ControlErrors, AForceFromAnAccelerationIsALoop) {
  auto spec = make_loop();
  spec.sensors.push_back(make_sensor("acc", SensorType::Accelerometer, "rotor"));
  spec.controllers[0].inputs = {"acc:x"};
  EXPECT_THAT(build_and_fail(spec, "control.algebraic-loop"), HasSubstr("the accelerations"));
  // Sampled, it is held between.
  spec.controllers[0].settings.numbers["sample_time"] = {0.1};
  Diagnostics none;
  draft_system(spec, {}, none);
  EXPECT_EQ(none.num_errors(), 0);
}

TEST(ControlErrors, OfKeysTypesSizesAndPlaces) {
  auto spec = make_loop();
  spec.controllers[0].type = "gian";
  EXPECT_THAT(build_and_fail(spec, "control.unknown-type"), HasSubstr("did you mean 'gain'?"));
  spec = make_loop();
  spec.controllers[0].settings.numbers = {{"gain", {1}}, {"kp", {2}}};
  EXPECT_THAT(build_and_fail(spec, "control.unknown-key"), HasSubstr("'kp'"));
  spec.controllers[0].settings.numbers.clear();
  EXPECT_THAT(build_and_fail(spec, "control.missing-key"), HasSubstr("'gain'"));
  spec.controllers[0].settings.numbers = {{"gain", {1, 2, 3}}};
  EXPECT_THAT(build_and_fail(spec, "control.bad-size"), HasSubstr("3 numbers"));
  spec = make_loop();
  spec.controllers[0] = make_law("law", "pid", {"angle"}, {{"kp", {1}}, {"kd", {1}}});
  EXPECT_THAT(build_and_fail(spec, "control.bad-value"), HasSubstr("filter"));
  spec = make_loop();
  spec.actuators[0].hinge = "axes";
  EXPECT_THAT(build_and_fail(spec, "control.unknown-place"), HasSubstr("did you mean 'axis'?"));
  spec = make_loop();
  spec.controllers[0] = make_law("law", "expression", {"angle"});
  spec.controllers[0].settings.words["expression"] = {"u1 +* 2"};
  EXPECT_THAT(build_and_fail(spec, "control.bad-expression"), HasSubstr("u1 +* 2"));
  spec = make_loop();
  spec.controllers[0] = make_law("law", "library", {"angle"});
  spec.controllers[0].settings.words["file"] = {"/nowhere/liblaw.so"};
  EXPECT_THAT(build_and_fail(spec, "control.bad-library"), HasSubstr("liblaw.so"));
  spec = make_loop();
  spec.sensors[0].chain.numbers = {{"noise_density", {1}}};
  EXPECT_THAT(build_and_fail(spec, "sensor.needs-sample-time"), HasSubstr("noise_density"));
  spec.sensors[0].chain.numbers = {{"lag", {-1}}};
  EXPECT_THAT(build_and_fail(spec, "sensor.bad-value"), HasSubstr("lag"));
  spec.sensors[0] = make_sensor("angle", SensorType::Resolver, "", "axis");
  spec.sensors[0].chain.numbers = {{"lag", {0.1}}};
  EXPECT_THAT(build_and_fail(spec, "sensor.bad-value"), HasSubstr("across the jumps"));
}

TEST(ControlErrors, ANumberThatIsNoneEndsTheRunByName) {
  auto spec = make_loop();
  spec.hinges[0].rate = {1};
  spec.controllers[0] = make_law("law", "expression", {"angle"});
  spec.controllers[0].settings.words["expression"] = {"sqrt(1 - u1)"};
  MemorySink sink;
  const Diagnostic failure = run_to_failure(spec, sink)[0];
  EXPECT_EQ(failure.id, "control.not-finite");
  EXPECT_EQ(failure.where.line, 40);
  EXPECT_THAT(failure.what, HasSubstr("controller 'law': output 1 is"));
  EXPECT_GT(sink.num_samples(), 3);
}

TEST(ControlErrors, ARelayWithoutWidthChatters) {
  auto spec = make_axis();
  // It drives its own input through a gain at once.
  spec.controllers = {
      make_law("law", "relay", {"back"}, {{"on", {0.1}}, {"off", {0.05}}, {"low", {0}}, {"outputs", {1}}}),
      make_law("back", "expression", {"law:1"})};
  spec.controllers[1].settings.words["expression"] = {"1 - 2 * u1"};
  EXPECT_EQ(run_to_failure(spec)[0].id, "control.chatter");
}

}  // namespace
}  // namespace bough::solver::testing
