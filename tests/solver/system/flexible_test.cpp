// One flexible body on simple supports: stiffening, gravity, loads against closed forms; conservation when it flies.
#include <gtest/gtest.h>

#include "solver/builder/build_system.hpp"
#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

struct Model {
  PointBody points;
  records::FlexBody flex;
  records::SystemSpec spec;
  System make() const { return build(spec, {{"f.h5", flex}}); }
};

Model make_model(int n, bool hinge_fixed) {
  Model m;
  m.points = make_point_body(n, 77);
  m.flex = m.points.make_record("f");
  records::BodyRecord body;
  body.name = "f";
  body.file = "f.h5";
  m.spec.bodies = {body};
  if (hinge_fixed) m.spec.hinges = {make_hinge_record("root", HingeType::Fixed, "ground", "f")};
  return m;
}

// M(q) as of the last calc_kinematics: times u̇ it is the force that acts on the modes.
MatrixXd calc_mass(const System& system, const SystemData& data) {
  MatrixXd mass;
  VectorXd force;
  calc_dense_equations(system.tree, data.tree, mass, force);
  return mass;
}

TEST(FlexibleSystem, PrescribedSpinStiffensAndSoftensAsInTheLinearTheory) {
  // M η̈ + (K + Ω² (K_G1(wz²) - Σ m φxyᵀ φxy)) η = Ω² Σ m φxyᵀ p_xy + ...: the slope of η̈ at η = η̇ = 0.
  const int n = 3;
  const double rate = 1.7;
  for (const bool stiffening : {true, false}) {
    Model m = make_model(n, false);
    m.flex.modal_damping.setZero();
    m.spec.bodies[0].stiffening = stiffening;
    records::FunctionRecord angle;
    angle.name = "angle";
    angle.type = "table";
    angle.x = {0, 10};
    angle.y = {0, 10 * rate};
    m.spec.functions = {angle};
    m.spec.hinges = {make_hinge_record("spin", HingeType::Revolute, "ground", "f")};
    m.spec.hinges[0].motion = {"angle"};
    const System system = m.make();
    auto data = system.make_data();
    MatrixXd M_xy = MatrixXd::Zero(n, n);
    VectorXd pull = VectorXd::Zero(n);
    for (size_t k = 0; k < m.points.p.size(); ++k) {
      const MatrixXd phi_xy = m.points.phi[k].topRows<2>();
      M_xy += m.points.mass[k] * phi_xy.transpose() * phi_xy;
      pull += m.points.mass[k] * phi_xy.transpose() * m.points.p[k].head<2>();
    }
    const MatrixXd G = stiffening ? m.flex.kg_inertial[8] : MatrixXd::Zero(n, n);
    const MatrixXd K = m.flex.modal_stiffness + rate * rate * (G - M_xy);
    VectorXd q = VectorXd::Zero(1 + n);
    auto calc_force = [&](const VectorXd& eta) {
      q.tail(n) = eta;
      const VectorXd u_dot = calc_u_dot(system, *data, 1, q, VectorXd::Zero(1 + n));
      return VectorXd((calc_mass(system, *data) * u_dot).tail(n));
    };
    const VectorXd at_rest = calc_force(VectorXd::Zero(n));
    EXPECT_LT((at_rest - rate * rate * pull).norm(), 1e-12);
    for (int j = 0; j < n; ++j) {
      const VectorXd step = 1e-3 * VectorXd::Unit(n, j);
      const VectorXd slope =
          (8 * (calc_force(step) - calc_force(-step)) - (calc_force(2 * step) - calc_force(-2 * step))) /
          12e-3;  // exact for a cubic
      EXPECT_LT((slope + K.col(j)).norm(), 1e-9) << "stiffening " << stiffening;
    }
  }
}

/// Random η, at rest, with η̈ and M η̈.
struct AtRest {
  VectorXd eta, eta_ddot, inertia_force;
};
AtRest calc_at_rest(const System& system, SystemData& data) {
  AtRest x;
  x.eta = Random(2).vector_n(3, 0.2);
  x.eta_ddot = calc_u_dot(system, data, 0, x.eta, VectorXd::Zero(3));
  x.inertia_force = calc_mass(system, data) * x.eta_ddot;
  return x;
}

TEST(FlexibleSystem, GravityLoadsAndStiffensAFixedBody) {
  Model m = make_model(3, true);
  m.spec.simulation.gravity = {2, -9, 4};
  const System system = m.make();
  auto data = system.make_data();
  const auto [eta, eta_ddot, actual] = calc_at_rest(system, *data);
  VectorXd expected = m.flex.lumped.gamma0.transpose() * m.spec.simulation.gravity - m.flex.modal_stiffness * eta;
  for (int a = 0; a < 3; ++a) {
    expected += m.spec.simulation.gravity[a] * m.flex.kg_inertial[static_cast<size_t>(a)] * eta;
  }
  EXPECT_LT((actual - expected).norm(), 1e-12);
  // Its potential is that of the points, second-order places included.
  double potential = 0;
  for (int k = 0; k < m.flex.num_nodes(); ++k) {
    const auto motion = calc_node_motion(system, *data, 0, system.find_node(0, 101 + k));
    potential -= m.points.mass[static_cast<size_t>(k)] * m.spec.simulation.gravity.dot(motion.p_WK);
  }
  EXPECT_NEAR(calc_energies(system, *data).potential, potential, 1e-12);
}

TEST(FlexibleSystem, NodeForceStiffensThroughItsLocators) {
  Model m = make_model(3, true);
  auto force = make_force("push", "f", {3, -2, 5});
  force.node = 104;
  m.spec.forces = {force};
  const System system = m.make();
  auto data = system.make_data();
  const auto [eta, eta_ddot, actual] = calc_at_rest(system, *data);
  VectorXd expected = m.points.phi[3].transpose() * force.direction - m.flex.modal_stiffness * eta;
  for (int a = 0; a < 3; ++a) expected -= force.direction[a] * m.flex.kg_external[static_cast<size_t>(9 + a)] * eta;
  EXPECT_LT((actual - expected).norm(), 1e-12);
  // Forces by the locators' names, and by a wrench added from outside.
  Model named = m;
  named.spec.forces.clear();
  for (int a = 0; a < 3; ++a) {
    records::ForceRecord one;
    one.name = std::string("push") + "xyz"[a];
    one.body = "f";
    one.locator = std::string("f104") + "xyz"[a];
    one.function = one.name;
    records::FunctionRecord value;
    value.name = one.name;
    value.type = "constant";
    value.values = {{"value", force.direction[a]}};
    named.spec.functions.push_back(value);
    named.spec.forces.push_back(one);
  }
  const System by_name = named.make();
  auto other = by_name.make_data();
  EXPECT_LT((calc_u_dot(by_name, *other, 0, eta, VectorXd::Zero(3)) - eta_ddot).norm(), 1e-12);
  m.spec.forces.clear();
  const System bare = m.make();
  other = bare.make_data();
  VectorXd u_dot(3);
  calc_kinematics(bare, *other, 0, eta, VectorXd::Zero(3));
  add_node_wrench(bare, *other, 0, bare.find_node(0, 104), force.direction, Vector3d::Zero());
  calc_accelerations(bare, *other, 0, u_dot);
  EXPECT_LT((u_dot - eta_ddot).norm(), 1e-12);
}

TEST(FlexibleSystem, LoadPatternActsOnTheModes) {
  Model m = make_model(2, true);
  Random random(4);
  m.flex.locators.push_back({"running", 0, 0});
  m.flex.kg_external.push_back(random.symmetric(2));
  m.flex.external_load.conservativeResize(2, m.flex.external_load.cols() + 1);
  m.flex.external_load.rightCols<1>() = random.vector_n(2);
  records::ForceRecord force;
  force.name = "load";
  force.body = "f";
  force.locator = "running";
  force.function = "level";
  records::FunctionRecord level;
  level.name = "level";
  level.type = "constant";
  level.values = {{"value", 2.5}};
  m.spec.functions = {level};
  m.spec.forces = {force};
  const System system = m.make();
  auto data = system.make_data();
  const VectorXd eta = random.vector_n(2, 0.2);
  const VectorXd expected =
      2.5 * (m.flex.external_load.rightCols<1>() - m.flex.kg_external.back() * eta) - m.flex.modal_stiffness * eta;
  const VectorXd eta_ddot = calc_u_dot(system, *data, 0, eta, VectorXd::Zero(2));
  EXPECT_LT((calc_mass(system, *data) * eta_ddot - expected).norm(), 1e-12);
}

/// A pattern of one force at a node is that force, on a flying body too.
TEST(FlexibleSystem, LoadPatternMovesTheFrameAsItsForcesDo) {
  Model m = make_model(3, false);
  m.spec.bodies[0].stiffening = false;  // the second-order arm of the force is beyond a pattern
  const Vector3d f(3, -2, 5);
  const MatrixXd& phi = m.points.phi[3];
  const Vector3d& p = m.points.p[3];
  m.flex.locators.push_back({"pattern", 0, 0});
  m.flex.kg_external.push_back(MatrixXd::Zero(3, 3));
  m.flex.external_load.conservativeResize(3, m.flex.external_load.cols() + 1);
  m.flex.external_load.rightCols<1>() = phi.transpose() * f;
  const auto ne = m.flex.locators.size();
  m.flex.load_resultant = MatrixXd::Zero(6, static_cast<Eigen::Index>(ne));
  m.flex.load_resultant.rightCols<1>() << f, p.cross(f);
  m.flex.load_moment.assign(ne, MatrixXd::Zero(3, 3));
  for (int j = 0; j < 3; ++j) m.flex.load_moment.back().col(j) = Vector3d(phi.col(j)).cross(f);
  records::ForceRecord force;
  force.name = "push";
  force.body = "f";
  Model by_node = m;
  force.locator = "pattern";
  m.spec.forces = {force};
  force.locator.clear();
  force.node = 104;
  force.direction = f;
  by_node.spec.forces = {force};
  const System a = m.make(), b = by_node.make();
  VectorXd q, u;
  make_random_state(a, 6, q, u);
  auto data = a.make_data(), other = b.make_data();
  const VectorXd expected = calc_u_dot(b, *other, 0, q, u);
  EXPECT_LT((calc_u_dot(a, *data, 0, q, u) - expected).norm(), 1e-12 * expected.norm());

  // An older file does not hold the resultant: the frame is not pushed, and the user is told.
  m.flex.load_resultant.resize(0, 0);
  m.flex.load_moment.clear();
  Diagnostics diagnostics;
  build_system(m.spec, {{"f.h5", m.flex}}, diagnostics);
  int num_warnings = 0;
  for (const auto& item : diagnostics.items())
    num_warnings += item.id == "system.no-resultant" && item.severity == Severity::Warning ? 1 : 0;
  EXPECT_EQ(num_warnings, 1);
}

TEST(FlexibleSystem, ForcesFollowTheFrameTheyAreGivenIn) {
  for (const auto frame : {records::VectorFrame::Inertial, records::VectorFrame::Body, records::VectorFrame::Node}) {
    for (const auto kind : {records::ForceKind::Force, records::ForceKind::Moment}) {
      Model m = make_model(3, false);
      const System bare = m.make();
      records::ForceRecord force;
      force.name = "push";
      force.kind = kind;
      force.frame = frame;
      force.body = "f";
      force.node = 104;
      force.direction = {3, -2, 5};
      m.spec.forces = {force};
      const System system = m.make();
      VectorXd q, u, u_dot(9);
      make_random_state(system, 6, q, u);
      auto data = system.make_data(), other = bare.make_data();
      const VectorXd actual = calc_u_dot(system, *data, 0, q, u);
      calc_kinematics(bare, *other, 0, q, u);
      const int node = bare.find_node(0, 104);
      const Matrix3d R = frame == records::VectorFrame::Inertial ? Matrix3d::Identity()
                         : frame == records::VectorFrame::Body   ? get_body_state(*other, 0).R_WB
                                                                 : calc_node_motion(bare, *other, 0, node).R_WK;
      const Vector3d load = R * force.direction, none = Vector3d::Zero();
      const bool is_force = kind == records::ForceKind::Force;
      add_node_wrench(bare, *other, 0, node, is_force ? load : none, is_force ? none : load);
      calc_accelerations(bare, *other, 0, u_dot);
      EXPECT_LT((actual - u_dot).norm(), 1e-12 * u_dot.norm());
    }
  }
}

TEST(FlexibleSystem, FreeFallDoesNotDeform) {
  Model m = make_model(4, false);
  const System still = m.make();
  m.spec.simulation.gravity = {1, 2, -9};
  const System falling = m.make();
  auto a = still.make_data(), b = falling.make_data();
  VectorXd q, u;
  make_random_state(still, 3, q, u);
  const VectorXd u_still = calc_u_dot(still, *a, 0, q, u), u_falling = calc_u_dot(falling, *b, 0, q, u);
  VectorXd expected = u_still;
  expected.segment<3>(3) += m.spec.simulation.gravity;  // the translations of the free hinge are in W
  EXPECT_LT((u_falling - expected).norm(), 1e-12 * expected.norm());
}

TEST(FlexibleSystem, DeflectionIsThatOfThePoint) {
  const Model m = make_model(3, true);
  const System system = m.make();
  auto data = system.make_data();
  Random random(2);
  const VectorXd eta = random.vector_n(3, 0.3);
  calc_kinematics(system, *data, 0, eta, VectorXd::Zero(3));
  Vector3d deflection, rotation, expected = m.points.phi[1] * eta, theta = m.points.psi[1] * eta;
  for (size_t a = 0; a < 3; ++a) {
    expected[static_cast<int>(a)] += 0.5 * eta.dot(m.points.g[1][a] * eta);
    theta[static_cast<int>(a)] += 0.5 * eta.dot(m.points.g_theta[1][a] * eta);
  }
  calc_node_deflection(get_motion(system, *data), 0, system.find_node(0, 102), deflection, rotation);
  EXPECT_LT((deflection - expected).norm(), 1e-14);
  EXPECT_LT((rotation - theta).norm(), 1e-14);
  EXPECT_TRUE(system.has_node_second_order(0, system.find_node(0, 102)));
}

struct Drift {
  double energy, linear, angular;
};
Drift calc_drift(const System& system, double duration, int steps) {
  auto data = system.make_data();
  VectorXd q, u;
  make_random_state(system, 8, q, u);
  auto measure = [&](Vector3d& p, Vector3d& h) {
    calc_kinematics(system, *data, 0, q, u);
    add_forces(system, *data, 0);
    calc_momentum(system, *data, p, h);
    const Energies e = calc_energies(system, *data);
    return e.kinetic + e.strain;
  };
  Vector3d p0, h0, p, h;
  const double e0 = measure(p0, h0);
  for (int k = 0; k < steps; ++k) step_rk4(system, *data, 0, duration / steps, q, u);
  const double e = measure(p, h);
  return {std::abs(e - e0) / e0, (p - p0).norm() / p0.norm(), (h - h0).norm() / h0.norm()};
}

TEST(FlexibleSystem, FlyingBodyKeepsEnergyAndMomenta) {
  Model m = make_model(4, false);
  m.flex.modal_damping.setZero();
  const Drift drift = calc_drift(m.make(), 5, 10000);
  EXPECT_LT(drift.energy, 1e-9);
  EXPECT_LT(drift.linear, 1e-9);
  EXPECT_LT(drift.angular, 1e-9);
}

TEST(FlexibleSystem, FlyingTreeKeepsEnergyAndMomenta) {
  RandomTreeOptions options;
  options.num_bodies = 5;
  options.forces = options.dissipation = options.prescribed = options.to_ground = false;
  const RandomTree tree = make_random_tree(4, options);
  const Drift drift = calc_drift(build(tree.spec, tree.flex), 1, 4000);
  EXPECT_LT(drift.energy, 1e-9);
  EXPECT_LT(drift.linear, 1e-9);
  EXPECT_LT(drift.angular, 1e-9);
}

TEST(FlexibleSystem, DeflectionOfAnySizeLeavesTheMassPositive) {
  const Model m = make_model(2, false);
  const System system = m.make();
  auto data = system.make_data();
  VectorXd q, u;
  make_random_state(system, 3, q, u);
  for (const double size : {1.0, 1e1, 1e2}) {
    q.tail(2).setConstant(size);
    EXPECT_TRUE(calc_u_dot(system, *data, 0, q, u).allFinite());
    const MatrixXd mass = calc_mass(system, *data);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(mass).eigenvalues()[0], 0) << size;
  }
}

TEST(FlexibleSystem, IntegralsOfNoBodyAreNamed) {
  Model m = make_model(2, false);
  m.flex.modal_mass *= 1e-3;  // less than the mode shapes' own momentum allows
  const System system = m.make();
  auto data = system.make_data();
  VectorXd q, u;
  make_random_state(system, 3, q, u);
  try {
    calc_u_dot(system, *data, 0, q, u);
    FAIL() << "accepted";
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().at(0).id, "solver.indefinite-mass");
    EXPECT_NE(std::string(error.what()).find("'f'"), std::string::npos);
  }
}

/// A cantilever of unit length along x as points on and off its axis: bending in y and z in turn, shapes of a beam
/// clamped at Bo, with the second-order field of an inextensible one.
PointBody make_clamped_beam(int n, int num_stations) {
  PointBody body;
  body.num_modes = n;
  const double pi = std::acos(-1.0);
  const auto wave = [&](int j) { return (j / 2 + 0.5) * pi; };
  for (int s = 0; s < num_stations; ++s) {
    for (int corner = 0; corner < 4; ++corner) {
      const double x = (s + 0.5) / num_stations, angle = (corner + 0.3) * pi / 2;
      const Vector3d off = 0.02 * Vector3d(0, std::cos(angle), std::sin(angle));
      MatrixXd phi = MatrixXd::Zero(3, n), psi = phi;
      std::array<MatrixXd, 3> g = {MatrixXd::Zero(n, n), MatrixXd::Zero(n, n), MatrixXd::Zero(n, n)};
      for (int j = 0; j < n; ++j) {
        const int a = 1 + j % 2;
        phi(a, j) = 1 - std::cos(wave(j) * x);
        phi(0, j) = -off[a] * wave(j) * std::sin(wave(j) * x);
        psi(a == 1 ? 2 : 1, j) = (a == 1 ? 1 : -1) * wave(j) * std::sin(wave(j) * x);
        for (int l = j % 2; l < n; l += 2) {  // -∫ φ'φ' dx
          const double p = wave(j) + wave(l), q = wave(j) - wave(l);
          g[0](j, l) = -0.5 * wave(j) * wave(l) * ((j == l ? x : std::sin(q * x) / q) - std::sin(p * x) / p);
        }
      }
      body.mass.push_back(0.25 / num_stations);
      body.p.push_back(Vector3d(x, 0, 0) + off);
      body.phi.push_back(phi);
      body.psi.push_back(psi);
      body.g.push_back(g);
    }
  }
  body.K = MatrixXd::Zero(n, n);
  for (int j = 0; j < n; ++j) body.K(j, j) = 10 * std::pow(wave(j), 4);
  body.D = MatrixXd::Zero(n, n);
  return body;
}

/// Clamped modes behind free hinges leave an inertia about the hinge that tends to zero: the hardest case.
TEST(FlexibleSystem, TreesOfTenModesStayDefiniteAtFivePercent) {
  const auto flex = make_clamped_beam(10, 12).make_record("f");
  for (unsigned seed = 0; seed < 40; ++seed) {
    Random random(seed);
    records::SystemSpec spec;
    for (int b = 0; b < 5; ++b) {
      records::BodyRecord body;
      body.name = "b" + std::to_string(b);
      body.file = "f.h5";
      spec.bodies.push_back(body);
      const HingeType types[] = {HingeType::Revolute, HingeType::Universal, HingeType::Spherical};
      const std::string parent = b == 0 ? "ground" : "b" + std::to_string(random.integer(0, b - 1));
      spec.hinges.push_back(make_hinge_record("h" + std::to_string(b), types[random.integer(0, 2)], parent, body.name));
      spec.hinges.back().axis = random.vector().normalized();
      spec.hinges.back().axis2 = spec.hinges.back().axis.unitOrthogonal();
      spec.hinges.back().parent_node = b == 0 ? 0 : 101 + random.integer(0, 47);
    }
    const System system = build(spec, {{"f.h5", flex}});
    auto data = system.make_data();
    VectorXd q, u, dense(system.num_u());
    make_random_state(system, seed, q, u);
    for (int b = 0; b < 5; ++b) {  // 5 % of the length at the tip, shared out as bending does
      Eigen::VectorBlock<VectorXd> eta = q.segment(system.eta_offset(b), 10);
      for (int j = 0; j < 10; ++j) eta[j] = random() / std::pow(1 + j / 2, 2);
      VectorXd tip = VectorXd::Zero(2);
      for (int j = 0; j < 10; ++j) tip[j % 2] += eta[j];
      eta *= 0.05 / tip.norm();
    }
    const VectorXd u_dot = calc_u_dot(system, *data, 0, q, u);  // throws where the recursion is not definite
    const MatrixXd mass = calc_mass(system, *data);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(mass).eigenvalues()[0], 0) << seed;
    calc_accelerations_dense(system, *data, 0, dense);
    EXPECT_LT((u_dot - dense).norm(), 1e-6 * dense.norm()) << seed;
  }
}

}  // namespace
}  // namespace bough::solver::testing
