#include "fe/model/constraints.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "base/rotation.hpp"
#include "fe/linear/factor.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/statics.hpp"
#include "tests/fe/model/spring_model.hpp"

namespace bough::fe {
namespace {

using namespace test;

const std::vector<std::pair<int, int>> kLinks = {{1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 1}};

records::CoordSystem make_cylinder(int id) {
  records::CoordSystem s;
  s.id = id;
  s.kind = records::CoordKind::Cylindrical;
  s.b = {0, 0, 1};
  s.c = {1, 0, 0};
  return s;
}

records::Rbe2 make_rbe2(int id, int gn, unsigned cm, std::vector<int> gm) {
  records::Rbe2 r;
  r.id = id;
  r.gn = gn;
  r.cm = cm;
  r.gm = std::move(gm);
  return r;
}

records::Mpc make_mpc(int sid, std::vector<records::MpcTerm> terms) {
  records::Mpc m;
  m.sid = sid;
  m.terms = std::move(terms);
  return m;
}

/// The null space of all constraint equations, made densely: rows A u_l = 0 in displacement axes.
MatrixXd calc_null_space(const MatrixXd& A) {
  const Eigen::FullPivLU<MatrixXd> lu(A);
  return lu.kernel();
}

/// Two bases span the same space.
void expect_same_span(const MatrixXd& A, const MatrixXd& B) {
  ASSERT_EQ(A.cols(), B.cols());
  const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(A).householderQ() * MatrixXd::Identity(A.rows(), A.cols());
  EXPECT_LT((B - Q * (Q.transpose() * B)).norm(), 1e-12 * B.norm());
}

TEST(Constraints, transform_spans_the_dense_null_space) {
  auto deck = make_deck(make_points());
  deck.coord_systems.push_back(make_cylinder(3));
  for (int g : {1, 3, 4}) deck.grids[g].cd = 3;
  deck.subcases[0].spc = 5;
  deck.subcases[0].mpc = 6;
  deck.spc.push_back(make_spc(5, 1, 0b000111));
  deck.spc.push_back(make_spc(5, 4, 0b000010));
  // 6 follows 5 in part; 5.1 follows 4.2 (fixed) and 2.6; a chain over two cards.
  deck.rbe2.push_back(make_rbe2(1, 5, 0b011101, {6}));
  deck.mpc.push_back(make_mpc(6, {{5, 1, 2.0}, {4, 2, -1.0}, {2, 6, 0.5}}));
  deck.mpc.push_back(make_mpc(9, {{3, 3, 1.0}, {2, 3, 1.0}}));  // another set
  ModelOptions options;
  options.autospc = false;
  Diagnostics d;
  const Model model = build_model(deck, options, make_links(kLinks), d);
  const int n = model.num_gdofs();

  // Oracle: every equation as a dense row on basic components.
  std::vector<VectorXd> rows;
  const auto local = [&](int node, int component) {
    VectorXd row = VectorXd::Zero(n);
    const Node& k = model.nodes()[node];
    row.segment<3>(k.first_gdof + 3 * ((component - 1) / 3)) = k.R_basic_cd.col((component - 1) % 3);
    return row;
  };
  for (int c : {1, 2, 3}) rows.push_back(local(0, c));
  rows.push_back(local(3, 2));
  rows.push_back(2 * local(4, 1) - local(3, 2) + 0.5 * local(1, 6));
  const Node &n5 = model.nodes()[4], &n6 = model.nodes()[5];
  for (int c : {1, 3, 4, 5}) {
    const Vector3d axis = n6.R_basic_cd.col((c - 1) % 3);
    VectorXd row = local(5, c);
    if (c <= 3) {
      row.segment<3>(n5.first_gdof) -= axis;
      row.segment<3>(n5.first_gdof + 3) -= (n6.x - n5.x).cross(axis);  // a·(θ×r) = θ·(r×a)
    } else {
      row.segment<3>(n5.first_gdof + 3) -= axis;
    }
    rows.push_back(row);
  }
  MatrixXd A(static_cast<int>(rows.size()), n);
  for (size_t i = 0; i < rows.size(); ++i) A.row(static_cast<int>(i)) = rows[i].transpose();
  EXPECT_EQ(model.num_fdofs(), n - static_cast<int>(rows.size()));
  expect_same_span(calc_null_space(A), MatrixXd(model.T()));

  EXPECT_EQ(model.find_fdof(5, 1), -1);
  const int f = model.find_fdof(5, 2);
  ASSERT_GE(f, 0);
  EXPECT_EQ(model.describe_fdof(f), std::make_pair(6, 2));
  // q_f is the displacement along its own CD component.
  EXPECT_NEAR(MatrixXd(model.T()).col(f).dot(local(5, 2)), 1, 1e-14);
}

TEST(Constraints, rigid_elements_carry_rigid_motion_exactly) {
  auto deck = make_deck(make_points());
  deck.coord_systems.push_back(make_cylinder(3));
  for (auto& grid : deck.grids) grid.cd = 3;
  deck.grids[0].cd = 0;
  deck.rbe2.push_back(make_rbe2(1, 2, 63, {1, 3}));
  records::Rbar rbar;
  rbar.id = 2;
  rbar.ga = 3;
  rbar.gb = 4;
  rbar.cna = 63;
  deck.rbar.push_back(rbar);
  rbar.id = 3;
  rbar.ga = 5;
  rbar.gb = 6;
  rbar.cna = 0b101111;  // 5 components here, 1 there
  rbar.cnb = 0b000100;
  rbar.cma = 0b010000;
  rbar.cmb = 0b111011;
  deck.rbar.push_back(rbar);
  ModelOptions options;
  options.autospc = false;
  Diagnostics d;
  const Model model = build_model(deck, options, make_links(kLinks), d);
  EXPECT_EQ(model.num_fdofs(), 12);
  // A rigid motion of the whole is in the range of T, and T's columns make 1-2-3-4 and 5-6 rigid.
  const MatrixXd T = model.T(), Phi_R = model.calc_rigid_modes();
  const MatrixXd q = T.householderQr().solve(Phi_R);
  EXPECT_LT((T * q - Phi_R).norm(), 1e-12);
  for (const auto& [first, last] : {std::pair{0, 4}, std::pair{4, 6}}) {
    const MatrixXd part = Phi_R.middleRows(6 * first, 6 * (last - first)),
                   moved = T.middleRows(6 * first, 6 * (last - first));
    EXPECT_LT((part * part.colPivHouseholderQr().solve(moved) - moved).norm(), 1e-12);
  }
}

TEST(Constraints, rbe2_is_the_limit_of_a_stiff_link) {
  auto deck = make_deck({{0, 0, 0}, {1, 0.3, 0}, {1.5, 1, 0.4}});
  deck.subcases[0].spc = 1;
  deck.spc.push_back(make_spc(1, 1, 63));
  const auto factory = [](double stiff) {
    return [stiff](const records::Deck&, const NodeTable& nodes, Diagnostics&) {
      ElementList list;
      list.elements.push_back(std::make_unique<LinkElement>(1, 0, 1, nodes, make_spd(1), 1));
      if (stiff > 0) list.elements.push_back(std::make_unique<LinkElement>(2, 1, 2, nodes, stiff * make_spd(2), 1));
      return list;
    };
  };
  Diagnostics d;
  VectorXd F = VectorXd::Zero(18);
  F.tail<6>() << 1, -2, 3, 0.5, -1, 2;
  const auto solve = [&](double stiff) {
    const Model model = build_model(deck, {}, factory(stiff), d);
    return VectorXd(StaticSolver(model, assemble_stiffness(model, DofSet::Free)).solve(F));
  };
  const VectorXd soft = solve(1e4), hard = solve(1e6);
  deck.rbe2.push_back(make_rbe2(1, 2, 63, {3}));
  const VectorXd rigid = solve(0);
  // First order in 1/stiff.
  EXPECT_LT((hard - rigid).norm(), 1e-5 * rigid.norm());
  EXPECT_NEAR((soft - rigid).norm() / (hard - rigid).norm(), 100, 1);
}

TEST(Constraints, mpc_chain_is_substituted_in_any_order) {
  auto deck = make_deck(make_points());
  deck.subcases[0].mpc = 100;
  deck.mpcadd.push_back({100, {1, 2}, {}});
  // u2x = 2 u3x, u3x = 3 u4x + u5y, u4x = -u6z; given back to front.
  deck.mpc.push_back(make_mpc(1, {{2, 1, 1.0}, {3, 1, -2.0}}));
  deck.mpc.push_back(make_mpc(2, {{3, 1, 1.0}, {4, 1, -3.0}, {5, 2, -1.0}}));
  deck.mpc.push_back(make_mpc(2, {{4, 1, 5.0}, {6, 3, 5.0}}));
  ModelOptions options;
  options.autospc = false;
  Diagnostics d;
  const Model model = build_model(deck, options, make_links(kLinks), d);
  const MatrixXd T = model.T();
  VectorXd q = make_random(model.num_fdofs(), 1, 4);
  const VectorXd u = T * q;
  EXPECT_NEAR(u[18], -u[32], 1e-15);
  EXPECT_NEAR(u[12], 3 * u[18] + u[25], 1e-14);
  EXPECT_NEAR(u[6], 2 * u[12], 1e-14);
  EXPECT_EQ(model.num_fdofs(), 33);
}

TEST(Constraints, cylindrical_spc_leaves_the_radial_motion) {
  auto deck = make_deck({{1, 1, 0}, {2, 0, 0}});
  deck.coord_systems.push_back(make_cylinder(3));
  deck.grids[0].cd = 3;
  deck.subcases[0].spc = 1;
  deck.spc.push_back(make_spc(1, 1, 0b111110));
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links({{1, 2}}), d);
  ASSERT_EQ(model.num_fdofs(), 7);
  const VectorXd column = MatrixXd(model.T()).col(model.find_fdof(0, 1));
  EXPECT_TRUE(column.head<3>().isApprox(Vector3d(1, 1, 0) / std::sqrt(2.0), 1e-15));
  EXPECT_EQ(column.tail(9).norm(), 0);
}

TEST(Constraints, permanent_and_set_spc_and_free_free) {
  auto deck = make_deck(make_points());
  deck.grids[0].ps = 0b000111;
  deck.grids[1].ps = 0b111000;
  deck.subcases[0].spc = 8;
  deck.spcadd.push_back({8, {1, 2}, {}});
  deck.spc.push_back(make_spc(1, 3, 1));
  deck.spc.push_back(make_spc(2, 4, 2));
  deck.spc.push_back(make_spc(3, 5, 4));
  Diagnostics d;
  EXPECT_EQ(build_model(deck, {}, make_links(kLinks), d).num_fdofs(), 36 - 8);
  ModelOptions free;
  free.ignore_spc = true;  // keeps the PS of rotations alone
  EXPECT_EQ(build_model(deck, free, make_links(kLinks), d).num_fdofs(), 36 - 3);
}

TEST(Constraints, only_set_of_a_fragment_is_used_with_a_note) {
  auto deck = make_deck(make_points());
  deck.spc.push_back(make_spc(4, 1, 63));
  Diagnostics d;
  EXPECT_EQ(build_model(deck, {}, make_links(kLinks), d).num_fdofs(), 36);
  deck.sol.clear();
  EXPECT_EQ(build_model(deck, {}, make_links(kLinks), d).num_fdofs(), 30);
  EXPECT_TRUE(d.has("fe.only-spc-set"));
}

TEST(Constraints, subcase_selects_the_sets) {
  auto deck = make_deck(make_points());
  deck.subcases.resize(3);
  deck.subcases[1].id = 1;
  deck.subcases[1].spc = 1;
  deck.subcases[2].id = 7;
  deck.subcases[2].spc = 2;
  deck.spc.push_back(make_spc(1, 1, 63));
  deck.spc.push_back(make_spc(2, 1, 1));
  Diagnostics d;
  EXPECT_EQ(build_model(deck, {}, make_links(kLinks), d).num_fdofs(), 30);
  ModelOptions options;
  options.subcase = 7;
  EXPECT_EQ(build_model(deck, options, make_links(kLinks), d).num_fdofs(), 35);
  options.subcase = 3;
  EXPECT_THROW(build_model(deck, options, make_links(kLinks), d), InputError);
  EXPECT_TRUE(d.has("fe.unknown-subcase"));
}

struct BadCase {
  const char* id;
  void (*spoil)(records::Deck&);
};

void PrintTo(const BadCase& bad, std::ostream* out) { *out << bad.id; }

class BadConstraints : public ::testing::TestWithParam<BadCase> {};

TEST_P(BadConstraints, is_reported) {
  auto deck = make_deck(make_points());
  deck.subcases[0].spc = 1;
  deck.subcases[0].mpc = 2;
  deck.spc.push_back(make_spc(1, 1, 63));
  deck.mpc.push_back(make_mpc(2, {{2, 1, 1.0}, {3, 1, 1.0}}));
  GetParam().spoil(deck);
  Diagnostics d;
  EXPECT_THROW(build_model(deck, {}, make_links(kLinks), d), InputError);
  EXPECT_TRUE(d.has(GetParam().id));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadConstraints,
    ::testing::Values(
        BadCase{"fe.dependent-twice", [](records::Deck& k) { k.rbe2.push_back(make_rbe2(9, 4, 63, {2})); }},
        BadCase{"fe.dependent-fixed", [](records::Deck& k) { k.rbe2.push_back(make_rbe2(9, 4, 63, {1})); }},
        BadCase{"fe.cyclic-constraints",
                [](records::Deck& k) {
                  k.mpc.push_back(make_mpc(2, {{3, 1, 1.0}, {2, 1, 1.0}}));
                }},
        BadCase{"fe.missing-grid", [](records::Deck& k) { k.spc.push_back(make_spc(1, 77, 1)); }},
        BadCase{"fe.missing-grid", [](records::Deck& k) { k.rbe2.push_back(make_rbe2(9, 4, 63, {78})); }},
        BadCase{"fe.bad-component", [](records::Deck& k) { k.mpc[0].terms[1].c = 9; }},
        BadCase{"fe.zero-mpc", [](records::Deck& k) { k.mpc[0].terms[0].a = 0; }},
        BadCase{"fe.rigid-independent", [](records::Deck& k) { k.rbe2.push_back(make_rbe2(9, 4, 63, {4})); }},
        BadCase{"fe.rigid-independent",
                [](records::Deck& k) {
                  records::Rbar r;
                  r.ga = 4;
                  r.gb = 5;
                  r.cna = 0b111;
                  r.cnb = 0b111;  // the rotation about the line through both is not held
                  k.rbar.push_back(r);
                }},
        BadCase{"fe.bad-param",
                [](records::Deck& k) {
                  k.params.push_back({"WTMASS", "ABC", {}});
                }},
        BadCase{"fe.no-grids", [](records::Deck& k) { k.grids.clear(); }}),
    [](const auto& bad) {
      std::string name = std::string(bad.param.id) + "_" + std::to_string(bad.index);
      std::replace_if(
          name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
      return name;
    });

/// Other codes run such decks.
TEST(Constraints, SetsWithoutCardsAreAWarning) {
  auto deck = make_deck(make_points());
  deck.subcases[0].spc = 9;
  deck.spcadd.push_back({9, {1, 44}, {}});
  deck.spc.push_back(make_spc(1, 1, 63));
  Diagnostics d, none;
  EXPECT_EQ(build_model(deck, {}, make_links(kLinks), d).num_fdofs(), 30);
  EXPECT_TRUE(d.has("fe.missing-set"));
  EXPECT_EQ(d.num_errors(), 0);
  deck.subcases[0].spc = 44;
  EXPECT_EQ(build_model(deck, {}, make_links(kLinks), none).num_fdofs(), 36);
  EXPECT_TRUE(none.has("fe.missing-set"));
}

TEST(Constraints, enforced_displacement_is_zero_with_a_warning_and_thru_ids_may_be_missing) {
  auto deck = make_deck(make_points());
  deck.subcases[0].spc = 1;
  deck.spc.push_back(make_spc(1, 1, 63));
  deck.spc[0].d = 0.1;
  deck.spc.push_back(make_spc(1, 77, 63));
  deck.spc[1].skip_if_missing = true;
  Diagnostics d;
  EXPECT_EQ(build_model(deck, {}, make_links(kLinks), d).num_fdofs(), 30);
  EXPECT_TRUE(d.has("fe.enforced-ignored"));
}

}  // namespace
}  // namespace bough::fe
