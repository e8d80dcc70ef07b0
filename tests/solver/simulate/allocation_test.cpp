// No allocation in a run once it is under way: steps, samples, sensors, checkpoints.
#include <gtest/gtest.h>

#include "solver/simulate/simulator.hpp"
#include "tests/solver/support/malloc_count.hpp"
#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

class SummingSink final : public records::ResultSink {
 public:
  void begin(const records::ResultsHeader&) override {}
  void write_sample(const Eigen::Ref<const VectorXd>& sample) override { sum += sample.sum(); }
  void write_event(const records::EventRecord&) override {}
  void write_checkpoint(const records::Checkpoint& checkpoint) override { sum += checkpoint.state.sum(); }
  void end(bool, const std::string&) override {}
  double sum = 0;
};

TEST(Allocation, NoneInARunUnderWay) {
  if (get_malloc_count() < 0) GTEST_SKIP() << "malloc cannot be counted in this build";
  RandomTreeOptions options;
  options.num_bodies = 6;
  RandomTree tree = make_random_tree(8, options);
  std::string flexible;
  for (const auto& body : tree.spec.bodies)
    if (!body.file.empty()) flexible = body.name;
  for (auto type :
       {records::SensorType::Acceleration, records::SensorType::Deflection, records::SensorType::HingeAngle}) {
    records::SensorRecord s;
    s.name = "s" + std::to_string(static_cast<int>(type));
    s.type = type;
    s.body = flexible;
    s.node = 102;
    s.frame = "body";
    for (const auto& hinge : tree.spec.hinges)
      if (hinge.type != records::HingeType::Fixed) s.hinge = hinge.name;
    tree.spec.sensors.push_back(s);
  }
  tree.spec.simulation.duration = 1;
  tree.spec.simulation.output_step = 0.004;  // 250 samples: two checkpoints on the way
  const System system = build(tree.spec, tree.flex);
  for (const std::string integrator : {"rk4", "implicit", "adams", "bdf", "rk", "radau"}) {
    tree.spec.simulation.integrator = integrator;
    tree.spec.simulation.step = integrator == "rk4" || integrator == "implicit" ? 0.002 : 0;
    SummingSink sink;
    Diagnostics diagnostics;
    SimulateOptions run_options;
    long samples = 0, first = 0, last = 0;
    run_options.progress = [&](const Progress&) {
      ++samples;
      last = get_malloc_count();
      if (samples == 2) first = last;
    };
    simulate(system, tree.spec, sink, run_options, diagnostics);
    EXPECT_EQ(samples, 251);
    EXPECT_TRUE(diagnostics.items().empty());  // a message would allocate
    // CVODE's linear solver interface allocates a little when it starts, not per step.
    EXPECT_LE(last - first, integrator == "bdf" ? 6 : 0) << integrator;
    EXPECT_TRUE(std::isfinite(sink.sum));
  }
}

TEST(Allocation, NoneBetweenPiecesOfARun) {
  if (get_malloc_count() < 0) GTEST_SKIP() << "malloc cannot be counted in this build";
  RandomTreeOptions options;
  options.num_bodies = 6;
  options.prescribed = false;
  RandomTree tree = make_random_tree(8, options);
  for (const auto& hinge : tree.spec.hinges) {
    if (hinge.type != records::HingeType::Revolute && hinge.type != records::HingeType::Prismatic) continue;
    records::InputRecord input;
    input.name = "input " + hinge.name;
    tree.spec.inputs.push_back(input);
    records::ActuatorRecord actuator;
    actuator.name = "motor " + hinge.name;
    actuator.type = "hinge";
    actuator.hinge = hinge.name;
    actuator.input = input.name;
    tree.spec.actuators.push_back(actuator);
  }
  ASSERT_FALSE(tree.spec.inputs.empty());
  tree.spec.simulation.duration = 1;
  tree.spec.simulation.output_step = 0.01;
  tree.spec.simulation.step = 0.002;
  const System system = build(tree.spec, tree.flex);
  for (const std::string integrator : {"rk4", "implicit"}) {
    tree.spec.simulation.integrator = integrator;
    SummingSink sink;
    Diagnostics diagnostics;
    const SimulateOptions run_options;
    Simulator simulator(system, tree.spec, sink, run_options, diagnostics);
    std::vector<double> values(tree.spec.inputs.size());
    double sum = 0;
    long first = 0;
    for (int k = 1; k <= 200; ++k) {  // 0.7 of a step
      for (double& value : values) value = 0.1 * (k % 7);
      simulator.set_inputs(0, values);
      simulator.advance_to(0.0014 * k);
      sum += simulator.calc_outputs().sum();
      if (k == 20) first = get_malloc_count();
    }
    EXPECT_EQ(get_malloc_count() - first, 0) << integrator;
    EXPECT_TRUE(std::isfinite(sum));
  }
}

}  // namespace
}  // namespace bough::solver::testing
