// IFToMM's library of computational benchmark problems, A01, A03 and A05 (A02: change_points_test, A04:
// mechanisms_test): parameters of the library, or of the literature named, our own references.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "tests/solver/support/jacobi.hpp"
#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;
constexpr double kG = 9.81;

records::BodyRecord make_body(const std::string& name, double mass, const Vector3d& cg, double Jz) {
  records::BodyRecord body;
  body.name = name;
  body.mass = mass;
  body.cg = cg;
  body.inertia = Vector3d(Jz, Jz, Jz).asDiagonal();
  return body;
}

records::HingeRecord make_pin(const std::string& parent, const std::string& child, const Vector3d& at, double angle) {
  auto pin = make_hinge_record(child, HingeType::Revolute, parent, child);
  pin.parent_position = at;
  pin.position = {angle};
  return pin;
}

// A01: 1 kg at 1 m, let go level, 10 s. The library's measure: position and energy.
TEST(Iftomm, A01SimplePendulum) {
  records::SystemSpec spec;
  spec.bodies = {make_body("rod", 1, {1, 0, 0}, 0)};
  spec.hinges = {make_pin("ground", "rod", {0, 0, 0}, std::numbers::pi)};
  spec.simulation.gravity = {0, -kG, 0};
  spec.simulation.duration = 10;
  spec.simulation.output_step = 0.01;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
  const RunResult r = run(spec);
  // From the lowest point: sin(θ/2) = k sn(ω t + K), k = sin 45°; K by the arithmetic-geometric mean.
  const double k = std::sqrt(0.5), w = std::sqrt(kG);
  double a = 1, b = std::sqrt(1 - k * k);
  for (int i = 0; i < 10; ++i) std::tie(a, b) = std::make_tuple(0.5 * (a + b), std::sqrt(a * b));
  const double K = std::numbers::pi / (2 * a);
  const VectorXd t = r.sink.time(), q = r.sink.get("/hinges/rod/q").col(0);
  double worst = 0;
  for (int i = 0; i < t.size(); ++i) {
    const double theta = -2 * std::asin(k * calc_jacobi(w * t[i] + K, k).sn);  // of the side it starts on
    worst = std::max(worst, std::abs(std::sin(theta) - std::cos(q[i])));
  }
  EXPECT_LT(worst, 1e-10);
  const VectorXd energy = (r.sink.get("/energy/kinetic") + r.sink.get("/energy/potential")).col(0);
  EXPECT_LT((energy.array() - energy[0]).abs().maxCoeff(), 1e-10);
}

// A03: Andrews' squeezing mechanism. Parameters and the state at 0.03 s: Hairer & Wanner, "Solving Ordinary
// Differential Equations II", VII.7, and the test set for IVP solvers of Bari (its reference solution).
TEST(Iftomm, A03AndrewsSqueezer) {
  const double d = 0.028, da = 0.0115, e = 0.02, ea = 0.01421, rr = 0.007, ra = 0.00092, ss = 0.035, sa = 0.01874,
               sb = 0.01043, sc = 0.018, sd = 0.02, zt = 0.04, ta = 0.02308, tb = 0.00916, u = 0.04, ua = 0.01228,
               ub = 0.00449, zf = 0.02, fa = 0.01421;
  const Vector3d A(-0.06934, -0.00227, 0), B(-0.03635, 0.03273, 0), C(0.014, 0.072, 0);
  records::SystemSpec spec;
  // 1 the crank, 2 on it, 3 at B, 4 on 5, 5 at A, 6 on 7, 7 at A. There is no gravity, so that of what is pinned to
  // ground only the distance of the mass centre counts.
  spec.bodies = {
      make_body("k1", 0.04325, {ra, 0, 0}, 2.194e-6),        make_body("k2", 0.00365, {-da, 0, 0}, 4.410e-7),
      make_body("k3", 0.02373, {sb, -sa, 0}, 5.255e-6),      make_body("k5", 0.07050, {ta, tb, 0}, 1.169e-5),
      make_body("k4", 0.00706, {0, -(e - ea), 0}, 5.667e-7), make_body("k7", 0.05498, {ub, -ua, 0}, 1.912e-5),
      make_body("k6", 0.00706, {zf - fa, 0, 0}, 5.667e-7)};
  spec.bodies[1].nodes = {{1, {-d, 0, 0}}};
  spec.bodies[2].nodes = {{1, {0, -ss, 0}}, {2, {sd, -sc, 0}}};
  spec.bodies[4].nodes = {{1, {0, -e, 0}}};
  spec.bodies[6].nodes = {{1, {zf, 0, 0}}};
  const double beta = -0.0617138900142764496358948458001, gamma = 0.455279819163070380255912382449,
               phi = 0.222668390165885884674473185609, delta = 0.487364979543842550225598953530,
               epsilon = 1.23054744454982119249735015568;
  spec.hinges = {make_pin("ground", "k1", {0, 0, 0}, beta), make_pin("k1", "k2", {rr, 0, 0}, 0),
                 make_pin("ground", "k3", B, gamma),        make_pin("ground", "k5", A, delta),
                 make_pin("k5", "k4", {zt, 0, 0}, phi),     make_pin("ground", "k7", A, epsilon),
                 make_pin("k7", "k6", {0, -u, 0}, -phi)};
  for (const std::string body : {"k3", "k4", "k6"}) {
    records::ConstraintRecord c;
    c.name = "to_" + body;
    c.hinge = HingeType::Revolute;
    c.parent = "k2";
    c.child = body;
    c.parent_node = c.child_node = 1;
    spec.constraints.push_back(c);
  }
  spec.force_elements = {make_spring("spring", "k3", C, 4530, 0.07785)};
  spec.force_elements[0].from.node = 2;
  spec.forces = {make_force("motor", "k1", {0, 0, 0.033}, "", records::ForceKind::Moment)};
  spec.simulation.duration = 0.03;
  spec.simulation.output_step = 1e-3;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-12;
  const RunResult r = run(spec);
  const struct {
    const char* name;
    double angle, rate;
  } expected[] = {
      {"k1", 0.1581077119629904e2, 0.1139920302151208e4},  {"k2", -0.1575637105984298e2, -0.1424379294994111e4},
      {"k3", 0.4082224013073101e-1, 0.1103291221937134e2}, {"k4", -0.5347301163226948, 0.1929337464421385e2},
      {"k5", 0.5244099658805304, 0.5735699284790808},      {"k6", 0.5347301163226948, -0.1929337464421385e2},
      {"k7", 0.1048080741042263e1, 0.3231791658026955}};
  for (const auto& x : expected) {
    EXPECT_NEAR(get_last(r.sink, std::string("/hinges/") + x.name + "/q"), x.angle, 1e-7 * std::abs(x.angle)) << x.name;
    EXPECT_NEAR(get_last(r.sink, std::string("/hinges/") + x.name + "/qdot"), x.rate, 1e-6 * 1e3) << x.name;
  }
  EXPECT_LT(r.sink.energy_error(), 1e-8);
}

/// A05's stiff governor as an equation of two coordinates, α of the rods and s of the slider, at constant angular
/// momentum about the shaft.
class Governor {
 public:
  static constexpr double kRod = 0.3, kBall = 5, kSlider = 3, kK = 8e5, kC = 4e4, kLength = 0.5;
  static constexpr double kAcross = kRod / 3 + kBall, kAlong = 5e-6;  // inertia of a rod about its pin, about itself
  static constexpr double kMoment = kRod / 2 + kBall;
  static constexpr double kFixed = 1e-2 + 5e-3;  // of shaft and slider about the shaft

  static double calc_inertia(double a) {
    return kFixed + 2 * (kAcross * std::pow(std::sin(a), 2) + kAlong * std::pow(std::cos(a), 2));
  }
  explicit Governor(double a, double spin)
      : y_(a, 0, 0.5 * std::cos(a) + std::sqrt(0.25 - std::pow(0.5 * std::sin(a), 2)), 0),
        momentum_(calc_inertia(a) * spin) {}
  void step(double h) {
    const Eigen::Vector4d k1 = f(y_), k2 = f(y_ + h / 2 * k1), k3 = f(y_ + h / 2 * k2), k4 = f(y_ + h * k3);
    y_ += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  double angle() const { return y_[0]; }
  double slider() const { return y_[2]; }
  double spin() const { return momentum_ / calc_inertia(y_[0]); }

 private:
  Eigen::Vector4d f(const Eigen::Vector4d& y) const {
    const double a = y[0], s = y[2], spin = momentum_ / calc_inertia(a);
    const double x = 0.5 * std::sin(a), z = s - 0.5 * std::cos(a), l = std::hypot(x, z);
    const double l_a = (x * 0.5 * std::cos(a) + z * 0.5 * std::sin(a)) / l, l_s = z / l;
    const double tension = kK * (l - kLength) + kC * (l_a * y[1] + l_s * y[3]);
    const double torque =
        std::sin(a) * std::cos(a) * (kAcross - kAlong) * spin * spin - kG * kMoment * std::sin(a) - tension * l_a;
    return {y[1], torque / kAcross, y[3], (kSlider * kG - 2 * tension * l_s) / kSlider};
  }
  Eigen::Vector4d y_;
  double momentum_;
};

TEST(Iftomm, A05FlyballGovernor) {
  const double a0 = std::numbers::pi / 6, spin = 2 * std::numbers::pi;
  records::SystemSpec spec;
  auto shaft = make_body("shaft", 0.3, {0, 0, 0}, 1e-2),
       slider = make_body("slider", Governor::kSlider, {0, 0, 0}, 5e-3);
  spec.bodies = {shaft, slider};
  auto axis = make_hinge_record("shaft", HingeType::Revolute, "ground", "shaft");
  axis.rate = {spin};
  auto slide = make_hinge_record("slider", HingeType::Prismatic, "shaft", "slider");
  slide.axis = {0, 0, -1};
  slide.position = {0.5 * std::cos(a0) + std::sqrt(0.25 - std::pow(0.5 * std::sin(a0), 2))};
  spec.hinges = {axis, slide};
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "right" : "left";
    // Hangs along -z; the rod with its ball.
    const double mass = Governor::kRod + Governor::kBall, c = Governor::kMoment / mass;
    auto rod = make_body(name, mass, {0, 0, -c}, 0);
    const double J = Governor::kAcross - mass * c * c;
    rod.inertia = Vector3d(J, J, Governor::kAlong).asDiagonal();
    rod.nodes = {{1, {0, 0, -0.5}}};
    spec.bodies.push_back(rod);
    auto pin = make_pin("shaft", name, {0, 0, 0}, a0);
    pin.axis = {0, -side, 0};
    spec.hinges.push_back(pin);
    records::ForceElementRecord link;
    link.name = "link_" + name;
    link.type = records::ElementType::Spring;
    link.from.body = name;
    link.from.node = 1;
    link.to.body = "slider";
    link.stiffness = Governor::kK;
    link.damping = Governor::kC;
    link.free_length = Governor::kLength;
    spec.force_elements.push_back(link);
  }
  spec.simulation.gravity = {0, 0, -kG};
  spec.simulation.duration = 2;
  spec.simulation.output_step = 0.1;
  spec.simulation.integrator = "bdf";
  spec.simulation.relative_tolerance = spec.simulation.absolute_tolerance = 1e-10;
  const RunResult r = run(spec);
  Governor governor(a0, spin);
  const double h = 1e-5;
  double least = a0, most = a0;
  for (int i = 0; i <= 20; ++i) {
    EXPECT_NEAR(r.sink.get("/hinges/right/q")(i, 0), governor.angle(), 1e-6) << i;
    EXPECT_NEAR(r.sink.get("/hinges/left/q")(i, 0), governor.angle(), 1e-6) << i;
    EXPECT_NEAR(r.sink.get("/hinges/slider/q")(i, 0), governor.slider(), 1e-6) << i;
    EXPECT_NEAR(r.sink.get("/hinges/shaft/qdot")(i, 0), governor.spin(), 1e-5) << i;
    for (int k = 0; k < 10000; ++k) governor.step(h);
    least = std::min(least, governor.angle());
    most = std::max(most, governor.angle());
  }
  EXPECT_GT(most - least, 0.2);
}

}  // namespace
}  // namespace bough::solver::testing
