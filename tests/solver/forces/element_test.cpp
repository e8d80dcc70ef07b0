// Properties of all elements: actions that cancel, power that is the loss of energy, and the field of point masses.
#include "solver/forces/element.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "solver/functions/curve.hpp"
#include "tests/solver/support/records.hpp"

namespace bough::solver::testing {
namespace {

using records::ElementType;
using records::ForceElementRecord;

struct Pair {
  PointBody points = make_point_body(3, 21);
  records::SystemSpec spec;
  std::map<std::string, records::FlexBody> flex;

  Pair() {
    Random random(4);
    records::BodyRecord soft, hard = make_rigid_record("hard", random);
    soft.name = "soft";
    soft.file = "soft.h5";
    hard.nodes = {{7, {0.3, -0.2, 0.5}}};
    spec.bodies = {soft, hard};
    flex["soft.h5"] = points.make_record("soft");
    spec.hinges = {make_hinge_record("a", records::HingeType::Free, "ground", "soft"),
                   make_hinge_record("b", records::HingeType::Free, "ground", "hard")};
  }
  ForceElementRecord make(ElementType type) const {
    ForceElementRecord e;
    e.name = "e";
    e.type = type;
    e.from = {"soft", 103, {0.1, 0.2, -0.1}, calc_rotation_exp({0.3, 0.1, -0.2})};
    e.to = {"hard", 7, {0, 0.1, 0.3}, calc_rotation_exp({-0.1, 0.4, 0.2})};
    return e;
  }
};

ForceElementRecord make_pair_spring(const Pair& pair) {
  ForceElementRecord e = pair.make(ElementType::Spring);
  e.stiffness = 11;
  e.damping = 0.7;
  e.free_length = 0.6;
  e.preload = 2;
  return e;
}

ForceElementRecord make_bushing(const Pair& pair, Random& random) {
  ForceElementRecord e = pair.make(ElementType::Bushing);
  const MatrixXd a = random.symmetric(6, 2), b = random.symmetric(6);
  e.stiffness6 = a * a;
  e.damping6 = b * b;
  return e;
}

ForceElementRecord make_pair_contact(const Pair& pair, records::ContactShape shape) {
  ForceElementRecord e = pair.make(ElementType::Contact);
  e.shape = shape;
  e.stiffness = 40;
  e.damping = 0.05;
  e.friction = 0.4;
  e.slip_velocity = 0.1;
  e.radius = 3;  // deep in, wherever the random bodies are
  e.to_radius = shape == records::ContactShape::Sphere ? 4 : 0;
  e.normal = {0.2, -0.5, 1};
  return e;
}

std::vector<ForceElementRecord> make_all(const Pair& pair) {
  Random random(9);
  auto one_way = make_pair_spring(pair);
  one_way.sense = records::SpringSense::Tension;
  one_way.preload = 0.5;
  return {make_pair_spring(pair), one_way, make_bushing(pair, random),
          make_pair_contact(pair, records::ContactShape::Plane),
          make_pair_contact(pair, records::ContactShape::Sphere)};
}

TEST(ForceElements, ActionsBetweenTwoBodiesCancel) {
  Pair pair;
  for (const auto& e : make_all(pair)) {
    pair.spec.force_elements = {e};
    const System system = build(pair.spec, pair.flex);
    auto data = system.make_data();
    double largest = 0;
    for (unsigned seed = 1; seed < 6; ++seed) {
      VectorXd q, u;
      make_random_state(system, seed, q, u);
      calc_kinematics(system, *data, 0, q, u);
      add_forces(system, *data, 0);
      Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
      for (int b = 0; b < 2; ++b) {
        const BodyState& s = get_body_state(*data, b);
        const int v = system.tree[b].v_offset;
        const Vector3d f = s.R_WB * data->tree.applied.segment<3>(v);
        force += f;
        moment += s.R_WB * data->tree.applied.segment<3>(v + 3) + s.p_WBo.cross(f);
        largest = std::max(largest, f.norm());
      }
      EXPECT_LT(force.norm(), 1e-13 * (1 + largest));
      EXPECT_LT(moment.norm(), 1e-12 * (1 + largest));
    }
    EXPECT_GT(largest, 0.1);
  }
}

TEST(ForceElements, PowerIsWhatTheirEnergyLosesAndWhatTheyTurnIntoHeat) {
  Pair pair;
  auto all = make_all(pair);
  ForceElementRecord field = pair.make(ElementType::CentralGravity);
  field.mu = 30;
  field.centre = {4, -3, 2};
  field.j2 = 0.2;
  field.equator = 1.5;
  field.axis = {0.2, 0.3, 1};
  all.push_back(field);
  for (const auto& e : all) {
    pair.spec.force_elements = {e};
    const System system = build(pair.spec, pair.flex);
    auto data = system.make_data();
    for (unsigned seed = 1; seed < 6; ++seed) {
      VectorXd q, u;
      make_random_state(system, seed, q, u);
      calc_u_dot(system, *data, 0, q, u);
      const ForceResult at = data->elements[0];
      const Power power = calc_powers(system, *data);
      // Power of all wrenches; the modal dampers of the body are taken out.
      double applied = 0, modal = 0;
      for (int b = 0; b < 2; ++b) {
        const TreeBody& tb = system.tree[b];
        const BodyState& s = get_body_state(*data, b);
        const auto load = data->tree.applied.segment(tb.v_offset, 6 + tb.num_modes());
        const auto eta_dot = u.segment(tb.eta_dot_offset(), tb.num_modes());
        applied += load.head<3>().dot(s.v_B) + load.segment<3>(3).dot(s.w_B) + load.tail(tb.num_modes()).dot(eta_dot);
        if (tb.num_modes() > 0) modal = eta_dot.dot(tb.body.D() * eta_dot);
      }
      EXPECT_NEAR(applied, at.power - at.dissipated, 1e-11 * (1 + std::abs(applied)));
      EXPECT_NEAR(power.total, -at.dissipated - modal, 1e-10 * (1 + std::abs(applied)));
      EXPECT_NEAR(power.dissipated, at.dissipated + modal, 1e-10 * (1 + std::abs(applied)));
      EXPECT_GE(at.dissipated, 0);
      // d/dt of the stored energy, along any motion with these rates.
      const auto calc_stored = [&](double h) {
        calc_kinematics(system, *data, 0, advance_q(system, *data, 0, h, q, u, VectorXd::Zero(u.size())), u);
        const ForceResult r = system.elements[0]->calc(system.tree, data->tree, nullptr);
        return r.strain + r.potential;
      };
      const double h = 2e-3;
      const double slope =
          (8 * (calc_stored(h) - calc_stored(-h)) - (calc_stored(2 * h) - calc_stored(-2 * h))) / (12 * h);
      EXPECT_NEAR(slope, -at.power, 1e-7 * (1 + std::abs(at.power))) << static_cast<int>(e.type) << " seed " << seed;
    }
  }
}

/// The first body of the pair alone.
Pair make_single() {
  Pair pair;
  pair.spec.bodies.resize(1);
  pair.spec.hinges.resize(1);
  return pair;
}

ForceElementRecord make_earth(double mu) {
  ForceElementRecord field;
  field.name = "earth";
  field.type = ElementType::CentralGravity;
  field.mu = mu;
  return field;
}

TEST(ForceElements, CentralGravityIsThatOfThePointsToSecondMoments) {
  Pair pair = make_single();
  auto field = make_earth(1);
  const auto calc_error = [&](double distance) {
    field.centre = distance * Vector3d(0.6, -0.64, 0.48);
    pair.spec.force_elements = {field};
    const System system = build(pair.spec, pair.flex);
    auto data = system.make_data();
    VectorXd q, u;
    make_random_state(system, 3, q, u);
    q.tail(3) *= 1e-3;  // first order in η
    calc_kinematics(system, *data, 0, q, u);
    add_forces(system, *data, 0);
    VectorXd expected = VectorXd::Zero(9);
    const BodyState& s = get_body_state(*data, 0);
    for (size_t k = 0; k < pair.points.p.size(); ++k) {
      const Vector3d r = pair.points.p[k] + pair.points.phi[k] * q.tail(3);
      const Vector3d R = s.R_WB.transpose() * (s.p_WBo - field.centre) + r;
      const Vector3d f = -pair.points.mass[k] / std::pow(R.norm(), 3) * R;
      expected.head<3>() += f;
      expected.segment<3>(3) += r.cross(f);
      expected.tail(3) += pair.points.phi[k].transpose() * f;
      for (size_t a = 0; a < 3; ++a) expected.tail(3) += f[static_cast<int>(a)] * pair.points.g[k][a] * q.tail(3);
    }
    const VectorXd error = (data->tree.applied - expected).cwiseAbs() / expected.cwiseAbs().maxCoeff();
    return Eigen::Vector2d(error.head<3>().maxCoeff(), error.tail(6).maxCoeff());
  };
  // Third moments are left out: the third power of size over distance of the force, the second of moment and modes.
  const Eigen::Vector2d near = calc_error(50), far = calc_error(200);
  EXPECT_LT(far[0], 3e-6);
  EXPECT_LT(far[1], 1e-4);
  EXPECT_GT(near[0] / far[0], 50);
  EXPECT_GT(near[1] / far[1], 14);
}

/// Potential energy of the points in the field of μ at `centre`, to second order of their distances from the mass
/// centre: by their own places, second order in η included.
double calc_point_potential(const PointBody& points, double mu, const Vector3d& centre, const Vector3d& p_WBo,
                            const Matrix3d& R_WB, const VectorXd& eta) {
  double mass = 0;
  Vector3d moment = Vector3d::Zero();
  std::vector<Vector3d> x;
  for (size_t k = 0; k < points.p.size(); ++k) {
    Vector3d r = points.p[k] + points.phi[k] * eta;
    for (size_t a = 0; a < 3; ++a) r[static_cast<int>(a)] += 0.5 * eta.dot(points.g[k][a] * eta);
    x.push_back(p_WBo + R_WB * r - centre);
    mass += points.mass[k];
    moment += points.mass[k] * x.back();
  }
  const Vector3d R = moment / mass, n = R.normalized();
  double potential = -mu * mass / R.norm();
  for (size_t k = 0; k < x.size(); ++k) {
    const Vector3d d = x[k] - R;
    potential -= 0.5 * mu * points.mass[k] * (3 * std::pow(n.dot(d), 2) - d.squaredNorm()) / std::pow(R.norm(), 3);
  }
  return potential;
}

TEST(ForceElements, CentralGravityIsTheGradientOfTheEnergyOfThePointsToSecondOrderInEta) {
  for (const bool stiffening : {true, false}) {
    Pair pair;
    if (!stiffening)
      for (auto& g : pair.points.g)
        for (auto& component : g) component.setZero();
    pair.flex["soft.h5"] = pair.points.make_record("soft");
    pair.spec.bodies.resize(1);
    pair.spec.bodies[0].stiffening = stiffening;
    pair.spec.hinges.resize(1);
    auto field = make_earth(20);
    field.centre = {3, -4, 2};
    pair.spec.force_elements = {field};
    const System system = build(pair.spec, pair.flex);
    auto data = system.make_data();
    VectorXd q, u;
    make_random_state(system, 3, q, u);
    // First column: force, moment and modal forces in B at η = 0; then their derivatives by η.
    const auto calc_loads = [&](const VectorXd& eta) -> VectorXd {
      q.tail(3) = eta;
      calc_kinematics(system, *data, 0, q, u);
      add_forces(system, *data, 0);
      return data->tree.applied;
    };
    const auto calc_energy_slope = [&](const VectorXd& eta) -> VectorXd {
      const BodyState& s = get_body_state(*data, 0);
      const auto slope = [&](auto potential) {
        const double h = 1e-2;
        return -(8 * (potential(h) - potential(-h)) - (potential(2 * h) - potential(-2 * h))) / (12 * h);
      };
      VectorXd loads(9);
      for (int i = 0; i < 3; ++i) {
        const Vector3d e = Vector3d::Unit(i);
        loads[i] = slope([&](double h) {
          return calc_point_potential(pair.points, field.mu, field.centre, s.p_WBo + h * s.R_WB * e, s.R_WB, eta);
        });
        loads[3 + i] = slope([&](double h) {
          return calc_point_potential(pair.points, field.mu, field.centre, s.p_WBo, s.R_WB * calc_rotation_exp(h * e),
                                      eta);
        });
        loads[6 + i] = slope([&](double h) {
          return calc_point_potential(pair.points, field.mu, field.centre, s.p_WBo, s.R_WB, eta + h * e);
        });
      }
      return loads;
    };
    const VectorXd zero = VectorXd::Zero(3);
    const VectorXd at = calc_loads(zero);
    EXPECT_LT((at - calc_energy_slope(zero)).norm(), 1e-6 * at.norm());
    for (int j = 0; j < 3; ++j) {
      const VectorXd eta = 1e-3 * VectorXd::Unit(3, j);
      const VectorXd by_eta = (calc_loads(eta) - calc_loads(-eta)) / 2e-3;
      const VectorXd expected = (calc_energy_slope(eta) - calc_energy_slope(-eta)) / 2e-3;
      EXPECT_LT((by_eta - expected).norm(), 2e-5 * expected.norm()) << by_eta.transpose() << "\n"
                                                                    << expected.transpose();
    }
  }
}

TEST(ForceElements, CentralGravityDoesNotDependOnTheOriginOfTheBody) {
  Pair pair = make_single();
  auto field = make_earth(20);
  field.centre = {3, -4, 2};
  field.j2 = 0.1;
  field.equator = 2;
  pair.spec.force_elements = {field};
  VectorXd q, u, first;
  double energy = 0;
  for (const Vector3d& d : {Vector3d(0, 0, 0), Vector3d(0.5, 0, 0), Vector3d(1, -2, 0.5)}) {
    PointBody points = pair.points;
    for (auto& p : points.p) p -= d;
    pair.flex["soft.h5"] = points.make_record("soft");
    const System system = build(pair.spec, pair.flex);
    auto data = system.make_data();
    if (d.isZero(0)) make_random_state(system, 3, q, u);
    VectorXd moved = q;
    const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
    moved.segment<3>(4) += turn * d;
    calc_kinematics(system, *data, 0, moved, u);
    add_forces(system, *data, 0);
    VectorXd loads = data->tree.applied;
    loads.segment<3>(3) += d.cross(Vector3d(loads.head<3>()));
    if (d.isZero(0)) first = loads, energy = data->elements[0].potential;
    EXPECT_NEAR(data->elements[0].potential, energy, 1e-12 * std::abs(energy));
    EXPECT_LT((loads - first).norm(), 1e-11 * first.norm());
  }
}

TEST(Curve, IntegralAndSlopeBelongToTheTable) {
  for (const std::string kind : {"linear", "cubic"}) {
    records::FunctionRecord f;
    f.name = "f";
    f.type = "table";
    f.interpolation = kind;
    f.x = {-2, -1, 0.5, 1, 3};
    f.y = {-4, 0.5, 1, 3, 2};
    Diagnostics diagnostics;
    const auto curve = Curve::make(f, {}, "spring 's'", diagnostics);
    const auto function = make_time_function(f, diagnostics);
    ASSERT_TRUE(curve && function);
    EXPECT_EQ(curve->calc(0).integral, 0);
    for (double x = -3; x < 4; x += 0.0625) {
      EXPECT_NEAR(curve->calc(x).y, function->calc(x).f, 1e-13);
      const double h = 1e-3;  // Simpson's rule over 2h
      const double area = h / 3 * (function->calc(x - h).f + 4 * function->calc(x).f + function->calc(x + h).f);
      const bool is_corner = std::abs(x + 2) < h || std::abs(x - 3) < h || std::abs(std::remainder(x, 0.5)) < h;
      if (is_corner) continue;
      EXPECT_NEAR(curve->calc(x + h).integral - curve->calc(x - h).integral, area, 1e-13) << kind << " " << x;
      EXPECT_NEAR(curve->calc(x).slope, function->calc(x).f_dot, 1e-12);
    }
  }
}

}  // namespace
}  // namespace bough::solver::testing
