/// Bases, frames and damping through the body file's record: what reduce makes of them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "stiffening/reduce.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

using records::BodyBasis;
using records::BodyFrame;
using records::BodySpec;
using records::FlexBody;
using records::ModeKind;

test::DeckMaker make_frame() {
  auto maker = test::make_space_frame();
  maker.add_mass(900, 106, 0.2);
  maker.add_load(30, 106, {0, 2, 1});
  maker.fix(1, 123456);
  return maker;
}

BodySpec make_spec(BodyFrame frame, int num_modes = 6) {
  BodySpec spec;
  spec.file = "frame.toml";
  spec.name = "frame";
  spec.frame = frame;
  spec.num_modes = num_modes;
  spec.interface_nodes = {1, 9};
  return spec;
}

FlexBody reduce(const records::Deck& deck, const BodySpec& spec) {
  Diagnostics diagnostics;
  return stiffening::reduce(deck, spec, {}, diagnostics).body;
}

/// Free frequencies of the body as the solver sees it at rest: [v; ω; η].
VectorXd calc_free_eigenvalues(const FlexBody& body) {
  const int n = body.num_modes();
  MatrixXd M = MatrixXd::Zero(6 + n, 6 + n), K = M;
  const Vector3d c = body.mass * body.cg;
  M.topLeftCorner(3, 3) = body.mass * MatrixXd::Identity(3, 3);
  M.block<3, 3>(3, 0) << 0, -c.z(), c.y(), c.z(), 0, -c.x(), -c.y(), c.x(), 0;
  M.block<3, 3>(0, 3) = M.block<3, 3>(3, 0).transpose().eval();
  M.block<3, 3>(3, 3) = body.inertia;
  M.block(0, 6, 3, n) = body.exact.gamma0;
  M.block(3, 6, 3, n) = body.exact.gamma1;
  M.block(6, 0, n, 6) = M.block(0, 6, 6, n).transpose().eval();
  M.bottomRightCorner(n, n) = body.modal_mass;
  K.bottomRightCorner(n, n) = body.modal_stiffness;
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M).eigenvalues().tail(n);
}

const std::vector<std::pair<BodyFrame, std::vector<int>>> kFrames = {{BodyFrame::Free, {}},
                                                                     {BodyFrame::MeanAxes, {}},
                                                                     {BodyFrame::Node, {4}},
                                                                     {BodyFrame::MassCentre, {}},
                                                                     {BodyFrame::ThreeNodes, {1, 9, 106}},
                                                                     {BodyFrame::MassCentre, {9}}};

TEST(Bases, FreeFrequenciesDoNotDependOnTheFrame) {
  const auto maker = make_frame();
  const VectorXd expected = reduce(maker.deck, make_spec(BodyFrame::Free)).eigenvalue;
  for (const auto basis : {BodyBasis::Normal, BodyBasis::CraigChang}) {
    VectorXd first;
    for (const auto& [frame, nodes] : kFrames) {
      auto spec = make_spec(frame);
      spec.basis = basis;
      spec.frame_nodes = nodes;
      const auto body = reduce(maker.deck, spec);
      const VectorXd lambda = calc_free_eigenvalues(body);
      for (int j = 0; j < 6; ++j) EXPECT_NEAR(lambda(j) / expected(j), 1, 1e-9);
      if (first.size() == 0) first = lambda;
      EXPECT_LT((lambda.cwiseQuotient(first).array() - 1).abs().maxCoeff(), 1e-8);
      EXPECT_EQ(body.is_free_free, frame != BodyFrame::Node && frame != BodyFrame::ThreeNodes);
      const double size = body.modal_mass.diagonal().maxCoeff();
      if (frame == BodyFrame::MeanAxes) {
        EXPECT_LT(body.exact.gamma0.norm() + body.exact.gamma1.norm(), 1e-9 * size);
      }
      if (frame == BodyFrame::MassCentre) {
        EXPECT_LT(body.exact.gamma0.norm(), 1e-9 * size);
      }
      if (frame == BodyFrame::Node) {
        EXPECT_EQ(body.phi[3].norm(), 0);
        EXPECT_GT(body.exact.gamma0.norm(), 1e-3);
      }
    }
  }
}

// A frame on a node is what clamping the node is: the same body, with Craig-Bampton modes of a complete interface.
TEST(Bases, FrameOnANodeIsTheClampedBody) {
  const auto maker = make_frame();
  auto spec = make_spec(BodyFrame::Node);
  spec.frame_nodes = {1};
  spec.basis = BodyBasis::CraigBampton;
  spec.orthogonalize = false;
  const auto on_node = reduce(maker.deck, spec);
  spec.frame = BodyFrame::Fixed;
  spec.frame_nodes = {};
  const auto clamped = reduce(maker.deck, spec);
  ASSERT_EQ(on_node.num_modes(), 12);
  EXPECT_LT((on_node.modal_mass - clamped.modal_mass).norm(), 1e-9 * clamped.modal_mass.norm());
  EXPECT_LT((on_node.modal_stiffness - clamped.modal_stiffness).norm(), 1e-9 * clamped.modal_stiffness.norm());
  EXPECT_LT((on_node.exact.gamma1 - clamped.exact.gamma1).norm(), 1e-9 * clamped.exact.gamma1.norm());
  for (int i = 0; i < 12; ++i)
    EXPECT_LT((on_node.kg_inertial[i] - clamped.kg_inertial[i]).norm(), 1e-8 * clamped.kg_inertial[i].norm()) << i;
  EXPECT_EQ(on_node.locators.size(), clamped.locators.size());
  for (std::size_t e = 0; e < clamped.kg_external.size(); ++e)
    EXPECT_LT((on_node.kg_external[e] - clamped.kg_external[e]).norm(), 1e-8 * clamped.kg_external[8].norm());
  EXPECT_EQ(std::count(clamped.kind.begin(), clamped.kind.end(), ModeKind::Constraint), 6);
}

// Γ4, Γ2 and K_G of the frame's own shapes: the kinetic energy of one motion, seen from two frames.
TEST(Bases, FrameOnANodeThatHangsOnOthers) {
  auto maker = make_frame();
  maker.add_grid(500, {1.3, 0.5, 0});
  test::add_rbe2(maker, 9, 500);
  auto spec = make_spec(BodyFrame::Node);
  spec.frame_nodes = {500};
  spec.interface_nodes = {106};
  const auto there = reduce(maker.deck, spec);
  spec.frame_nodes = {9};
  const auto here = reduce(maker.deck, spec);
  EXPECT_LT((there.modal_mass - here.modal_mass).norm(), 1e-9 * here.modal_mass.norm());
  for (int i = 0; i < 12; ++i)
    EXPECT_LT((there.kg_inertial[i] - here.kg_inertial[i]).norm(), 1e-8 * here.kg_inertial[8].norm()) << i;
}

TEST(Bases, OriginAtANodeAndAtTheMassCentre) {
  const auto maker = make_frame();
  auto spec = make_spec(BodyFrame::Free);
  spec.origin_at_mass_centre = true;
  EXPECT_LT(reduce(maker.deck, spec).cg.norm(), 1e-12);
  spec.origin_at_mass_centre = false;
  spec.origin_node = 9;
  const auto body = reduce(maker.deck, spec);
  EXPECT_LT(body.node_xyz.row(8).norm(), 1e-12);
  EXPECT_LT((body.node_xyz.row(0).transpose() - Vector3d(-1, -0.3, -0.2)).norm(), 1e-12);
}

// Residual vectors of a load set, of a unit load and of the inertial loads, kept and ordered by select.
TEST(Bases, ResidualVectorsAndSelection) {
  const auto maker = make_frame();
  auto spec = make_spec(BodyFrame::Fixed, 3);
  spec.loads.resize(2);
  spec.loads[0] = {"push", 0, {}, 30, {}};
  spec.loads[1] = {"knee", 5, {2}, 0, {}};
  spec.residual = {"push", "knee", "inertial"};
  const auto all = reduce(maker.deck, spec);
  ASSERT_GT(all.num_modes(), 10);
  EXPECT_EQ(std::count(all.kind.begin(), all.kind.end(), ModeKind::Normal), 3);
  // The deflection at the node that the load set pushes, beside one with every mode of the model.
  auto complete = make_spec(BodyFrame::Fixed, 100);
  complete.loads = spec.loads;
  Diagnostics ignored;
  const auto exact = stiffening::reduce(maker.deck, complete, {}, ignored).body;
  const auto deflect = [](const FlexBody& body, int e) {
    const VectorXd load = body.external_load.col(e);
    return load.dot(body.modal_stiffness.ldlt().solve(load));
  };
  for (const int e : {12, 13}) EXPECT_NEAR(deflect(all, e) / deflect(exact, e), 1, 1e-9);
  spec.select = {5, 1, 4};
  const auto some = reduce(maker.deck, spec);
  ASSERT_EQ(some.num_modes(), 3);
  EXPECT_NEAR(some.eigenvalue(0) / all.eigenvalue(4), 1, 1e-9);
  EXPECT_EQ(some.kind, (std::vector<ModeKind>{ModeKind::Residual, ModeKind::Normal, ModeKind::Residual}));
}

TEST(Bases, Damping) {
  auto maker = make_frame();
  maker.deck.mat1.front().ge = 0.04;
  auto spec = make_spec(BodyFrame::Fixed, 4);
  spec.rayleigh_alpha = 2;
  spec.rayleigh_beta = 1e-4;
  spec.has_material_damping = true;
  spec.damping_table.points = {{0, 0.01}, {1000, 0.03}};
  const auto body = reduce(maker.deck, spec);
  for (int j = 0; j < 4; ++j) {
    const double w = std::sqrt(body.eigenvalue(j)), hz = w / (2 * std::numbers::pi);
    const double zeta = 0.01 + 0.02 * hz / 1000;
    // One material: Σ g K_e is g K.
    EXPECT_NEAR(body.modal_damping(j, j) / ((2 * zeta + 0.04) * w + 2 + 1e-4 * w * w), 1, 1e-9);
  }
  // The same motion has the same damping from another frame: it is of the deformation.
  auto free = make_spec(BodyFrame::Free);
  free.damping_ratio = 0.02;
  const MatrixXd D = reduce(maker.deck, free).modal_damping;
  free.frame = BodyFrame::Node;
  free.frame_nodes = {4};
  EXPECT_LT((reduce(maker.deck, free).modal_damping - D).norm(), 1e-9 * D.norm());
}

std::vector<std::string> get_errors(const records::Deck& deck, const BodySpec& spec) {
  try {
    reduce(deck, spec);
  } catch (const Failure& error) {
    std::vector<std::string> ids;
    for (const auto& item : error.items())
      if (item.severity == Severity::Error) ids.push_back(item.id);
    return ids;
  }
  return {};
}

TEST(Bases, ErrorsOfTheSpec) {
  const auto maker = make_frame();
  auto spec = make_spec(BodyFrame::MeanAxes);
  spec.interface_nodes = {};
  spec.basis = BodyBasis::CraigChang;
  spec.orthogonalize = false;
  spec.residual = {"pusch"};
  spec.damping_table.points = {{2, 0.1}, {1, 0.1}};
  EXPECT_EQ(get_errors(maker.deck, spec), (std::vector<std::string>{"reduce.bad-basis", "reduce.bad-basis",
                                                                    "reduce.unknown-load", "reduce.bad-damping"}));
  spec = make_spec(BodyFrame::Node);
  EXPECT_EQ(get_errors(maker.deck, spec), std::vector<std::string>{"modal.bad-frame"});
  spec.frame_nodes = {77};
  EXPECT_EQ(get_errors(maker.deck, spec), std::vector<std::string>{"reduce.unknown-node"});
  for (const auto frame : {BodyFrame::Fixed, BodyFrame::Free, BodyFrame::MeanAxes, BodyFrame::ThreeNodes}) {
    spec = make_spec(frame);
    spec.frame_nodes = {4};
    EXPECT_EQ(get_errors(maker.deck, spec), std::vector<std::string>{"modal.bad-frame"});
  }
  spec = make_spec(BodyFrame::Fixed);
  spec.damping_table.points = {{1, 0.1}, {2, 0.05}};  // below zero further on
  EXPECT_EQ(get_errors(maker.deck, spec), std::vector<std::string>{"reduce.bad-damping"});
}

TEST(Bases, Warnings) {
  auto maker = make_frame();
  auto spec = make_spec(BodyFrame::Fixed, 2);
  spec.loads = {{"tip", 106, {2}, 0, 0, {}}, {"again", 106, {2}, 0, 0, {}}};
  spec.residual = {"tip", "again"};
  Diagnostics diagnostics;
  stiffening::reduce(maker.deck, spec, {}, diagnostics);
  EXPECT_TRUE(diagnostics.has("reduce.residual-unused"));
}

// A straight line of bars has no inertia about itself: its twist under a moment at the end is no mode.
TEST(Bases, FlexibilityWithoutMassIsTold) {
  test::DeckMaker line;
  line.add_section(1, test::kFrameSection, false);
  line.add_line(1, 1, {0, 0, 0}, {1, 0, 0}, 8, Vector3d::UnitY());
  line.fix(1, 123456);
  for (const bool is_bent : {false, true}) {
    for (const auto basis : {BodyBasis::Normal, BodyBasis::CraigChang}) {
      const auto maker = is_bent ? make_frame() : line;
      auto spec = make_spec(BodyFrame::Fixed, 4);
      spec.interface_nodes = {9};
      spec.basis = basis;
      if (basis == BodyBasis::Normal) spec.residual = {"interface"};
      Diagnostics diagnostics;
      stiffening::reduce(maker.deck, spec, {}, diagnostics);
      const auto* id = basis == BodyBasis::Normal ? "reduce.residual-massless" : "modal.massless-interface";
      EXPECT_EQ(diagnostics.has(id), !is_bent);
      EXPECT_FALSE(diagnostics.has("reduce.residual-unused"));
      for (const auto& d : diagnostics.items()) {
        if (d.id == id) EXPECT_NE(d.what.find("100 %"), std::string::npos) << d.what;
      }
    }
  }
}

}  // namespace
}  // namespace bough
