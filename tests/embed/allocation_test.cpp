// No allocation in calls of a host between events: inputs set, advanced, outputs read.
#include <gtest/gtest.h>

#include "embed/bough.hpp"
#include "tests/solver/support/malloc_count.hpp"
#include "tests/support/toml_lines.hpp"

namespace {

/// Two links, friction, a stop that is far away, a spring of a formula, sampled and continuous controllers, a closed
/// loop.
const std::string kArm =
    bough::test::toml_lines(R"([[body]]; name = "a"; mass = 2.0; cg = [0.5, 0.0, 0.0]; inertia = [0.01, 0.17, 0.17]
[[body]]; name = "b"; mass = 1.0; cg = [0.3, 0.0, 0.0]; inertia = [0.01, 0.07, 0.07]
[[hinge]]; name = "h1"; type = "revolute"; child = "a"; axis = [0.0, 0.0, 1.0]; damping = [0.1]
FRICTION
[[hinge]]; name = "h2"; type = "revolute"; parent = "a"; parent_position = [1.0, 0.0, 0.0]; child = "b"
axis = [0.0, 0.0, 1.0]; position = [0.4]
[[sensor]]; name = "angle"; type = "hinge_angle"; hinge = "h1"; noise_density = 0.001; seed = 3
sample_time = 0.01
[[sensor]]; name = "tip"; type = "acceleration"; body = "b"
[[input]]; name = "torque"; dims = "F L"
HOLD
[[input]]; name = "push"
[[controller]]; name = "law"; type = "gain"; inputs = ["angle"]; gain = 3.0; sample_time = 0.02; delay = 0.03
[[controller]]; name = "sum"; type = "sum"; inputs = ["law", "torque", "push"]; weights = [-1.0, 1.0, 1.0]
[[actuator]]; name = "motor"; type = "hinge"; hinge = "h1"; input = "sum"
[[event]]; name = "far"; signal = "tip:y"; value = 1e9
[simulation]; duration = 100.0; output_step = 0.05; integrator = "rk4"; step = 0.002
gravity = [0.0, -9.81, 0.0]
)");

std::string replace(std::string text, const std::string& word, const std::string& by) {
  return text.replace(text.find(word), word.size(), by);
}

TEST(HostAllocation, NoneBetweenEvents) {
  if (bough::solver::testing::get_malloc_count() < 0) GTEST_SKIP() << "malloc cannot be counted in this build";
  for (const char* friction : {"", "friction = {coulomb = 0.01}"})
    for (const char* hold : {"", "hold = \"linear\""})
      for (const char* integrator : {"rk4", "implicit"}) {
        const auto model = bough::Model::load_text(replace(replace(kArm, "FRICTION", friction), "HOLD", hold));
        bough::Options options;
        options.integrator = integrator;
        bough::Simulation simulation(model, options);
        const int n = static_cast<int>(model.outputs().size());
        std::vector<double> outputs(static_cast<std::size_t>(n));
        long first = 0, most = 0;
        for (int k = 1; k <= 200; ++k) {  // 0.7 of a step at a time: pauses within steps too
          const long before = bough::solver::testing::get_malloc_count();
          const double inputs[] = {20.0 + 0.1 * (k % 7), 0.01 * (k % 3)};
          simulation.set_inputs(0, inputs, 2);
          ASSERT_EQ(bough_advance(simulation.get(), 0.0014 * k, nullptr), BOUGH_OK);
          simulation.outputs(0, outputs.data(), n);
          const long count = bough::solver::testing::get_malloc_count() - before;
          if (k <= 20) first += count;
          if (k > 20) most = std::max(most, count);
        }
        EXPECT_EQ(most, 0) << integrator << " " << hold << " " << friction << ", at first " << first;
      }
}

}  // namespace
