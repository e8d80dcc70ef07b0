// The spun-up beam of NASA-CR-202063, 4.1.4.1, as 1, 2, 4, 8 Craig-Bampton bodies on fixed hinges: each body's frame
// rides on its inner node, its outer node is the interface. What one body pulls on the other stiffens it through the
// attachment Jacobian φ - K_G2 η alone. Reference: a geometrically exact beam, -0.5338 m at 6.766 s.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/cases/support/example.hpp"
#include "tests/support/beam_decks.hpp"

namespace bough::test {
namespace {

constexpr double kPeak = -0.5338, kPeakTime = 6.766;

struct Peak {
  double v = 0, t = 0;
};

/// Of the parabola through the three samples around the smallest; that itself where it is the first or the last.
Peak find_peak(const VectorXd& t, const VectorXd& v) {
  const int i = find_minimum(v);
  if (i == 0 || i + 1 == v.size()) return {v[i], t[i]};
  const double a = v[i - 1] - v[i], b = v[i + 1] - v[i], h = t[i + 1] - t[i];
  const double s = 0.5 * (a - b) / (a + b);
  return {v[i] - 0.25 * (a - b) * s, t[i] + s * h};
}

/// Modes that only stretch a part are left out: their frequencies are hundreds of times those of bending.
Peak run_chain(int num_bodies, const records::BodySpec& body, bool hinges_stiffen) {
  constexpr int num_elements = 40;
  const double length = kReportLength / num_bodies;
  DeckMaker maker = make_cantilever(get_report_section(), length, num_elements / num_bodies);
  maker.fix_all(345);
  Example example = load_example("ex01-spinup", "spinup.toml");
  auto spec = body;
  const int outer = num_elements / num_bodies + 1;
  spec.name = "part";
  spec.interface_nodes = {outer};
  spec.output_nodes = {1, outer};
  const auto first_body = example.spec.bodies[0];
  const auto spin = example.spec.hinges[0];
  auto flex = reduce(maker.deck, spec);
  std::vector<int> bending;
  for (int j = 0; j < flex.num_modes(); ++j)
    if (flex.phi[1].col(j).tail<1>().norm() > 1e-6 * flex.phi[1].cwiseAbs().maxCoeff()) bending.push_back(j + 1);
  spec.select = bending;
  flex = reduce(maker.deck, spec);
  if (!hinges_stiffen)
    for (auto& K_G : flex.kg_external) K_G.setZero();
  example.flex = {{first_body.file, flex}};
  example.spec.bodies.clear();
  example.spec.hinges.clear();
  for (int i = 0; i < num_bodies; ++i) {
    auto part = first_body;
    part.name = "part" + std::to_string(i + 1);
    auto hinge = spin;
    hinge.child = part.name;
    if (i > 0) {
      hinge.name = "joint" + std::to_string(i);
      hinge.type = records::HingeType::Fixed;
      hinge.parent = "part" + std::to_string(i);
      hinge.parent_node = outer;
      hinge.motion.clear();
    }
    example.spec.bodies.push_back(part);
    example.spec.hinges.push_back(hinge);
  }
  records::SensorRecord tip;
  tip.name = "tip";
  tip.type = records::SensorType::Position;
  tip.body = example.spec.bodies.back().name;
  tip.node = outer;
  tip.frame = tip.relative_to = "part1";
  example.spec.sensors = {tip};
  example.spec.simulation.duration = 7.5;
  example.spec.simulation.relative_tolerance = 1e-8;
  example.spec.simulation.absolute_tolerance = 1e-10;
  solver::MemorySink sink;
  example.run(sink);
  return find_peak(sink.time(), sink.get("/sensors/tip").col(1));
}

/// Constraint modes of the outer node and two fixed-interface modes; the motion is in the plane, bending: what
/// stretches the beam is left out, its lowest frequency is 600 times that of bending.
records::BodySpec make_body() {
  records::BodySpec body;
  body.basis = records::BodyBasis::CraigBampton;
  body.num_modes = 2;
  return body;
}

TEST(CraigBamptonChain, TendsToTheGeometricallyExactBeam) {
  for (const int num_bodies : {1, 2, 4, 8}) {
    const Peak peak = run_chain(num_bodies, make_body(), true);
    record("peak" + std::to_string(num_bodies), peak.v);
    record("time" + std::to_string(num_bodies), peak.t);
    const double error = std::abs(peak.v / kPeak - 1);
    record("error" + std::to_string(num_bodies), error);
    EXPECT_LT(error, num_bodies == 1 ? 0.007 : num_bodies == 2 ? 0.002 : 0.001);
    EXPECT_NEAR(peak.t, kPeakTime, num_bodies >= 4 ? 0.005 : 0.02);
  }
}

// Without K_G2 the hinge forces do not stiffen, and the inner bodies, which carry the outer ones, bend too far.
TEST(CraigBamptonChain, NeedsTheStiffeningOfItsHinges) {
  const Peak peak = run_chain(2, make_body(), false);
  record("peak", peak.v);
  record("peak_time", peak.t);
  EXPECT_LT(peak.v, 1.1 * kPeak);
}

}  // namespace
}  // namespace bough::test
