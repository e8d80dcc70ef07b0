// One free body, pushed at its tip, seen from different body frames: its nodes move alike in inertial space. The
// kinetic energy leaves out what is cubic in the deflection and its rate together, and how much that is depends on the
// frame: the difference is of second order, a sixteenth for a quarter of the push.
#include <gtest/gtest.h>

#include "tests/cases/support/example.hpp"
#include "tests/support/beam_decks.hpp"

namespace bough::test {
namespace {

MatrixXd run_pushed(records::BodyFrame frame, const std::vector<int>& nodes, double force) {
  DeckMaker maker;
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-9, 3e-9, 2e-9}, true);
  maker.add_line(1, 1, {0, 0, 0}, {2, 0, 0}, 10, Vector3d::UnitY());
  maker.add_line(1, 101, {1, 0, 0}, {1, 0.8, 0.3}, 5, Vector3d::UnitX(), 6);
  records::BodySpec spec;
  spec.name = "flyer";
  spec.frame = frame;
  spec.frame_nodes = nodes;
  spec.interface_nodes = {1, 11, 106};
  spec.basis = records::BodyBasis::CraigBampton;
  spec.num_modes = 2;
  spec.select = {1, 2, 3, 4, 5, 6};
  spec.damping_ratio = 0.01;
  Example example;
  example.flex = {{"flyer.h5", reduce(maker.deck, spec)}};
  records::BodyRecord body;
  body.name = "flyer";
  body.file = "flyer.h5";
  example.spec.bodies = {body};
  records::HingeRecord hinge;
  hinge.name = "flight";
  hinge.type = records::HingeType::Free;
  hinge.child = "flyer";
  example.spec.hinges = {hinge};
  records::ForceRecord push;
  push.name = "push";
  push.body = "flyer";
  push.node = 11;
  push.direction = force * Vector3d(0.3, 1, 0.5);
  push.frame = records::VectorFrame::Inertial;
  example.spec.forces = {push};
  for (const int node : {1, 11, 106}) {
    records::SensorRecord sensor;
    sensor.name = "p" + std::to_string(node);
    sensor.body = "flyer";
    sensor.node = node;
    example.spec.sensors.push_back(sensor);
  }
  example.spec.simulation.duration = 0.3;
  example.spec.simulation.output_step = 0.01;
  example.spec.simulation.relative_tolerance = 1e-11;
  example.spec.simulation.absolute_tolerance = 1e-14;
  solver::MemorySink sink;
  example.run(sink);
  MatrixXd paths(sink.time().size(), 9);
  paths << sink.get("/sensors/p1"), sink.get("/sensors/p11"), sink.get("/sensors/p106");
  return paths;
}

TEST(Frames, MotionDoesNotDependOnTheBodyFrame) {
  using records::BodyFrame;
  const double force = 0.25;
  const MatrixXd mean = run_pushed(BodyFrame::MeanAxes, {}, force),
                 mean_quarter = run_pushed(BodyFrame::MeanAxes, {}, force / 4);
  const MatrixXd rest = mean.row(0).replicate(mean.rows(), 1);
  const double moved = (mean - rest).cwiseAbs().maxCoeff();
  record("moved", moved);
  const std::vector<std::pair<BodyFrame, std::vector<int>>> frames = {{BodyFrame::Node, {1}},
                                                                      {BodyFrame::Node, {106}},
                                                                      {BodyFrame::ThreeNodes, {1, 11, 106}},
                                                                      {BodyFrame::MassCentre, {6}}};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& [frame, nodes] = frames[i];
    const double full = (run_pushed(frame, nodes, force) - mean).cwiseAbs().maxCoeff();
    const double quarter = (run_pushed(frame, nodes, force / 4) - mean_quarter).cwiseAbs().maxCoeff();
    record("difference" + std::to_string(i), full / moved);
    EXPECT_LT(full, 1e-4 * moved);
    EXPECT_NEAR(full / quarter, 16, 1.5);
  }
}

}  // namespace
}  // namespace bough::test
