#include "fe/model/autospc.hpp"

#include <gtest/gtest.h>

#include "fe/statics/build_model.hpp"
#include "tests/fe/model/spring_model.hpp"

namespace bough::fe {
namespace {

using namespace test;

/// A rod: stiffness along its line only.
Eigen::Matrix<double, 6, 6> make_rod(const Vector3d& direction) {
  Eigen::Matrix<double, 6, 6> S = Eigen::Matrix<double, 6, 6>::Zero();
  S.topLeftCorner<3, 3>() = 5e4 * direction.normalized() * direction.normalized().transpose();
  return S;
}

ElementFactory make_rods(std::vector<std::pair<int, int>> pairs) {
  return [pairs](const records::Deck&, const NodeTable& nodes, Diagnostics&) {
    ElementList list;
    for (const auto& [a, b] : pairs) {
      const int i = nodes.find_node(a), j = nodes.find_node(b);
      list.elements.push_back(
          std::make_unique<LinkElement>(1, i, j, nodes, make_rod(nodes.node(j).x - nodes.node(i).x), 1.0));
    }
    return list;
  };
}

int count_zero(const MatrixXd& K) {
  const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(K).eigenvalues();
  return static_cast<int>((values.array().abs() < 1e-11 * values.cwiseAbs().maxCoeff()).count());
}

MatrixXd reduce(const Model& model) {
  const MatrixXd T = model.T();
  return T.transpose() * sum_stiffness(model) * T;
}

TEST(Autospc, tetrahedron_of_rods_keeps_its_six_rigid_modes) {
  const auto deck = make_deck({{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.3, 0.4, 1}});
  Diagnostics d;
  const Model model = build_model(deck, {}, make_rods({{1, 2}, {1, 3}, {1, 4}, {2, 3}, {2, 4}, {3, 4}}), d);
  EXPECT_EQ(model.autospc().size(), 12u);
  for (const auto& entry : model.autospc()) EXPECT_GT(entry.component, 3);
  EXPECT_EQ(model.num_fdofs(), 12);
  EXPECT_EQ(count_zero(reduce(model)), 6);
  EXPECT_TRUE(d.has("fe.autospc"));
}

TEST(Autospc, free_model_with_full_stiffness_loses_nothing) {
  const auto deck = make_deck(make_points());
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links({{1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}}), d);
  EXPECT_TRUE(model.autospc().empty());
  EXPECT_EQ(count_zero(reduce(model)), 6);
}

TEST(Autospc, unattached_grid_and_planar_truss_node) {
  // Node 3 hangs on two rods in the plane z = 0, node 4 on nothing.
  auto deck = make_deck({{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {5, 5, 5}});
  deck.grids[0].ps = deck.grids[1].ps = 63;
  Diagnostics d;
  const Model model = build_model(deck, {}, make_rods({{1, 3}, {2, 3}}), d);
  ASSERT_EQ(model.autospc().size(), 10u);
  EXPECT_EQ(model.autospc()[0].node, 3);
  EXPECT_EQ(model.autospc()[0].component, 3);
  EXPECT_EQ(model.autospc()[4].node, 4);
  EXPECT_EQ(model.num_fdofs(), 2);
  EXPECT_EQ(count_zero(reduce(model)), 0);
}

TEST(Autospc, skew_rod_leaves_one_component_per_end) {
  auto deck = make_deck({{0, 0, 0}, {1, 2, 0.5}});
  deck.grids[0].ps = 63;
  Diagnostics d;
  const Model model = build_model(deck, {}, make_rods({{1, 2}}), d);
  EXPECT_EQ(model.num_fdofs(), 1);
  EXPECT_EQ(model.find_fdof(1, 2), 0);  // nearest to the rod
  EXPECT_EQ(count_zero(reduce(model)), 0);
}

TEST(Autospc, switches_and_threshold) {
  auto deck = make_deck({{0, 0, 0}, {1, 2, 0.5}});
  deck.grids[0].ps = 63;
  deck.params.push_back({"AUTOSPC", "NO", {}});
  Diagnostics d;
  ModelOptions options;
  options.autospc = false;
  EXPECT_EQ(build_model(deck, options, make_rods({{1, 2}}), d).num_fdofs(), 6);
  // By PARAM alone the rotations, which have neither stiffness nor mass, are held all the same.
  EXPECT_EQ(build_model(deck, {}, make_rods({{1, 2}}), d).num_fdofs(), 3);
  EXPECT_TRUE(d.has("fe.null-dofs"));
  options.autospc = true;
  EXPECT_EQ(build_model(deck, options, make_rods({{1, 2}}), d).num_fdofs(), 1);
  // A transverse stiffness of 1e-5 survives the default and falls to a larger EPZERO.
  const ElementFactory weak = [](const records::Deck&, const NodeTable& nodes, Diagnostics&) {
    ElementList list;
    Eigen::Matrix<double, 6, 6> S = Eigen::Matrix<double, 6, 6>::Zero();
    S.diagonal() << 1, 1e-5, 1e-5, 1, 1, 1;
    list.elements.push_back(std::make_unique<LinkElement>(1, 0, 1, nodes, S, 1.0));
    return list;
  };
  deck.params.clear();
  EXPECT_EQ(build_model(deck, {}, weak, d).num_fdofs(), 6);
  deck.params.push_back({"EPZERO", "1.-4", {}});
  const Model model = build_model(deck, {}, weak, d);
  EXPECT_EQ(model.num_fdofs(), 4);
  ASSERT_FALSE(model.autospc().empty());
  EXPECT_NEAR(model.autospc()[0].ratio, 1e-5, 1e-9);
}

TEST(Autospc, stiffness_through_a_dependent_grid_counts) {
  // Grid 3 has no element; it carries grid 2 rigidly.
  auto deck = make_deck({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}});
  deck.grids[0].ps = 63;
  records::Rbe2 rbe2;
  rbe2.gn = 3;
  rbe2.cm = 63;
  rbe2.gm = {2};
  deck.rbe2.push_back(rbe2);
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links({{1, 2}}), d);
  EXPECT_TRUE(model.autospc().empty());
  EXPECT_EQ(model.num_fdofs(), 6);
}

TEST(Autospc, soft_beside_very_stiff_is_not_none) {
  const auto deck = make_deck({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const ElementFactory links = [](const records::Deck&, const NodeTable& nodes, Diagnostics&) {
    ElementList list;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Matrix<double, 6, 6> S = Eigen::Matrix<double, 6, 6>::Identity() * (k == 0 ? 1e20 : 1e3);
      list.elements.push_back(std::make_unique<LinkElement>(k + 1, k, k + 1, nodes, S, 1.0));
    }
    return list;
  };
  Diagnostics d;
  EXPECT_TRUE(build_model(deck, {}, links, d).autospc().empty());
}

// Both ends of the rod follow one grid: what is left of its stiffness there is round-off, whatever its size.
TEST(Autospc, stiffness_that_rigid_elements_cancel_is_none) {
  for (const double far : {0.3, 30.0, 3000.0}) {
    auto deck = make_deck({{-1.027, -.12688, -.15252}, {-.89331, -.085771, -.41502}, {far, -.11119, .2}});
    records::Rbe2 rbe2;
    rbe2.gn = 3;
    rbe2.cm = 63;
    rbe2.gm = {1, 2};
    deck.rbe2.push_back(rbe2);
    Diagnostics d;
    const Model model = build_model(deck, {}, make_links({{1, 2}}), d);
    EXPECT_EQ(model.autospc().size(), 6u) << far;
    EXPECT_EQ(model.num_fdofs(), 0) << far;
  }
}

}  // namespace
}  // namespace bough::fe
