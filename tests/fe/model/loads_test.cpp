#include <gtest/gtest.h>

#include "base/rotation.hpp"
#include "fe/loads/loads.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/statics/build_model.hpp"
#include "tests/fe/model/spring_model.hpp"

namespace bough::fe {
namespace {

using namespace test;

records::PointLoad make_load(int sid, int grid, int cid, double f, Vector3d n, bool is_moment) {
  return {sid, grid, cid, f, n, is_moment, {}};
}

records::Deck make_loaded() {
  auto deck = make_deck({{0, 2, 0}, {3, 0, 0}, {1, 1, 1}});
  deck.coord_systems.push_back(make_cylinder(5));
  records::Gravity gravity;
  gravity.sid = 3;
  gravity.a = 9.81;
  gravity.n = {0, 0, -1};
  deck.gravity.push_back(gravity);
  deck.point_loads.push_back(make_load(1, 1, 5, 10, {0, 2, 0}, false));  // tangential at (0,2): -x
  deck.point_loads.push_back(make_load(1, 2, 0, 4, {0, 0, 1}, true));
  deck.point_loads.push_back(make_load(2, 2, 0, 1, {1, 2, 3}, false));
  records::LoadCombination combination;
  combination.sid = 9;
  combination.s = 2;
  combination.terms = {{3.0, 1}, {-1.0, 2}, {0.5, 3}};
  deck.loads.push_back(combination);
  return deck;
}

TEST(LoadsMpi, forces_moments_gravity_and_their_combination) {
  auto deck = make_loaded();
  deck.params.push_back({"WTMASS", "0.1", {}});
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links({{1, 2}, {2, 3}}), d);
  VectorXd F1 = VectorXd::Zero(18), F2 = F1, F3 = F1;
  F1[0] = -20;
  F1[6 + 5] = 4;
  F2.segment<3>(6) << 1, 2, 3;
  // Link masses 2 and 3, half at each end; times WTMASS.
  F3[2] = -0.1 * 9.81 * 1;
  F3[8] = -0.1 * 9.81 * 2.5;
  F3[14] = -0.1 * 9.81 * 1.5;
  EXPECT_LT((calc_load(model, deck, 1, d) - F1).norm(), 1e-14);
  EXPECT_LT((calc_load(model, deck, 2, d) - F2).norm(), 1e-14);
  EXPECT_LT((calc_load(model, deck, 3, d) - F3).norm(), 1e-14);
  EXPECT_LT((calc_load(model, deck, 9, d) - (6 * F1 - 2 * F2 + F3)).norm(), 1e-13);
  EXPECT_EQ(d.num_errors(), 0);
}

TEST(LoadsMpi, missing_set_and_grid_are_reported) {
  auto deck = make_loaded();
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links({{1, 2}, {2, 3}}), d);
  calc_load(model, deck, 44, d);
  EXPECT_TRUE(d.has("fe.missing-load"));
  deck.loads[0].terms.emplace_back(1.0, 45);
  calc_load(model, deck, 9, d);
  EXPECT_EQ(d.num_errors(), 1);
  EXPECT_EQ(d.num_warnings(), 1);
  deck.point_loads.push_back(make_load(1, 88, 0, 1, {1, 0, 0}, false));
  calc_load(model, deck, 1, d);
  EXPECT_TRUE(d.has("fe.missing-grid"));
}

TEST(MassPropertiesMpi, two_links_by_hand) {
  const std::vector<Vector3d> x = {{0, 2, 0}, {3, 0, 0}, {1, 1, 1}};
  const auto deck = make_deck(x);
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links({{1, 2}, {2, 3}}), d);
  const double m[3] = {1, 2.5, 1.5};
  const Vector3d reference(0.5, -1, 2);
  Vector3d cg = Vector3d::Zero();
  Matrix3d inertia = Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    cg += m[k] * x[k] / 5;
    inertia -= m[k] * skew(x[k] - reference) * skew(x[k] - reference);
  }
  const auto properties = calc_mass_properties(model, MassKind::Lumped, reference);
  EXPECT_NEAR(properties.mass, 5, 1e-14);
  EXPECT_TRUE(properties.cg.isApprox(cg, 1e-14));
  EXPECT_TRUE(properties.inertia.isApprox(inertia, 1e-13));
  EXPECT_EQ(properties.reference, reference);
  // The consistent mass keeps mass and centre.
  const auto consistent = calc_mass_properties(model, MassKind::Consistent, Vector3d::Zero());
  EXPECT_NEAR(consistent.mass, 5, 1e-14);
  EXPECT_TRUE(consistent.cg.isApprox(cg, 1e-14));
}

TEST(MassPropertiesMpi, ground_check_sees_a_spring_to_ground) {
  const auto deck = make_deck(make_points());
  const std::vector<std::pair<int, int>> links = {{1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}};
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links(links), d);
  EXPECT_LT(calc_ground_check(model).maxCoeff(), 1e-14);

  class Ground final : public Element {
   public:
    Ground() : Element(1, "GROUND", {2}, {12 + 1}) {}
    void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override { K(0, 0) += scale * 500; }
  };
  const Model grounded = build_model(
      deck, {},
      [&](const records::Deck& k, const NodeTable& n, Diagnostics& e) {
        ElementList list = make_links(links)(k, n, e);
        list.elements.push_back(std::make_unique<Ground>());
        return list;
      },
      d);
  const auto check = calc_ground_check(grounded);
  EXPECT_GT(check[1], 1e-3);
  EXPECT_LT(check[0], 1e-14);
}

TEST(ModelMap, names_dofs_and_draws_links) {
  auto deck = make_deck({{0, 0, 0}, {1, 0, 0}, {2, 1, 0}});
  deck.grids[0].id = 30;  // sorted by id: 2, 3, 30
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links({{30, 2}, {2, 3}}), d);
  const Eigen::MatrixXi map = model.calc_dof_map();
  EXPECT_EQ(map(0, 0), 2);
  EXPECT_EQ(map(17, 0), 30);
  EXPECT_EQ(map(17, 1), 6);
  const auto mesh = model.calc_mesh();
  EXPECT_EQ(mesh.grid_id, (std::vector<int>{2, 3, 30}));
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].connectivity.row(0), Eigen::RowVector2i(2, 0));
  EXPECT_TRUE(mesh.grid_xyz.row(1).isApprox(Eigen::RowVector3d(2, 1, 0)));
}

TEST(ModelMap, options_choose_mass_kind_and_origin) {
  auto deck = make_deck({{0, 0, 0}, {1, 0, 0}});
  Diagnostics d;
  EXPECT_EQ(build_model(deck, {}, make_links({{1, 2}}), d).mass_kind(), MassKind::Lumped);
  deck.params.push_back({"COUPMASS", "1", {}});
  deck.params.push_back({"WTMASS", "2.59-3", {}});
  ModelOptions options;
  options.origin = Vector3d(0.25, 1, 0);
  const Model model = build_model(deck, options, make_links({{1, 2}}), d);
  EXPECT_EQ(model.mass_kind(), MassKind::Consistent);
  EXPECT_DOUBLE_EQ(model.wtmass(), 2.59e-3);
  EXPECT_TRUE(model.node(1).x.isApprox(Vector3d(0.75, -1, 0)));
  options.mass_kind = MassKind::Lumped;
  EXPECT_EQ(build_model(deck, options, make_links({{1, 2}}), d).mass_kind(), MassKind::Lumped);
  deck.params.push_back({"COUPMASS", "NO", {}});
  EXPECT_EQ(build_model(deck, {}, make_links({{1, 2}}), d).mass_kind(), MassKind::Lumped);
  deck.params.push_back({"COUPMASS", "YES", {}});
  EXPECT_EQ(build_model(deck, {}, make_links({{1, 2}}), d).mass_kind(), MassKind::Consistent);
}

}  // namespace
}  // namespace bough::fe
