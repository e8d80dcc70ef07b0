// The linearly implicit method: its stages against dense matrices, its order, and stiff modes that do not limit it.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/integrate/integrator.hpp"
#include "solver/simulate/hybrid_system.hpp"
#include "solver/simulate/memory_sink.hpp"
#include "solver/simulate/simulate.hpp"
#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

RandomTree make_tree(unsigned seed) {
  RandomTreeOptions options;
  options.num_bodies = 6;
  return make_random_tree(seed, options);
}

TEST(Implicit, FirstStageIsThatOfDenseMatrices) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    const RandomTree tree = make_tree(seed);
    const System system = build(tree.spec, tree.flex);
    HybridSystem ode(system);
    VectorXd q, u;
    make_random_state(system, seed, q, u);
    VectorXd y = VectorXd::Zero(ode.size()), k(ode.size());
    y.head(q.size()) = q;
    y.segment(q.size(), u.size()) = u;
    const double gh = 0.07;
    ode.calc_stage(0.3, y, gh, true, k);

    auto data = system.make_data();
    calc_kinematics(system, *data, 0.3, q, u);
    add_forces(system, *data, 0.3);
    MatrixXd M, K = MatrixXd::Zero(u.size(), u.size()), D = K;
    VectorXd F;
    calc_dense_equations(system.tree, data->tree, M, F);
    std::vector<int> free;
    for (const TreeBody& tb : system.tree.bodies) {
      const int n = tb.num_modes(), eta = tb.eta_dot_offset();
      K.block(eta, eta, n, n) = tb.body.K();
      D.block(eta, eta, n, n) = tb.body.D();
      for (int i = 0; i < tb.stiffness.size(); ++i) K(tb.u_offset + i, tb.u_offset + i) = tb.stiffness[i];
      for (int i = 0; i < tb.damping.size(); ++i) D(tb.u_offset + i, tb.u_offset + i) = tb.damping[i];
    }
    for (int row = 0; row < u.size(); ++row)
      if (data->tree.mode[static_cast<size_t>(row)] == HingeMode::Free) free.push_back(row);
    const MatrixXd whole = M + gh * D + gh * gh * K;
    const VectorXd right = F - gh * K * data->tree.u;
    const VectorXd expected = MatrixXd(whole(free, free)).ldlt().solve(VectorXd(right(free)));
    const VectorXd found = k.segment(q.size(), u.size())(free);
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-9 * (1 + expected.cwiseAbs().maxCoeff())) << seed;
    // And the ODE is as it was.
    VectorXd y_dot(ode.size()), again(u.size());
    ode.calc_derivative(0.3, y, y_dot);
    again = calc_u_dot(system, *data, 0.3, q, u);
    EXPECT_LT((y_dot.segment(q.size(), u.size()) - again).cwiseAbs().maxCoeff(), 1e-12 * (1 + again.norm()));
  }
}

TEST(Implicit, IsOfOrderTwo) {
  const RandomTree tree = make_tree(3);
  const System system = build(tree.spec, tree.flex);
  HybridSystem ode(system);
  VectorXd q, u, y0 = VectorXd::Zero(ode.size());
  make_random_state(system, 5, q, u);
  y0.head(q.size()) = q;
  y0.segment(q.size(), u.size()) = u;
  const auto integrate = [&](const std::string& method, double step) {
    StepperOptions options;
    options.step = step;
    options.absolute_tolerance = VectorXd::Constant(ode.size(), 1e-12);
    const auto stepper = make_integrator(method, ode, options);
    const double end = 0.25;
    stepper->reset(0, y0, end, end);
    while (stepper->time() < end) stepper->step(end);
    return VectorXd(stepper->state());
  };
  const VectorXd exact = integrate("rk4", 2.5e-4);
  double before = 0;
  for (const double step : {0.004, 0.002, 0.001}) {
    const double error = (integrate("implicit", step) - exact).cwiseAbs().maxCoeff();
    if (before > 0) {
      EXPECT_GT(before / error, 3.5) << step;
      EXPECT_LT(before / error, 4.6) << step;
    }
    before = error;
  }
  EXPECT_LT(before, 1e-3);
}

TEST(Implicit, StiffSpringsAndFrictionDoNotLimitTheStep) {
  // A pendulum whose rod is a spring 1e9 times stiffer than the step could follow explicitly swings as the rigid one.
  const auto make = [](bool stiff) {
    records::SystemSpec spec;
    spec.simulation.gravity = {0, -9.81, 0};
    for (const std::string name : {"arm", "bob"}) {
      records::BodyRecord b;
      b.name = name;
      b.mass = name == "bob" ? 1 : 0.1;
      b.inertia = 0.01 * Matrix3d::Identity();
      spec.bodies.push_back(b);
    }
    records::HingeRecord pin, slide;
    pin.name = "pin";
    pin.type = records::HingeType::Revolute;
    pin.child = "arm";
    pin.position = {0.5};
    slide.name = "slide";
    slide.type = stiff ? records::HingeType::Prismatic : records::HingeType::Fixed;
    slide.parent = "arm";
    slide.child = "bob";
    slide.axis = {0, 1, 0};
    slide.parent_position = {0, -1, 0};
    if (stiff) slide.stiffness = {1e11};
    spec.hinges = {pin, slide};
    spec.simulation.duration = 2;
    spec.simulation.output_step = 0.1;
    return spec;
  };
  const auto run = [](const records::SystemSpec& spec) {
    MemorySink sink;
    Diagnostics diagnostics;
    const System system = build(spec);
    EXPECT_TRUE(simulate(system, spec, sink, {}, diagnostics).completed);
    return VectorXd(sink.get("/hinges/pin/q").col(0));
  };
  auto rigid = make(false);
  rigid.simulation.integrator = "rk";
  const VectorXd exact = run(rigid);
  double before = 0;
  for (const double step : {0.01, 0.005, 0.0025}) {
    auto spec = make(true);
    spec.simulation.integrator = "implicit";
    spec.simulation.step = step;
    spec.simulation.energy_error_limit = 1;
    const double error = (run(spec) - exact).cwiseAbs().maxCoeff();
    EXPECT_LT(error, 10 * step * step);
    if (before > 0) {
      EXPECT_GT(before / error, 3) << step;
    }
    before = error;
  }
}

}  // namespace
}  // namespace bough::solver::testing
