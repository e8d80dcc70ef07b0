// Mechanisms with closed loops against their plane closed forms and their energy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/builder/build_system.hpp"
#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::ConstraintRecord;
using records::ConstraintType;

records::HingeRecord make_pin(const std::string& name, const std::string& parent, const std::string& child,
                              int parent_node, const Vector3d& at = Vector3d::Zero()) {
  auto pin = make_hinge_record(name, HingeType::Revolute, parent, child);
  pin.parent_node = parent_node;
  pin.parent_position = at;
  return pin;
}

ConstraintRecord make_closing(HingeType type, const std::string& parent, int parent_node, const std::string& child,
                              int child_node) {
  ConstraintRecord c;
  c.name = "closing";
  c.hinge = type;
  c.parent = parent;
  c.parent_node = parent_node;
  c.child = child;
  c.child_node = child_node;
  c.at = {"mechanism.toml", 40, 1};
  return c;
}

double energy_spread(const MemorySink& sink) {
  const VectorXd balance = (sink.get("/energy/kinetic") + sink.get("/energy/strain") + sink.get("/energy/potential") -
                            sink.get("/energy/work"))
                               .col(0);
  const VectorXd size = (sink.get("/energy/kinetic") + sink.get("/energy/strain")).col(0);
  return (balance.array() - balance[0]).abs().maxCoeff() / size.maxCoeff();
}

constexpr double kCrank = 0.4, kCoupler = 1.1, kRocker = 0.9, kBase = 1.0;

/// Crank and rocker on ground, the coupler on the crank; the rocker's pin is the constraint.
records::SystemSpec make_four_bar(HingeType state = HingeType::Revolute) {
  records::SystemSpec spec;
  spec.bodies = {make_rod_record("crank", kCrank, 1), make_rod_record("coupler", kCoupler, 2),
                 make_rod_record("rocker", kRocker, 1.5)};
  spec.hinges = {make_pin("crank", "ground", "crank", 0), make_pin("coupler", "crank", "coupler", 1),
                 make_pin("rocker", "ground", "rocker", 0, {kBase, 0, 0})};
  spec.hinges[0].position = {0.7};
  spec.hinges[0].rate = {3};
  spec.hinges[2].position = {1.6};
  spec.hinges[2].is_guess = true;
  spec.constraints = {make_closing(state, "coupler", 1, "rocker", 1)};
  spec.simulation.gravity = {0, -9.81, 0};
  spec.simulation.duration = 3;
  spec.simulation.output_step = 0.01;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
  spec.simulation.at = {"mechanism.toml", 50, 1};
  return spec;
}

struct FourBar {                   // at a crank angle, the branch that starts above
  double coupler = 0, rocker = 0;  // absolute angles
  double coupler_per_crank = 0, rocker_per_crank = 0;
};

FourBar solve_four_bar(double crank) {
  const double bx = kCrank * std::cos(crank), by = kCrank * std::sin(crank);
  const double dx = kBase - bx, dy = -by, r = std::hypot(dx, dy);
  const double along = (kCoupler * kCoupler - kRocker * kRocker + r * r) / (2 * r);
  const double off = std::sqrt(kCoupler * kCoupler - along * along);
  const double px = bx + along * dx / r - off * dy / r, py = by + along * dy / r + off * dx / r;
  FourBar f;
  f.coupler = std::atan2(py - by, px - bx);
  f.rocker = std::atan2(py, px - kBase);
  // a e'(crank) + b e'(coupler) c' = c e'(rocker) r'
  Eigen::Matrix2d A;
  A << -kCoupler * std::sin(f.coupler), kRocker * std::sin(f.rocker), kCoupler * std::cos(f.coupler),
      -kRocker * std::cos(f.rocker);
  const Eigen::Vector2d rates = A.inverse() * Eigen::Vector2d(kCrank * std::sin(crank), -kCrank * std::cos(crank));
  f.coupler_per_crank = rates[0];
  f.rocker_per_crank = rates[1];
  return f;
}

double calc_four_bar_energy(double crank, double rate) {
  const FourBar f = solve_four_bar(crank);
  const double wc = f.coupler_per_crank * rate, wr = f.rocker_per_crank * rate;
  const double vx = -kCrank * std::sin(crank) * rate - 0.5 * kCoupler * std::sin(f.coupler) * wc;
  const double vy = kCrank * std::cos(crank) * rate + 0.5 * kCoupler * std::cos(f.coupler) * wc;
  const double kinetic = 0.5 * (kCrank * kCrank / 3) * rate * rate + 0.5 * 2 * (vx * vx + vy * vy) +
                         0.5 * (2 * kCoupler * kCoupler / 12) * wc * wc + 0.5 * (1.5 * kRocker * kRocker / 3) * wr * wr;
  return kinetic + 9.81 * (0.5 * kCrank * std::sin(crank) +
                           2 * (kCrank * std::sin(crank) + 0.5 * kCoupler * std::sin(f.coupler)) +
                           1.5 * 0.5 * kRocker * std::sin(f.rocker));
}

double wrap(double angle) { return std::remainder(angle, 2 * std::acos(-1.0)); }

// A mechanism of one dof is where its energy says: nothing of the solver is in this reference.
TEST(FourBar, MovesAsItsEnergySays) {
  for (const std::string integrator : {"auto", "adams", "rk", "rk4"}) {
    auto spec = make_four_bar();
    spec.simulation.integrator = integrator;
    spec.simulation.step = integrator == "rk4" ? 1e-3 : 0;
    const RunResult r = run(spec);
    const double energy = calc_four_bar_energy(0.7, 3);
    const double tolerance = integrator == "rk4" ? 1e-7 : 2e-9;
    const MatrixXd crank = r.sink.get("/hinges/crank/q"), rate = r.sink.get("/hinges/crank/qdot"),
                   coupler = r.sink.get("/hinges/coupler/q"), rocker = r.sink.get("/hinges/rocker/q"),
                   rocker_rate = r.sink.get("/hinges/rocker/qdot");
    double worst_gap = 0, worst_rate = 0, worst_energy = 0;
    for (int k = 0; k < r.sink.num_samples(); ++k) {
      const FourBar f = solve_four_bar(crank(k, 0));
      worst_gap = std::max({worst_gap, std::abs(wrap(crank(k, 0) + coupler(k, 0) - f.coupler)),
                            std::abs(wrap(rocker(k, 0) - f.rocker))});
      worst_rate = std::max(worst_rate, std::abs(rocker_rate(k, 0) - f.rocker_per_crank * rate(k, 0)));
      worst_energy = std::max(worst_energy, std::abs(calc_four_bar_energy(crank(k, 0), rate(k, 0)) - energy));
    }
    EXPECT_LT(worst_gap, 1e-12) << integrator;
    EXPECT_LT(worst_rate, 1e-11) << integrator;
    EXPECT_LT(worst_energy / energy, tolerance) << integrator;
    EXPECT_LT(energy_spread(r.sink), tolerance) << integrator;
    EXPECT_GT((crank.array() - crank(0, 0)).abs().maxCoeff(), 4.5) << integrator;  // most of the way round
  }
}

TEST(FourBar, ByBdf) {
  auto spec = make_four_bar();
  spec.simulation.integrator = "bdf";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-9;
  const RunResult r = run(spec);
  const MatrixXd crank = r.sink.get("/hinges/crank/q"), rocker = r.sink.get("/hinges/rocker/q");
  double worst_gap = 0;
  for (int k = 0; k < r.sink.num_samples(); ++k)
    worst_gap = std::max(worst_gap, std::abs(wrap(rocker(k, 0) - solve_four_bar(crank(k, 0)).rocker)));
  EXPECT_LT(worst_gap, 1e-12);
  EXPECT_LT(energy_spread(r.sink), 1e-4);
}

TEST(FourBar, NamesWhatIsHeldTwiceAndWhatWasMoved) {
  Diagnostics diagnostics;
  build_system(make_four_bar(), {}, diagnostics);
  std::string notes;
  for (const auto& d : diagnostics.items()) notes += d.id + ": " + d.what + "\n";
  EXPECT_TRUE(diagnostics.has("system.redundant-constraint"));
  EXPECT_THAT(notes, HasSubstr("constraint 'closing' holds 3 of its 5 directions twice"));
  EXPECT_THAT(notes, HasSubstr("the force along z, the moment along x, the moment along y"));
  EXPECT_TRUE(diagnostics.has("system.assembled"));
  EXPECT_THAT(notes, HasSubstr("hinge 'coupler' from 0 to"));
  EXPECT_EQ(notes.find("hinge 'crank' from"), std::string::npos);  // it was given
}

// The force of the closing pin does not depend on which pin is cut, in the plane, without redundant constraints.
TEST(FourBar, PassesOnTheSameForceAtWhicheverPinItIsCut) {
  auto spec = make_four_bar();
  spec.simulation.duration = 0.2;
  const RunResult one = run(spec);
  auto other = make_four_bar();
  other.simulation.duration = 0.2;
  // Cut between crank and coupler: the coupler hangs on the rocker.
  const FourBar f = solve_four_bar(0.7);
  other.hinges[1] = make_pin("coupler", "rocker", "coupler", 1);
  other.hinges[1].child_node = 1;
  other.hinges[1].position = {f.coupler - f.rocker};
  other.hinges[2].position = {f.rocker};
  other.constraints = {make_closing(HingeType::Cylindrical, "crank", 1, "coupler", 0)};
  const RunResult two = run(other);
  const Eigen::RowVectorXd a = one.sink.get("/hinges/coupler/reaction_force").bottomRows(1),
                           b = two.sink.get("/constraints/closing/reaction_force").bottomRows(1);
  EXPECT_GT(a.norm(), 1);
  EXPECT_LT((a - b).head(2).norm(), 1e-8 * a.norm());
}

TEST(SliderCrank, PistonIsWhereTheRodPutsIt) {
  records::SystemSpec spec;
  spec.bodies = {make_rod_record("crank", 0.3, 1), make_rod_record("rod", 0.8, 1), make_rod_record("piston", 0.1, 2)};
  spec.hinges = {make_pin("crank", "ground", "crank", 0), make_pin("rod", "crank", "rod", 1),
                 make_hinge_record("slide", HingeType::Prismatic, "ground", "piston")};
  spec.hinges[2].axis = {1, 0, 0};
  spec.hinges[2].position = {1};
  spec.hinges[0].rate = {10};
  spec.constraints = {make_closing(HingeType::Spherical, "rod", 1, "piston", 0)};
  spec.simulation.gravity = {0, -9.81, 0};
  const RunResult r = run_closely(spec, 2, 0.01, 1e-12);
  const MatrixXd crank = r.sink.get("/hinges/crank/q"), slide = r.sink.get("/hinges/slide/q");
  for (int k = 0; k < r.sink.num_samples(); ++k) {
    const double s = 0.3 * std::sin(crank(k, 0));
    EXPECT_NEAR(slide(k, 0), 0.3 * std::cos(crank(k, 0)) + std::sqrt(0.64 - s * s), 1e-12);
  }
  EXPECT_LT(energy_spread(r.sink), 1e-9);
  EXPECT_GT(crank(r.sink.num_samples() - 1, 0), 6);
}

// IFToMM A02: N + 1 rockers joined by N couplers, all 1 m and 1 kg, move as one parallelogram, through the flat
// position, where more dofs open for an instant.
TEST(NFourBar, KeepsItsEnergyThroughTheFlatPosition) {
  const int N = 5;
  records::SystemSpec spec;
  for (int k = 0; k <= N; ++k) {
    const std::string id = std::to_string(k);
    spec.bodies.push_back(make_rod_record("rocker" + id, 1, 1));
    spec.hinges.push_back(make_pin("rocker" + id, "ground", "rocker" + id, 0, {static_cast<double>(k), 0, 0}));
    spec.hinges.back().position = {std::acos(-1.0) / 2};
    spec.hinges.back().rate = {-1};
    if (k == N) continue;
    spec.bodies.push_back(make_rod_record("coupler" + id, 1, 1));
    spec.hinges.push_back(make_pin("coupler" + id, "rocker" + id, "coupler" + id, 1));
    spec.hinges.back().position = {-std::acos(-1.0) / 2};
    spec.hinges.back().rate = {1};
    auto c = make_closing(HingeType::Revolute, "coupler" + id, 1, "rocker" + std::to_string(k + 1), 1);
    c.name = "pin" + id;
    spec.constraints.push_back(c);
  }
  spec.simulation.gravity = {0, -9.81, 0};
  spec.simulation.duration = 3;
  spec.simulation.output_step = 0.05;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-10;
  const RunResult r = run(spec);
  const double inertia = (N + 1) / 3.0 + N, weight = 9.81 * ((N + 1) / 2.0 + N);
  const double energy = 0.5 * inertia + weight;
  const MatrixXd q = r.sink.get("/hinges/rocker0/q"), rate = r.sink.get("/hinges/rocker0/qdot"),
                 last = r.sink.get("/hinges/rocker5/q");
  for (int k = 0; k < r.sink.num_samples(); ++k) {
    EXPECT_NEAR(wrap(last(k, 0) - q(k, 0)), 0, 1e-7);
    EXPECT_NEAR(0.5 * inertia * rate(k, 0) * rate(k, 0) + weight * std::sin(q(k, 0)), energy, 1e-6 * energy);
  }
  EXPECT_LT(q(r.sink.num_samples() - 1, 0), -1);  // it went through
}

// IFToMM A04: six revolute hinges on the edges of a cube. Six dofs less six rows by counting, yet it moves: one row
// is held twice.
TEST(Bricard, MovesAndNamesTheRedundantRow) {
  const Vector3d p[] = {{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
  records::SystemSpec spec;
  // All frames are parallel to ground's at the start.
  const auto direction = [&](int i) { return Vector3d(p[(i + 1) % 6] - p[i]); };
  for (int i = 0; i < 5; ++i) {
    records::BodyRecord rod;
    const Vector3d d = direction(i);
    rod.name = "rod" + std::to_string(i);
    rod.mass = 1;
    rod.cg = 0.5 * d;
    rod.inertia = (Matrix3d::Identity() - d * d.transpose()) / 12 + 1e-4 * Matrix3d::Identity();
    rod.nodes = {{1, d}};
    spec.bodies.push_back(rod);
    auto pin = make_pin("pin" + std::to_string(i), i == 0 ? "ground" : "rod" + std::to_string(i - 1), rod.name,
                        i == 0 ? 0 : 1);
    pin.axis = direction((i + 5) % 6).cross(d);
    spec.hinges.push_back(pin);
  }
  auto state = make_closing(HingeType::Revolute, "rod4", 1, "ground", 0);
  state.child_position = p[5];
  state.axis = direction(4).cross(direction(5));
  spec.constraints = {state};
  spec.simulation.gravity = {0, -9.81, 0};
  spec.simulation.duration = 5;
  spec.simulation.output_step = 0.05;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
  const RunResult r = run(spec);
  std::string notes;
  for (const auto& d : r.diagnostics.items()) notes += d.what + "\n";
  EXPECT_THAT(notes, HasSubstr("constraint 'closing' holds 1 of its 5 directions twice"));
  EXPECT_LT(energy_spread(r.sink), 1e-8);
  const MatrixXd q = r.sink.get("/hinges/pin0/q");
  EXPECT_GT(q.maxCoeff() - q.minCoeff(), 0.5);
}

// The coupler of a four-bar as a flexible body with foreshortening and a pin at a moving node.
TEST(FlexibleLoop, KeepsItsEnergy) {
  records::SystemSpec spec;
  std::map<std::string, records::FlexBody> flex;
  PointBody points = make_point_body(3, 11);
  records::FlexBody file = points.make_record("coupler");
  file.modal_damping.setZero();
  records::BodyRecord coupler;
  coupler.name = "coupler";
  coupler.file = "coupler.h5";
  flex.emplace("coupler.h5", file);
  Random random(4);
  spec.bodies = {make_rigid_record("crank", random), coupler, make_rigid_record("rocker", random)};
  spec.hinges = {make_hinge_record("crank", HingeType::Revolute, "ground", "crank"),
                 make_hinge_record("coupler", HingeType::Universal, "crank", "coupler"),
                 make_hinge_record("rocker", HingeType::Spherical, "ground", "rocker")};
  spec.hinges[1].parent_node = 101;
  spec.hinges[1].child_node = 102;
  spec.hinges[2].parent_position = {0.5, 0.3, -0.2};
  spec.hinges[0].rate = {2};
  spec.constraints = {make_closing(HingeType::Spherical, "coupler", 104, "rocker", 102)};
  spec.simulation.gravity = {0, -9.81, 0};
  const RunResult r = run_closely(spec, 1, 0.02, 1e-12, flex);
  EXPECT_LT(energy_spread(r.sink), 1e-9);
  EXPECT_GT(r.sink.get("/bodies/coupler/eta").cwiseAbs().maxCoeff(), 1e-3);
}

// Two gears on ground: the motion of one wheel with the inertia J1 + J2/ratio².
TEST(Coupler, GearsShareTheTorque) {
  records::SystemSpec spec;
  for (const std::string name : {"small", "large"}) {
    spec.bodies.push_back(make_body_record(name, 1, {1, 1, name == "small" ? 0.5 : 3}));
    spec.hinges.push_back(make_pin(name, "ground", name, 0));
  }
  spec.forces = {make_force("torque", "small", {0, 0, 2}, "", records::ForceKind::Moment)};
  ConstraintRecord gear;
  gear.name = "gear";
  gear.type = ConstraintType::Coupler;
  gear.terms = {{"small", 1, 1}, {"large", 1, 3}};  // small = -3 large
  spec.constraints = {gear};
  spec.simulation.duration = 1;
  const RunResult r = run(spec);
  const double acceleration = 2 / (0.5 + 3.0 / 9);
  const int last = r.sink.num_samples() - 1;
  EXPECT_NEAR(r.sink.get("/hinges/small/q")(last, 0), 0.5 * acceleration, 1e-8);
  EXPECT_NEAR(r.sink.get("/hinges/large/q")(last, 0), -acceleration / 6, 1e-8);
  EXPECT_NEAR(r.sink.get("/constraints/gear/force")(last, 0), 0.5 * acceleration - 2, 1e-8);
  // Driven: the motor of the small wheel feels the large one, and its work is the energy.
  spec.functions = {make_function("f", "sine", {{"amplitude", 0.5}, {"omega", 2}})};
  spec.forces.clear();
  spec.hinges[0].motion = {"f"};
  const RunResult driven = run(spec);
  EXPECT_NEAR(driven.sink.get("/hinges/small/force")(last, 0), (0.5 + 3.0 / 9) * -2 * std::sin(2.0), 1e-8);
  EXPECT_LT(energy_spread(driven.sink), 1e-7);
}

// A point mass on a rod of given length is a spherical pendulum.
TEST(Distance, IsAPendulum) {
  records::SystemSpec spec;
  spec.bodies = {make_body_record("ball", 2, {1, 1, 1})};
  spec.hinges = {make_hinge_record("free", HingeType::Free, "ground", "ball")};
  spec.hinges[0].position = {1, 0, 0, 0, 0.6, 0, -0.8};
  spec.constraints = {make_distance("rod", "ball", 1)};
  spec.simulation.gravity = {0, 0, -9.81};
  spec.simulation.duration = 2;
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-11;
  const RunResult r = run(spec);
  const MatrixXd p = r.sink.get("/bodies/ball/position"), v = r.sink.get("/bodies/ball/velocity"),
                 f = r.sink.get("/constraints/rod/reaction_force");
  for (int k = 0; k < r.sink.num_samples(); k += 50) {
    EXPECT_NEAR(p.row(k).norm(), 1, 1e-13);
    // Tension: m (v²/l + g cos), towards the pivot.
    const double tension = 2 * (v.row(k).squaredNorm() - 9.81 * p(k, 2));
    EXPECT_LT((Vector3d(f.row(k)) + tension * Vector3d(p.row(k))).norm(), 1e-7 * tension);
  }
  EXPECT_LT(energy_spread(r.sink), 1e-9);
}

TEST(Assembly, SaysWhatCannotBeClosed) {
  auto spec = make_four_bar();
  spec.hinges[2].parent_position = {9, 0, 0};
  spec.hinges[0].locked = {true};
  spec.hinges[0].rate.clear();
  Diagnostics diagnostics;
  draft_system(spec, {}, diagnostics);
  ASSERT_TRUE(diagnostics.has("system.cannot-assemble"));
  for (const auto& d : diagnostics.items()) {
    if (d.id != "system.cannot-assemble") continue;
    EXPECT_THAT(d.what, HasSubstr("the positions of constraint 'closing' stay off by"));
    EXPECT_THAT(d.what, HasSubstr("runs through hinge 'coupler', 'crank' (locked or prescribed), 'rocker'"));
    EXPECT_EQ(d.where.line, 40);
  }
}

TEST(Assembly, BendsAStretchedMechanism) {
  auto spec = make_four_bar();
  for (auto& h : spec.hinges) h.position.clear();  // everything along x
  Diagnostics diagnostics;
  const System system = build_system(spec, {}, diagnostics);
  auto data = system.make_data();
  VectorXd q(system.num_q()), u(system.num_u());
  system.calc_initial_state(q, u);
  calc_kinematics(system, *data, 0, q, u);
  calc_closure_positions(system.loops, system.tree, data->tree, data->loops);
  EXPECT_LT(calc_largest_position_error(system.loops, data->loops), 1e-12);
  EXPECT_NEAR(u[0], 3, 1e-12);
}

TEST(Assembly, ErrorsOfConstraints) {
  const auto report = [](const std::function<void(records::SystemSpec&)>& spoil) {
    auto spec = make_four_bar();
    spoil(spec);
    Diagnostics diagnostics;
    draft_system(spec, {}, diagnostics);
    std::string ids;
    for (const auto& d : diagnostics.items()) {
      if (d.severity == Severity::Error) ids += d.id + " ";
    }
    return ids;
  };
  EXPECT_EQ(report([](auto& s) { s.constraints[0].child = "roker"; }), "system.unknown-body ");
  EXPECT_EQ(report([](auto& s) { s.constraints[0].child_node = 7; }), "system.unknown-node ");
  EXPECT_EQ(report([](auto& s) { s.constraints[0].hinge = HingeType::Free; }), "system.bad-constraint ");
  EXPECT_EQ(report([](auto& s) { s.constraints[0].parent = "rocker"; }), "system.bad-constraint ");
  EXPECT_EQ(report([](auto& s) { s.constraints[0].type = ConstraintType::Distance; }), "system.bad-constraint ");
  EXPECT_EQ(report([](auto& s) { s.constraints[0].axis.setZero(); }), "system.zero-axis ");
  EXPECT_EQ(report([](auto& s) { s.constraints.push_back(s.constraints[0]); }), "system.duplicate-name ");
  EXPECT_EQ(report([](auto& s) {
              s.constraints[0].type = ConstraintType::Coupler;
              s.constraints[0].terms = {{"crnk", 1, 1}};
            }),
            "system.unknown-hinge ");
  EXPECT_EQ(report([](auto& s) {
              s.constraints[0].type = ConstraintType::Coupler;
              s.constraints[0].terms = {{"crank", 2, 1}};
            }),
            "system.bad-constraint ");
}

// A loop elsewhere that needs given values to give way does not touch one that does not.
TEST(FourBar, KeepsItsGivenCrankWhateverElseIsAssembled) {
  auto spec = make_four_bar();
  auto ball = make_rod_record("ball", 0.1, 1);
  spec.bodies.push_back(ball);
  auto free = make_hinge_record("fly", HingeType::Free, "ground", "ball");
  free.position = {1, 0, 0, 0, 5, 1, 0};
  spec.hinges.push_back(free);
  ConstraintRecord string;
  string.name = "string";
  string.type = ConstraintType::Distance;
  string.child = "ball";
  string.length = 4.9;
  spec.constraints.push_back(string);
  const System system = build(spec);
  VectorXd q(system.num_q()), u(system.num_u());
  system.calc_initial_state(q, u);
  EXPECT_NEAR(q[system.q_offset(system.find_body("crank"))], 0.7, 1e-9);
  EXPECT_NEAR(u[system.u_offset(system.find_body("crank"))], 3, 1e-8);
  const int at = system.q_offset(system.find_body("ball")) + 4;
  EXPECT_NEAR(q.segment<3>(at).norm(), 4.9, 1e-9);
}

/// A four-bar whose spring at the crank swings 2,000 rad/s at full stiffness.
records::SystemSpec make_stiff_bar(double stiffness, double step) {
  auto spec = make_four_bar();
  spec.hinges[0].stiffness = {stiffness};
  spec.hinges[0].null_position = {0.7};
  spec.hinges[1].damping = {0.2};
  spec.simulation.duration = 0.5;
  spec.simulation.output_step = 0.02;
  spec.simulation.step = step;
  spec.simulation.integrator = "implicit";
  spec.simulation.energy_error_limit = 1e9;
  return spec;
}

TEST(Loops, TheImplicitMethodIsOfOrderTwoBesideThem) {
  auto exact = make_stiff_bar(40, 0);
  exact.simulation.integrator = "rk";
  exact.simulation.relative_tolerance = 1e-12;
  exact.simulation.absolute_tolerance = 1e-13;
  const MemorySink reference = run(exact).sink;
  double before = 0;
  for (const double step : {4e-3, 2e-3, 1e-3, 5e-4}) {
    const RunResult r = run(make_stiff_bar(40, step));
    double error = 0;
    for (const char* path : {"/hinges/crank/q", "/hinges/coupler/qdot", "/hinges/rocker/q"})
      error = std::max(error, (r.sink.get(path) - reference.get(path)).cwiseAbs().maxCoeff());
    if (before > 0) EXPECT_NEAR(before / error, 4, 0.5) << step;
    before = error;
    // The loop stands closed at every sample.
    const auto crank = r.sink.get("/hinges/crank/q"), coupler = r.sink.get("/hinges/coupler/q"),
               rocker = r.sink.get("/hinges/rocker/q");
    for (int k = 0; k < r.sink.num_samples(); ++k) {
      const double a = crank(k, 0), b = a + coupler(k, 0), c = rocker(k, 0);
      EXPECT_NEAR(kCrank * std::cos(a) + kCoupler * std::cos(b), kBase + kRocker * std::cos(c), 1e-12);
      EXPECT_NEAR(kCrank * std::sin(a) + kCoupler * std::sin(b), kRocker * std::sin(c), 1e-12);
    }
  }
  EXPECT_LT(before, 1e-4);
}

TEST(Loops, TheImplicitMethodStepsOverStiffSpringsBesideThem) {
  // 4e6 N m/rad swing at some thousand rad/s: 10 ms are dozens of radians a step.
  auto spec = make_stiff_bar(4e6, 0.01);
  spec.hinges[0].rate = {0};
  const RunResult r = run(spec);
  EXPECT_TRUE(r.outcome.completed);
  EXPECT_LT((r.sink.get("/hinges/crank/q").array() - 0.7).abs().maxCoeff(), 1e-4);
  auto explicit_one = spec;
  explicit_one.simulation.integrator = "rk4";
  MemorySink sink;
  Diagnostics diagnostics;
  const System system = build(explicit_one);
  EXPECT_THROW(simulate(system, explicit_one, sink, {}, diagnostics), Failure);
}

}  // namespace
}  // namespace bough::solver::testing
