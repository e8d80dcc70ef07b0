// Cost of one evaluation of ẏ = f(t, y) and of whole seconds of motion.
#include <benchmark/benchmark.h>

#include <cmath>

#include "solver/builder/build_system.hpp"
#include "solver/simulate/hybrid_system.hpp"
#include "solver/simulate/memory_sink.hpp"
#include "solver/simulate/simulate.hpp"

namespace {

using namespace bough::solver;
using namespace bough;

/// A rod of 1 m and 1 kg along x, with node 1 at its end.
records::BodyRecord make_rod(const std::string& name) {
  records::BodyRecord body;
  body.name = name;
  body.mass = 1;
  body.cg = {0.5, 0, 0};
  body.inertia = Vector3d(1e-3, 1.0 / 12, 1.0 / 12).asDiagonal();
  body.nodes = {{1, {1, 0, 0}}};
  return body;
}

/// n links of 1 m and 1 kg on revolute joints, axes z and y in turn, under gravity.
records::SystemSpec make_chain(int n) {
  records::SystemSpec spec;
  spec.simulation.gravity = {0, -9.81, 0};
  for (int i = 0; i < n; ++i) {
    const std::string name = "link" + std::to_string(i);
    spec.bodies.push_back(make_rod(name));
    records::HingeRecord hinge;
    hinge.name = "joint" + std::to_string(i);
    hinge.type = records::HingeType::Revolute;
    hinge.child = name;
    hinge.axis = i % 2 == 0 ? Vector3d::UnitZ() : Vector3d::UnitY();
    hinge.position = {0.1};
    if (i > 0) {
      hinge.parent = "link" + std::to_string(i - 1);
      hinge.parent_node = 1;
    }
    spec.hinges.push_back(hinge);
  }
  return spec;
}

/// A cantilever of unit length and mass in its first n bending modes: sines stand in for the mode shapes, the mass
/// integrals are those of the midpoint rule on 100 points, the stiffening is that of the same points.
records::FlexBody make_beam(int n) {
  const int num = 100;
  const double pi = std::acos(-1.0);
  records::FlexBody b;
  b.mass = 1;
  b.cg = {0.5, 0, 0};
  b.inertia = Vector3d(1e-4, 1.0 / 3, 1.0 / 3).asDiagonal();
  b.integrals_method = "lumped";
  auto& g = b.lumped;
  g.gamma0 = g.gamma1 = MatrixXd::Zero(3, n);
  g.gamma2.assign(static_cast<size_t>(n), MatrixXd::Zero(3, n));
  g.gamma3.assign(static_cast<size_t>(n), Matrix3d::Zero());
  g.gamma4.assign(static_cast<size_t>(n), std::vector<Matrix3d>(static_cast<size_t>(n), Matrix3d::Zero()));
  for (auto& K : b.kg_inertial) K = MatrixXd::Zero(n, n);
  for (const auto load : {records::InertialLoad::wz2, records::InertialLoad::ax})
    b.kg_inertial_computed[static_cast<size_t>(load)] = true;
  b.modal_mass = b.modal_stiffness = b.modal_damping = MatrixXd::Zero(n, n);
  const auto slope = [&](int j, double x) { return (j + 0.5) * pi * std::sin((j + 0.5) * pi * x); };
  for (int k = 0; k < num; ++k) {
    const double x = (k + 0.5) / num, m = 1.0 / num;
    for (int i = 0; i < n; ++i) {
      const Vector3d fi(0, 1 - std::cos((i + 0.5) * pi * x), 0);
      const auto si = static_cast<size_t>(i);
      g.gamma0.col(i) += m * fi;
      g.gamma1.col(i) += m * Vector3d(x, 0, 0).cross(fi);
      g.gamma3[si] -= m * fi * Vector3d(x, 0, 0).transpose();
      for (int j = 0; j < n; ++j) {
        const Vector3d fj(0, 1 - std::cos((j + 0.5) * pi * x), 0);
        g.gamma4[si][static_cast<size_t>(j)] += m * (fi.dot(fj) * Matrix3d::Identity() - fi * fj.transpose());
        b.modal_mass(i, j) += m * fi.dot(fj);
        // The tension of Ωz² = 1 at x is (1 - x²)/2, that of an axial acceleration -(1 - x).
        b.kg_inertial[static_cast<size_t>(records::InertialLoad::wz2)](i, j) +=
            m * (1 - x * x) / 2 * slope(i, x) * slope(j, x);
        b.kg_inertial[static_cast<size_t>(records::InertialLoad::ax)](i, j) -= m * (1 - x) * slope(i, x) * slope(j, x);
      }
    }
  }
  for (int i = 0; i < n; ++i) {
    b.modal_stiffness(i, i) = 10 * std::pow((i + 0.5) * pi, 4);
    b.modal_damping(i, i) = 1e-3;
  }
  b.eigenvalue = b.modal_stiffness.diagonal();
  b.frequency_hz = b.eigenvalue.cwiseSqrt() / (2 * pi);
  return b;
}

System build(const records::SystemSpec& spec, const std::map<std::string, records::FlexBody>& flex = {}) {
  Diagnostics diagnostics;
  return build_system(spec, flex, diagnostics);
}

void evaluate(benchmark::State& state, const System& system, int num_bodies) {
  HybridSystem ode(system);
  VectorXd y = ode.make_initial_state(), y_dot(ode.size());
  for (int i = 0; i < ode.num_coordinates(); ++i) y[i] += 1e-6 * std::sin(i);
  for (auto _ : state) {
    ode.calc_derivative(0, y, y_dot);
    benchmark::DoNotOptimize(y_dot.data());
  }
  state.counters["us_per_body"] = benchmark::Counter(
      num_bodies * 1e-6, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void BM_RigidChain(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  evaluate(state, build(make_chain(n)), n);
}
BENCHMARK(BM_RigidChain)->Arg(10)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

/// N four-bars in a chain (IFToMM A02): N + 1 rockers joined by N couplers, a closing hinge each, at 60 degrees.
void BM_NFourBar(benchmark::State& state) {
  const int N = static_cast<int>(state.range(0));
  records::SystemSpec spec;
  spec.simulation.gravity = {0, -9.81, 0};
  const auto add = [&](const std::string& name, const std::string& parent, int node, double x, double angle) {
    spec.bodies.push_back(make_rod(name));
    records::HingeRecord hinge;
    hinge.name = hinge.child = name;
    hinge.type = records::HingeType::Revolute;
    hinge.parent = parent;
    hinge.parent_node = node;
    hinge.parent_position = {x, 0, 0};
    hinge.position = {angle};
    spec.hinges.push_back(hinge);
  };
  for (int k = 0; k <= N; ++k) {
    const std::string id = std::to_string(k);
    add("rocker" + id, "ground", 0, k, 1);
    if (k == N) break;
    add("coupler" + id, "rocker" + id, 1, 0, -1);
    records::ConstraintRecord pin;
    pin.name = "pin" + id;
    pin.hinge = records::HingeType::Revolute;
    pin.parent = "coupler" + id;
    pin.child = "rocker" + std::to_string(k + 1);
    pin.parent_node = pin.child_node = 1;
    spec.constraints.push_back(pin);
  }
  evaluate(state, build(spec), N);
}
BENCHMARK(BM_NFourBar)->Arg(5)->Arg(10)->Arg(20)->Arg(40)->Arg(80)->Arg(160)->Unit(benchmark::kMicrosecond);

records::SystemSpec make_pendulum() {
  auto spec = make_chain(1);
  spec.bodies[0].nodes.clear();
  spec.bodies[0].file = "beam.h5";
  return spec;
}

void BM_FlexiblePendulum(benchmark::State& state) {
  evaluate(state, build(make_pendulum(), {{"beam.h5", make_beam(static_cast<int>(state.range(0)))}}), 1);
}
BENCHMARK(BM_FlexiblePendulum)->Arg(3)->Arg(10)->Arg(30)->Unit(benchmark::kMicrosecond);

/// One second of a rigid chain by rk4 at 1 ms: a thousand steps.
void BM_ChainSecondRk4(benchmark::State& state) {
  auto spec = make_chain(static_cast<int>(state.range(0)));
  spec.simulation.duration = 1;
  spec.simulation.output_step = 0.1;
  spec.simulation.integrator = "rk4";
  spec.simulation.step = 1e-3;
  const System system = build(spec);
  for (auto _ : state) {
    MemorySink sink;
    Diagnostics diagnostics;
    simulate(system, spec, sink, {}, diagnostics);
  }
}
BENCHMARK(BM_ChainSecondRk4)->Arg(10)->Arg(50)->Arg(100)->Unit(benchmark::kMillisecond);

void BM_FlexiblePendulumSecond(benchmark::State& state, const char* integrator) {
  auto spec = make_pendulum();
  spec.simulation.duration = 1;
  spec.simulation.output_step = 0.01;
  spec.simulation.integrator = integrator;
  const System system = build(spec, {{"beam.h5", make_beam(10)}});
  for (auto _ : state) {
    MemorySink sink;
    Diagnostics diagnostics;
    simulate(system, spec, sink, {}, diagnostics);
  }
}
BENCHMARK_CAPTURE(BM_FlexiblePendulumSecond, adams, "adams")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FlexiblePendulumSecond, rk, "rk")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_FlexiblePendulumSecond, bdf, "bdf")->Unit(benchmark::kMillisecond);

/// A free hub with six flexible arms of ten modes and thirteen rigid links: 20 bodies, 60 modes. A second of motion at
/// steps of 1 ms; the counter is that second over the time it takes.
void BM_SatelliteSecond(benchmark::State& state, const char* integrator) {
  auto spec = make_chain(20);
  spec.hinges[0].type = records::HingeType::Free;
  spec.hinges[0].position = {1, 0, 0, 0, 0, 0, 0};
  spec.hinges[0].rate = {0.1, 0.2, 0.3, 0, 0, 0};
  spec.simulation.gravity.setZero();
  for (int i = 1; i <= 6; ++i) {
    auto& arm = spec.bodies[static_cast<size_t>(i)];
    arm.nodes.clear();
    arm.file = "beam.h5";
    auto& hinge = spec.hinges[static_cast<size_t>(i)];
    hinge.parent = "link0";
    hinge.parent_node = 0;
    hinge.stiffness = {100};
    hinge.damping = {1};
  }
  spec.hinges[7].parent = "link0";
  spec.hinges[7].parent_node = 1;
  spec.simulation.duration = 1;
  spec.simulation.output_step = 0.1;
  spec.simulation.integrator = integrator;
  spec.simulation.step = 1e-3;
  spec.simulation.energy_error_limit = 1;
  const System system = build(spec, {{"beam.h5", make_beam(10)}});
  for (auto _ : state) {
    MemorySink sink;
    Diagnostics diagnostics;
    simulate(system, spec, sink, {}, diagnostics);
  }
  state.counters["real_time_factor"] = benchmark::Counter(1, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_CAPTURE(BM_SatelliteSecond, implicit, "implicit")->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
