// Single outputs, of which no more is computed than they need, are those of all outputs together.
#include <gtest/gtest.h>

#include <random>

#include "embed/bough.hpp"
#include "tests/support/toml_lines.hpp"

namespace {

/// Two links with every kind of channel: sensors of motion and of accelerations, sampled, late and lagged blocks, a
/// wheel, an engine with its tank, a spring, a closed loop and a coupler.
const std::string kAll = bough::test::toml_lines(R"([[body]]; name = "hub"; mass = 3.0; inertia = [1.0, 1.2, 1.4]
nodes = [{id = 1, position = [0.5, 0.1, 0.0]}, {id = 2, position = [0.0, -0.4, 0.0]}]
[[body]]; name = "link"; mass = 1.0; cg = [0.4, 0.0, 0.1]; inertia = [0.02, 0.1, 0.1]
nodes = [{id = 1, position = [0.8, 0.0, 0.0]}]
[[body]]; name = "tip"; mass = 0.4; inertia = [0.01, 0.02, 0.02]
[[hinge]]; name = "root"; type = "cylindrical"; child = "hub"; rate = [0.3, 0.1]
[[hinge]]; name = "elbow"; type = "universal"; parent = "hub"; parent_node = 1; child = "link"
axis = [0.0, 0.0, 1.0]; axis2 = [0.0, 1.0, 0.0]; position = [0.2, 0.3]; damping = [0.1, 0.2]
[[hinge]]; name = "wrist"; type = "revolute"; parent = "link"; parent_node = 1; child = "tip"; rate = [1.0]
friction = {coulomb = 0.05}
[[constraint]]; name = "gear"; type = "coupler"
terms = [{hinge = "elbow", coordinate = 1, ratio = 1.0}, {hinge = "wrist", coordinate = 1, ratio = -0.5}]
offset = 0.2
[[tank]]; name = "fuel"; type = "cylinder"; body = "hub"; mass = 0.5; radius = 0.2; height = 0.3
density = 100.0
[[force]]; name = "cord"; type = "spring"; body = "tip"; stiffness = 3.0; damping = 0.1; free_length = 0.5
[[sensor]]; name = "angle"; type = "hinge_angle"; hinge = "elbow"; coordinate = 2
[[sensor]]; name = "late"; type = "hinge_rate"; hinge = "wrist"; sample_time = 0.02; delay = 0.013
noise_density = 0.001
[[sensor]]; name = "gyro"; type = "gyro"; body = "link"; lag = 0.05
[[sensor]]; name = "felt"; type = "accelerometer"; body = "tip"
[[sensor]]; name = "place"; type = "position"; body = "tip"
[[input]]; name = "push"; start = 0.2
[[controller]]; name = "filter"; type = "state_space"; inputs = ["angle", "late", "push"]
A = [[-1.0, 0.5], [0.0, -2.0]]; B = [[1.0, 0.0, 0.2], [0.1, 0.3, 0.0]]; C = [[1.0, -0.4]]; D = [[0.3, 0.0, 1.0]]
[[controller]]; name = "digital"; type = "gain"; inputs = ["filter", "gyro:x"]; gain = [[0.5, -0.2], [0.1, 1.0]]
sample_time = 0.01
[[controller]]; name = "seen"; type = "gain"; inputs = ["felt:z"]; gain = 2.0
[[actuator]]; name = "wheel"; type = "wheel"; body = "hub"; axis = [0.0, 0.0, 1.0]; inertia = 0.1
viscous = 0.01; lag = 0.1; input = "filter"
[[actuator]]; name = "engine"; type = "engine"; body = "hub"; node = 2; axis = [1.0, 0.0, 0.0]
exhaust_velocity = 30.0; tank = "fuel"; bias = 0.5; input = "digital:1"
[[actuator]]; name = "motor"; type = "motor"; hinge = "elbow"; torque_constant = 0.2; resistance = 1.5
lag = 0.03; input = "digital:2"
[simulation]; duration = 2.0; output_step = 0.01; integrator = "rk4"; step = 0.002; gravity = [0.0, 0.0, -9.81]
)");

std::vector<double> read_all(const bough::Simulation& s, int count) {
  std::vector<double> values(static_cast<std::size_t>(count));
  s.outputs(0, values.data(), count);
  return values;
}

TEST(Outputs, OneByOneAreThoseOfAllAtOnce) {
  const auto model = bough::Model::load_text(kAll);
  const int count = static_cast<int>(model.outputs().size());
  ASSERT_GT(count, 100);
  for (const char* integrator : {"rk4", "implicit", "adams"}) {
    bough::Options options;
    options.integrator = integrator;
    bough::Simulation reader(model, options), twin(model, options);
    std::mt19937 random(1);
    std::uniform_int_distribution<int> choose(0, count - 1);
    for (int k = 1; k <= 150; ++k) {
      const double t = 0.0067 * k;
      for (auto* s : {&reader, &twin}) {
        if (k % 7 == 0) s->set_input(0, 0.1 * (k % 5));
        s->advance_to(t);
        // Read at the old input, which is not over before the next advance, or at the new one.
        if (k % 5 == 0) s->set_input(0, 0.3);
      }
      const auto all = read_all(twin, count);
      for (int i = 0; i < 12; ++i) {
        const int one = choose(random);
        EXPECT_EQ(reader.output(one), all[static_cast<std::size_t>(one)])
            << integrator << " at t = " << t << ": " << model.outputs()[static_cast<std::size_t>(one)].name;
      }
      if (k % 10 != 0) continue;
      const int first = choose(random), n = std::min(30, count - first);
      std::vector<double> some(static_cast<std::size_t>(n));
      reader.outputs(first, some.data(), n);
      EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin() + first)) << integrator << " at t = " << t;
    }
    // Both go on from the same state.
    EXPECT_EQ(reader.save(), twin.save()) << integrator;
    for (int i = count - 1; i >= 0; --i)
      EXPECT_EQ(reader.output(i), read_all(twin, count)[static_cast<std::size_t>(i)]) << i;
  }
}

TEST(Outputs, OneByOneAlsoWhereTheHostIntegrates) {
  const auto model = bough::Model::load_text(kAll);
  const int count = static_cast<int>(model.outputs().size()), num_states = bough_count(model.get(), BOUGH_STATES);
  bough::Simulation reader(model), twin(model);
  std::vector<double> x(static_cast<std::size_t>(num_states));
  ASSERT_EQ(bough_get_continuous(reader.get(), x.data()), BOUGH_OK);
  for (int k = 1; k < 9; ++k) {
    for (double& each : x) each += 1e-3 * k;
    for (auto* s : {&reader, &twin}) ASSERT_EQ(bough_set_continuous(s->get(), 0.001 * k, x.data()), BOUGH_OK);
    const auto all = read_all(twin, count);
    for (int i = 0; i < count; ++i)
      EXPECT_EQ(reader.output((7 * i) % count), all[static_cast<std::size_t>((7 * i) % count)])
          << model.outputs()[static_cast<std::size_t>((7 * i) % count)].name;
  }
}

}  // namespace
