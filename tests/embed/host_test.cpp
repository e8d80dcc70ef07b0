// The C and C++ interfaces as a host sees them: nothing but bough.h, bough.hpp and the shared library.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "embed/bough.hpp"
#include "tests/support/toml_lines.hpp"

namespace {

/// A mass of 2 on a slide, pushed by an input: x'' = u / 2.
const std::string kSlide = bough::test::toml_lines(R"([parameters]; mass = 2.0
[[body]]; name = "bob"; mass = "$mass"; inertia = [1.0, 1.0, 1.0]
[[hinge]]; name = "slide"; type = "prismatic"; child = "bob"; axis = [1.0, 0.0, 0.0]
[[sensor]]; name = "x"; type = "position"; body = "bob"
[[input]]; name = "push"; dims = "F"; start = 1.0
HOLD
[[actuator]]; name = "motor"; type = "hinge"; hinge = "slide"; input = "push"
EVENT
[simulation]; duration = 10.0; output_step = 0.1; integrator = "rk4"; step = 0.01
)");

std::string make_slide(const std::string& hold = "", const std::string& event = "") {
  std::string text = kSlide;
  text.replace(text.find("HOLD"), 4, hold);
  text.replace(text.find("EVENT"), 5, event);
  return text;
}

const std::string kStopAtOne = "[[event]]\nname = \"there\"\nsignal = \"x:x\"\nvalue = 1.0\naction = \"stop\"";

TEST(Host, InputsHoldFromWhenTheyAreSet) {
  for (const char* integrator : {"rk4", "implicit", "rk", "adams", "bdf"}) {
    const auto model = bough::Model::load_text(make_slide());
    const int push = model.find_input("push"), x = model.find_output("x:x");
    bough::Options options;
    options.integrator = integrator;
    options.relative_tolerance = 1e-12;
    options.absolute_tolerance = 1e-13;
    bough::Simulation simulation(model, options);
    EXPECT_EQ(simulation.advance_to(1), bough::Reached::Time);
    EXPECT_NEAR(simulation.output(x), 0.25, 1e-9) << integrator;
    simulation.set_input(push, -1);
    simulation.advance_to(1.505);
    // From 1 on: 0.25 + 0.5 t - 0.25 t^2.
    EXPECT_NEAR(simulation.output(x), 0.25 + 0.5 * 0.505 - 0.25 * 0.505 * 0.505, 1e-9) << integrator;
    simulation.set_input(push, 0);
    simulation.advance_to(2);
    const double v = 0.5 - 0.5 * 0.505;
    EXPECT_NEAR(simulation.output(x), 0.25 + 0.5 * 0.505 - 0.25 * 0.505 * 0.505 + v * 0.495, 1e-9) << integrator;
  }
}

TEST(Host, LinearInputsAreReachedAtTheEndOfTheAdvance) {
  const auto model = bough::Model::load_text(make_slide("hold = \"linear\""));
  const int x = model.find_output("x:x"), push = model.find_output("/inputs/push");
  for (const char* integrator : {"rk4", "rk", "adams"}) {
    bough::Options options;
    options.integrator = integrator;
    options.relative_tolerance = 1e-12;
    options.absolute_tolerance = 1e-13;
    bough::Simulation simulation(model, options);
    simulation.set_input(0, 3);
    EXPECT_EQ(simulation.output(push), 1);
    simulation.advance_to(2);
    EXPECT_EQ(simulation.output(push), 3);
    EXPECT_NEAR(simulation.output(x), 0.5 * (0.5 * 4 + 8.0 / 6), 1e-8) << integrator;  // u = 1 + t
    simulation.advance_to(3);                                                          // held: v = 2 at 2
    EXPECT_NEAR(simulation.output(x), 0.5 * (0.5 * 4 + 8.0 / 6) + 2 + 0.75, 1e-8) << integrator;
  }
}

TEST(Host, EventsAndTheEndTerminate) {
  const auto model = bough::Model::load_text(make_slide("", kStopAtOne));
  bough::Simulation simulation(model);
  EXPECT_EQ(simulation.advance_to(1), bough::Reached::Time);
  const auto before = simulation.save();
  EXPECT_EQ(simulation.advance_to(5), bough::Reached::Terminated);
  EXPECT_NEAR(simulation.time(), 2, 1e-9);  // t^2 / 4 = 1
  EXPECT_NE(simulation.reason().find("there"), std::string::npos);
  EXPECT_NEAR(simulation.output(model.find_output("x:x")), 1, 1e-9);
  EXPECT_EQ(simulation.advance_to(6), bough::Reached::Terminated);
  simulation.restore(before);
  EXPECT_EQ(simulation.time(), 1);
  simulation.set_input(0, -1);
  EXPECT_EQ(simulation.advance_to(2.5), bough::Reached::Time);
  simulation.set_input(0, 0);
  EXPECT_EQ(simulation.advance_to(10), bough::Reached::Terminated);  // the very end
  EXPECT_EQ(simulation.time(), 10);
  EXPECT_EQ(simulation.advance_to(11), bough::Reached::Terminated);
  EXPECT_NE(simulation.reason().find("end"), std::string::npos) << simulation.reason();
  bough::Options longer;
  longer.duration = 20;
  bough::Simulation other(bough::Model::load_text(make_slide()), longer);
  EXPECT_EQ(other.advance_to(15), bough::Reached::Time);
  bough::Options shorter;
  shorter.duration = 0.05;  // half of output_step, of which a host sees nothing
  bough::Simulation brief(bough::Model::load_text(make_slide()), shorter);
  EXPECT_EQ(brief.advance_to(0.04), bough::Reached::Time);
  EXPECT_NEAR(brief.output(model.find_output("x:x")), 0.25 * 0.04 * 0.04, 1e-15);
}

TEST(Host, AnInputThatJumpsOverTheValueOfAnEventTerminates) {
  const auto model = bough::Model::load_text(
      make_slide("", "[[event]]\nname = \"jump\"\nsignal = \"/inputs/push\"\nvalue = 2.0\naction = \"stop\""));
  bough::Simulation simulation(model);
  simulation.advance_to(1);
  simulation.set_input(0, 3);
  EXPECT_EQ(simulation.advance_to(2), bough::Reached::Terminated);
  EXPECT_EQ(simulation.time(), 1);
}

TEST(Host, StatesGoOnBitForBit) {
  const auto model = bough::Model::load_text(make_slide());
  for (const char* integrator : {"rk4", "implicit"}) {
    bough::Options options;
    options.integrator = integrator;
    bough::Simulation one(model, options);
    one.advance_to(0.377);  // within a step
    const auto state = one.save();
    bough::Simulation other(model, options);
    other.advance_to(3);
    other.restore(state);
    for (auto* s : {&one, &other}) {
      s->set_input(0, -0.3);
      s->advance_to(0.5111);
      s->set_input(0, 0.7);
      s->advance_to(4.44);
    }
    const int n = static_cast<int>(model.outputs().size());
    std::vector<double> a(static_cast<std::size_t>(n)), b(a);
    one.outputs(0, a.data(), n);
    other.outputs(0, b.data(), n);
    EXPECT_EQ(a, b) << integrator;
    EXPECT_EQ(one.save(), other.save()) << integrator;
  }
}

/// A mass that falls onto a stop and rebounds, with events of its height.
const std::string kBounce = bough::test::toml_lines(R"([[body]]; name = "ball"; mass = 2.0
[[hinge]]; name = "drop"; type = "prismatic"; child = "ball"; axis = [0.0, 0.0, 1.0]; position = 1.0
stops = {lower = 0.0, restitution = 0.7}
[[sensor]]; name = "z"; type = "hinge_angle"; hinge = "drop"
[[sensor]]; name = "v"; type = "hinge_rate"; hinge = "drop"
[[controller]]; name = "thruster"; type = "relay"; inputs = "z"; value = 3.0; on = 0.3; off = 0.2
[[actuator]]; name = "motor"; type = "hinge"; hinge = "drop"; input = "thruster"
[[event]]; name = "low"; signal = "z"; value = 0.25
[simulation]; duration = 3.0; output_step = 0.01; integrator = "rk4"; step = 0.001; gravity = [0.0, 0.0, -9.81]
)");

TEST(Host, SlicesLocateImpactsAndSwitchesAsOneRun) {
  const auto model = bough::Model::load_text(kBounce);
  const auto get_all = [&](bough::Simulation& s) {
    std::vector<double> values(model.outputs().size());
    s.outputs(0, values.data(), static_cast<int>(values.size()));
    return values;
  };
  for (const char* integrator : {"rk4", "implicit"}) {
    bough::Options options;
    options.integrator = integrator;
    bough::Simulation whole(model, options);
    whole.advance_to(2.9);
    // Slices that end on steps, within steps, in steps again and again; some are looked at, some saved and restored.
    for (const double slice : {0.001, 0.00137, 0.0002113, 0.0417}) {
      auto pieces = std::make_unique<bough::Simulation>(model, options);
      for (int k = 1; k * slice < 2.9; ++k) {
        pieces->advance_to(k * slice);
        if (k % 3 == 0) get_all(*pieces);
        if (k % 97 != 0) continue;
        const auto state = pieces->save();
        pieces = std::make_unique<bough::Simulation>(model, options);
        pieces->restore(state);
      }
      pieces->advance_to(2.9);
      EXPECT_EQ(get_all(*pieces), get_all(whole)) << integrator << ", slices of " << slice;
    }
  }
}

// A host of the rate of a sampled sensor: what is due at t has come when the advance to t returns, although equal steps
// of `step` add up their rounding, and the times of the host are not those of the samples to the last digit.
TEST(Host, SamplesThatAreDueHaveComeWithEveryIntegrator) {
  std::string text = make_slide();
  text.replace(text.find("[[input]]"), 9, R"([[sensor]]
name = "sampled"
type = "hinge_rate"
hinge = "slide"
sample_time = 0.01
[[sensor]]
name = "late"
type = "hinge_rate"
hinge = "slide"
sample_time = 0.01
delay = 0.013
[[input]])");
  const auto model = bough::Model::load_text(text);
  for (const char* integrator : {"rk4", "rk", "adams", "bdf", "implicit"}) {
    bough::Options options;
    options.integrator = integrator;
    options.step = 0.001;
    bough::Simulation simulation(model, options);
    const int sampled = bough_find(model.get(), BOUGH_OUTPUTS, "sampled");
    const int late = bough_find(model.get(), BOUGH_OUTPUTS, "late");
    double rate = 0, before = 0, last = 0;  // x'' = u / 2, u = 1 + k/100 in slice k
    for (int k = 0; k < 300; ++k) {
      simulation.set_input(0, 1 + 0.01 * k);
      before = std::exchange(last, rate);
      rate += 0.5 * (1 + 0.01 * k) * 0.01;
      simulation.advance_to((k + 1) * 0.01);
      ASSERT_NEAR(simulation.output(sampled), rate, 1e-6) << integrator << " at " << simulation.time();
      if (k > 1) ASSERT_NEAR(simulation.output(late), before, 1e-6) << integrator << " at " << simulation.time();
    }
  }
}

TEST(Host, InputsHoldBeforeTheTimeAtWhichTheyWereSet) {
  std::string text = make_slide();
  text.replace(text.find("duration = 10.0"), 15, "start = -5.0\nduration = 10.0");
  bough::Simulation simulation(bough::Model::load_text(text));
  EXPECT_EQ(simulation.time(), -5);
  simulation.advance_to(-3);
  EXPECT_NEAR(simulation.output(0), 1, 1e-12);
  // An integrator of the host that looks back behind the time of a value.
  simulation.set_input(0, 3);
  simulation.advance_to(-2);
  std::vector<double> x(static_cast<std::size_t>(bough_count(bough::Model::load_text(text).get(), BOUGH_STATES))),
      dot(x);
  ASSERT_EQ(bough_get_continuous(simulation.get(), x.data()), BOUGH_OK);
  ASSERT_EQ(bough_set_continuous(simulation.get(), -2.5, x.data()), BOUGH_OK);
  ASSERT_EQ(bough_derivatives(simulation.get(), dot.data()), BOUGH_OK);
  EXPECT_NEAR(dot[1], 1.5, 1e-12);
}

/// x'' = -4 x from x = 1.
const std::string kSpring = bough::test::toml_lines(R"([[body]]; name = "bob"; mass = 1.0; inertia = [1.0, 1.0, 1.0]
[[hinge]]; name = "slide"; type = "prismatic"; child = "bob"; axis = [1.0, 0.0, 0.0]; stiffness = [4.0]
position = [1.0]
[[sensor]]; name = "x"; type = "position"; body = "bob"
EVENT
[simulation]; duration = 10.0; output_step = 0.1; step = 0.001; relative_tolerance = 1e-11
absolute_tolerance = 1e-12
)");

std::string make_spring(const std::string& event = "") {
  std::string text = kSpring;
  return text.replace(text.find("EVENT"), 5, event);
}

TEST(Host, AdvanceGoesOnFromWhereTheHostHasLed) {
  const auto model = bough::Model::load_text(make_spring());
  for (const char* integrator : {"rk4", "implicit", "rk", "adams", "bdf"}) {
    for (const double t : {0.001, 0.3, 0.3007, 1.5}) {
      for (const bool updates : {false, true}) {
        bough::Options options;
        options.integrator = integrator;
        bough::Simulation simulation(model, options);
        if (updates) simulation.advance_to(0.5 * t);
        std::vector<double> x(4, 0.0);
        x[0] = std::cos(2 * t);
        x[1] = -2 * std::sin(2 * t);
        bough_event_info info;
        ASSERT_EQ(bough_set_continuous(simulation.get(), t, x.data()), BOUGH_OK);
        if (updates) ASSERT_EQ(bough_update_discrete(simulation.get(), &info), BOUGH_OK);
        const auto state = simulation.save();
        EXPECT_EQ(simulation.advance_to(2.0), bough::Reached::Time) << simulation.reason();
        const double tolerance = std::string(integrator) == "implicit" ? 1e-5 : 1e-7;
        EXPECT_NEAR(simulation.output(0), std::cos(4.0), tolerance) << integrator << " " << t;
        bough::Simulation other(model, options);
        other.restore(state);
        other.advance_to(2.0);
        EXPECT_NEAR(other.output(0), simulation.output(0), 1e-9) << integrator << " " << t;
        EXPECT_EQ(simulation.advance_to(10), bough::Reached::Terminated);  // the end, with its energy balance
      }
    }
  }
}

TEST(Host, NoStepOfTheHostPassesAnEvent) {
  const auto model = bough::Model::load_text(make_spring("[[event]]\nname = \"e\"\ntime = 1.0\naction = \"stop\""));
  bough::Simulation simulation(model);
  std::vector<double> x(4, 0.0);
  EXPECT_EQ(bough_set_continuous(simulation.get(), 1.1, x.data()), BOUGH_BAD_ARGUMENT);
  EXPECT_NE(simulation.reason().find("due at t = 1"), std::string::npos) << simulation.reason();
  ASSERT_EQ(bough_set_continuous(simulation.get(), 1.0, x.data()), BOUGH_OK);
  // An event that the host has not let come comes when the run goes on.
  EXPECT_EQ(simulation.advance_to(2), bough::Reached::Terminated);
  EXPECT_EQ(simulation.time(), 1);
}

TEST(Host, DerivativesAreOfThePresentTime) {
  std::string text = make_spring(
      "[[function]]\nname = \"f\"\ntype = \"ramp\"\nvalue = 30.0\nfrom = 0.0\nto = 10.0\n[[force]]\nname = \"push\"\n"
      "body = \"bob\"\nforce = [1.0, 0.0, 0.0]\nfunction = \"f\"");
  const auto model = bough::Model::load_text(text);
  bough::Simulation simulation(model);
  simulation.advance_to(1.25);
  std::vector<double> x(4), dot(4);
  ASSERT_EQ(bough_get_continuous(simulation.get(), x.data()), BOUGH_OK);
  ASSERT_EQ(bough_derivatives(simulation.get(), dot.data()), BOUGH_OK);
  EXPECT_NEAR(dot[1], 3.75 - 4 * x[0], 1e-9);
}

TEST(Host, TheEndOfARampIsACornerWhateverComesNext) {
  const auto model = bough::Model::load_text(make_slide("hold = \"linear\""), ".", {{"mass", 1}});
  for (const char* integrator : {"rk4", "implicit", "rk", "adams"}) {
    for (const bool sets : {false, true}) {
      bough::Options options;
      options.integrator = integrator;
      options.relative_tolerance = 1e-11;
      options.absolute_tolerance = 1e-13;
      bough::Simulation simulation(model, options);
      simulation.set_input(0, 2);  // from 1
      simulation.advance_to(0.005);
      simulation.output(0);
      if (sets) simulation.set_input(0, 2);
      simulation.advance_to(0.01);
      EXPECT_NEAR(simulation.output(model.find_output("/hinges/slide/qdot")), 0.0075 + 0.01, 1e-10) << integrator;
      simulation.advance_to(0.02);
      EXPECT_NEAR(simulation.output(model.find_output("/hinges/slide/qdot")), 0.0075 + 0.03, 1e-10) << integrator;
    }
  }
}

TEST(Host, WhatAnEventHasEndedStaysEnded) {
  const auto model = bough::Model::load_text(make_slide("", kStopAtOne));
  bough::Simulation simulation(model), other(model);
  simulation.advance_to(5);
  const double end = simulation.time();
  const auto state = simulation.save();
  for (auto* s : {&simulation, &other}) {
    s->restore(state);
    EXPECT_EQ(s->advance_to(9), bough::Reached::Terminated);
    EXPECT_EQ(s->time(), end);
    EXPECT_NE(s->reason().find("there"), std::string::npos);
    EXPECT_NEAR(s->output(0), 1, 1e-9);
  }
}

TEST(Host, OptionsAreNumbers) {
  const auto model = bough::Model::load_text(make_slide());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {nan, -1.0, std::numeric_limits<double>::infinity()}) {
    for (int k = 0; k < 4; ++k) {
      bough_options options = bough_default_options();
      (k == 0   ? options.step
       : k == 1 ? options.relative_tolerance
       : k == 2 ? options.absolute_tolerance
                : options.duration) = value;
      bough_simulation* simulation = nullptr;
      auto message = std::make_unique<bough_message>();
      EXPECT_EQ(bough_start(model.get(), &options, &simulation, message.get()), BOUGH_BAD_ARGUMENT) << k;
      EXPECT_STREQ(message->id, "embed.bad-argument");
    }
  }
}

TEST(Host, DimensionsThatCannotBeReadAreNamed) {
  std::string text = make_slide();
  text.replace(text.find("\"F\""), 3, "\"N m\"");
  bough_model* model = nullptr;
  auto message = std::make_unique<bough_message>();
  ASSERT_EQ(bough_load_text(text.c_str(), ".", nullptr, &model, message.get()), BOUGH_OK);
  EXPECT_STREQ(message->id, "control.units");
  bough_unload(model);
}

TEST(Host, PortsHaveNamesAndDimensions) {
  const auto model = bough::Model::load_text(make_slide(), ".", {{"mass", 4}});
  ASSERT_EQ(model.inputs().size(), 1u);
  EXPECT_EQ(model.inputs()[0].name, "push");
  EXPECT_EQ(model.inputs()[0].dims, "F");
  ASSERT_EQ(model.parameters().size(), 1u);
  EXPECT_EQ(model.parameters()[0].name, "mass");
  EXPECT_EQ(bough_start_value(model.get(), BOUGH_PARAMETERS, 0), 4);
  EXPECT_EQ(bough_start_value(model.get(), BOUGH_INPUTS, 0), 1);
  EXPECT_TRUE(std::isnan(bough_start_value(model.get(), BOUGH_OUTPUTS, 0)));
  EXPECT_EQ(model.outputs()[0].name, "x:x");
  EXPECT_EQ(model.outputs()[0].dims, "L");
  EXPECT_EQ(model.find_output("/sensors/x:x"), 0);
  EXPECT_EQ(model.find_output("x:3"), 2);
  EXPECT_EQ(model.outputs()[static_cast<std::size_t>(model.find_output("/hinges/slide/qdot"))].dims, "L/T");
  EXPECT_THROW(model.find_output("y"), bough::Error);
  bough::Simulation simulation(model);
  simulation.advance_to(2);
  EXPECT_NEAR(simulation.output(0), 0.5, 1e-12);  // 1 / 4 * 4 / 2
}

TEST(Host, ComponentsOfAQuaternionHaveItsNamesWhateverTheSensorIsCalled) {
  std::string text = make_slide();
  text.replace(text.find("[[input]]"), 9,
               "[[sensor]]\nname = \"star\"\ntype = \"quaternion\"\nbody = \"bob\"\n[[input]]");
  const auto model = bough::Model::load_text(text);
  EXPECT_EQ(model.find_output("star:w"), model.find_output("star:1"));
  EXPECT_EQ(model.find_output("star:z"), model.find_output("/sensors/star:4"));
}

TEST(Host, ErrorsNameFileLineAndAdvice) {
  bough_model* model = nullptr;
  auto message = std::make_unique<bough_message>();
  EXPECT_EQ(bough_load_text("[[body]]\nname = \"a\"\nmass = 2.0\ncgg = [0.0, 0.0, 0.0]\n[simulation]\nduration = 1.0\n",
                            "lab", nullptr, &model, message.get()),
            BOUGH_BAD_INPUT);
  EXPECT_EQ(model, nullptr);
  EXPECT_STREQ(message->id, "toml.unknown-key");
  EXPECT_STREQ(message->file, "lab/system.toml");
  EXPECT_EQ(message->line, 4);
  EXPECT_NE(std::string(message->advice).find("'cg'"), std::string::npos) << message->advice;
  EXPECT_EQ(bough_load("/nowhere/s.toml", nullptr, &model, message.get()), BOUGH_BAD_INPUT);
  const char* const settings[] = {"mass=heavy", nullptr};
  EXPECT_EQ(bough_load_text(make_slide().c_str(), ".", settings, &model, message.get()), BOUGH_BAD_INPUT);
  EXPECT_NE(std::string(message->text).find("mass=heavy"), std::string::npos);
}

TEST(Host, BadUseIsAStatusAndAMessage) {
  const auto model = bough::Model::load_text(make_slide());
  EXPECT_EQ(bough_count(nullptr, BOUGH_INPUTS), -1);
  EXPECT_EQ(bough_count(model.get(), static_cast<bough_kind>(17)), -1);
  EXPECT_EQ(bough_find(model.get(), BOUGH_INPUTS, nullptr), -1);
  EXPECT_EQ(bough_name(model.get(), BOUGH_INPUTS, 1), nullptr);
  EXPECT_EQ(bough_name(model.get(), BOUGH_INPUTS, -1), nullptr);
  EXPECT_EQ(bough_load(nullptr, nullptr, nullptr, nullptr), BOUGH_BAD_ARGUMENT);
  bough_model* none = nullptr;
  auto message = std::make_unique<bough_message>();
  EXPECT_EQ(bough_load("", nullptr, &none, message.get()), BOUGH_BAD_ARGUMENT);
  EXPECT_STREQ(message->what, "the file name is empty");
  bough_simulation* s = nullptr;
  EXPECT_EQ(bough_start(nullptr, nullptr, &s, nullptr), BOUGH_BAD_ARGUMENT);
  EXPECT_EQ(bough_start(model.get(), nullptr, nullptr, nullptr), BOUGH_BAD_ARGUMENT);
  bough_options wrong = bough_default_options();
  wrong.size = 3;
  EXPECT_EQ(bough_start(model.get(), &wrong, &s, nullptr), BOUGH_BAD_ARGUMENT);
  ASSERT_EQ(bough_start(model.get(), nullptr, &s, nullptr), BOUGH_OK);
  const double nan = std::numeric_limits<double>::quiet_NaN(), one = 1;
  double value = 0;
  EXPECT_EQ(bough_set_inputs(s, 0, 1, &nan), BOUGH_BAD_ARGUMENT);
  EXPECT_NE(std::string(bough_last_message(s)).find("not finite"), std::string::npos);
  EXPECT_EQ(bough_set_inputs(s, 0, 2, &one), BOUGH_BAD_ARGUMENT);
  EXPECT_EQ(bough_set_inputs(s, -1, 1, &one), BOUGH_BAD_ARGUMENT);
  const int largest = std::numeric_limits<int>::max();
  EXPECT_EQ(bough_set_inputs(s, largest, 1, &one), BOUGH_BAD_ARGUMENT);
  EXPECT_EQ(bough_set_inputs(s, 0, -1, &one), BOUGH_BAD_ARGUMENT);
  EXPECT_NE(std::string(bough_last_message(s)).find("n is -1"), std::string::npos) << bough_last_message(s);
  EXPECT_EQ(bough_get_outputs(s, largest, largest, &value), BOUGH_BAD_ARGUMENT);
  EXPECT_NE(std::string(bough_last_message(s)).find("outputs 2147483647 to 4294967293"), std::string::npos)
      << bough_last_message(s);
  EXPECT_EQ(bough_set_inputs(s, 0, 1, nullptr), BOUGH_BAD_ARGUMENT);
  EXPECT_EQ(bough_get_outputs(s, 0, 100000, &value), BOUGH_BAD_ARGUMENT);
  EXPECT_EQ(bough_advance(s, nan, nullptr), BOUGH_BAD_ARGUMENT);
  ASSERT_EQ(bough_advance(s, 1, nullptr), BOUGH_OK);
  EXPECT_EQ(bough_advance(s, 0.5, &value), BOUGH_BAD_ARGUMENT);
  EXPECT_EQ(value, 1);
  EXPECT_NE(std::string(bough_last_message(s)).find("before 1"), std::string::npos) << bough_last_message(s);
  std::vector<std::byte> state(bough_state_size(s));
  EXPECT_EQ(bough_save(s, state.data(), state.size() - 1), BOUGH_BAD_ARGUMENT);
  ASSERT_EQ(bough_save(s, state.data(), state.size()), BOUGH_OK);
  for (std::size_t i = 0; i < state.size(); i += 7) {  // whatever is cut or turned is told
    EXPECT_EQ(bough_restore(s, state.data(), i), BOUGH_BAD_INPUT) << i;
    auto turned = state;
    turned[i] ^= std::byte{0x10};
    const auto status = bough_restore(s, turned.data(), turned.size());
    EXPECT_TRUE(status == BOUGH_BAD_INPUT || turned == state || i > state.size() / 2) << i;
  }
  ASSERT_EQ(bough_restore(s, state.data(), state.size()), BOUGH_OK);
  bough_stop(s);
  bough_stop(s);
  EXPECT_EQ(bough_advance(s, 2, nullptr), BOUGH_BAD_ARGUMENT);
  EXPECT_EQ(bough_state_size(s), 0u);
  EXPECT_TRUE(std::isnan(bough_time(s)));
  bough_stop(nullptr);
  bough_unload(nullptr);
}

TEST(Host, ARunThatDivergesFailsAndComesBack) {
  const auto model = bough::Model::load_text(make_slide());
  bough::Options options;
  options.integrator = "rk4";
  bough::Simulation simulation(model, options);
  simulation.advance_to(0.5);
  const auto state = simulation.save();
  simulation.set_input(0, 1e300);
  try {
    simulation.advance_to(9);
    ADD_FAILURE() << "no failure at t = " << simulation.time();
  } catch (const bough::Error& error) {
    EXPECT_EQ(error.status(), BOUGH_FAILED);
    EXPECT_NE(std::string(error.what()).find("run.diverged"), std::string::npos) << error.what();
  }
  EXPECT_THROW(simulation.advance_to(9.5), bough::Error);
  simulation.restore(state);
  simulation.set_input(0, 0);
  EXPECT_EQ(simulation.advance_to(1), bough::Reached::Time);
}

TEST(Host, ModelsAreSharedByThreadsAndOutlivedBySimulations) {
  std::vector<double> ends(4);
  {
    const auto model = bough::Model::load_text(make_slide());
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < ends.size(); ++k) {
      threads.emplace_back([&, k] {
        bough::Simulation simulation(model);
        for (int i = 1; i <= 500; ++i) {
          simulation.set_input(0, i % 2 ? 1 : -0.5);
          simulation.advance_to(0.01 * i);
        }
        ends[k] = simulation.output(0);
      });
    }
    for (auto& thread : threads) thread.join();
  }
  for (const double end : ends) EXPECT_EQ(end, ends[0]);
  auto model = std::make_unique<bough::Model>(bough::Model::load_text(make_slide()));
  bough::Simulation simulation(*model);
  model.reset();
  simulation.advance_to(2);
  EXPECT_NEAR(simulation.output(0), 1, 1e-12);
}

}  // namespace
