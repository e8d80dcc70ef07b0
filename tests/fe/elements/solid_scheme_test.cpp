/// PSOLID's IN and ISOP, and solids that count their grids left-handed.
#include <algorithm>
#include <numeric>

#include "fe/elements/solid.hpp"
#include "small_model.hpp"

namespace bough::fe::test {
namespace {

constexpr double kE = 3, kNu = 0.3, kG = kE / (2 * (1 + kNu));

void add_material(SmallModel& m) {
  records::Mat1 material;
  material.id = 1, material.E = kE, material.nu = kNu, material.G = kG, material.rho = 0.8;
  m.deck.mat1.push_back(material);
  records::Psolid p;
  p.id = p.mid = 1;
  m.deck.psolid.push_back(p);
}

SmallModel make_solid(const std::string& card, const std::vector<Vector3d>& x, const std::vector<int>& midsides = {}) {
  SmallModel m;
  add_material(m);
  records::SolidElement e;
  e.id = e.pid = 1, e.card = card;
  const int corners = card == "CHEXA" || card == "CIHEX3" ? 8 : card == "CPENTA" ? 6 : 4;
  for (std::size_t i = 0; i < x.size(); ++i) m.nodes.add_grid(static_cast<int>(i) + 1, x[i]);
  for (int i = 1; i <= corners; ++i) e.corners.push_back(i);
  e.midsides = midsides;
  m.deck.solids.push_back(e);
  return m;
}

const std::vector<Vector3d> kBrick = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                      {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
const std::vector<Vector3d> kWedge = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};

/// Twice the energy of nodal displacements u_x = f(x).
double calc_energy(SmallModel& m, int points, bool full, double (*f)(const Vector3d&)) {
  m.deck.psolid[0].points = points;
  m.deck.psolid[0].is_full = full;
  m.elements.clear();
  m.make();
  VectorXd u = VectorXd::Zero(m.nodes.num_gdofs());
  for (int k = 0; k < m.nodes.num_nodes(); ++k) u[6 * k] = f(m.nodes.node(k).x);
  return u.dot(m.calc_stiffness() * u);
}

/// The plain element follows its trilinear field, with ε_x = y and γ = x: ∫(λ + 2μ) y² + G x².
TEST(SolidScheme, FullIsThePlainIsoparametricElement) {
  const double C11 = 2 * kG * (1 - kNu) / (1 - 2 * kNu);
  SmallModel brick = make_solid("CHEXA", kBrick);
  const auto bend = [](const Vector3d& x) { return x.x() * x.y(); };
  for (const int points : {2, 3}) EXPECT_NEAR(calc_energy(brick, points, true, bend), 8.0 / 3 * (C11 + kG), 1e-13);
  // The default bends: E/(1 - ν²) or less, and no parasitic shear.
  EXPECT_LT(calc_energy(brick, 0, false, bend), 8.0 / 3 * kE / (1 - kNu * kNu) * (1 + 1e-12));
  SmallModel wedge = make_solid("CPENTA", kWedge);
  const auto lean = [](const Vector3d& x) { return x.x() * x.z(); };
  for (const int points : {2, 3}) EXPECT_NEAR(calc_energy(wedge, points, true, lean), C11 / 3 + kG / 6, 1e-13);
  EXPECT_LT(calc_energy(wedge, 0, false, lean), 0.9 * (C11 / 3 + kG / 6));
}

TEST(SolidScheme, OtherCombinationsAreTheDefaultAndSaySo) {
  SmallModel brick = make_solid("CHEXA", kBrick);
  const auto bend = [](const Vector3d& x) { return x.x() * x.y(); };
  const double by_default = calc_energy(brick, 0, false, bend);
  for (const auto& [points, full] : {std::pair{2, false}, {3, false}, {0, true}}) {
    EXPECT_NEAR(calc_energy(brick, points, full, bend), by_default, 1e-13);
    Diagnostics d;
    make_elements(brick.deck, brick.nodes, d);
    EXPECT_TRUE(d.has("fe.solid-scheme"));
  }
  SmallModel tetra = make_solid("CTETRA", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  tetra.deck.psolid[0].points = 3;
  Diagnostics d;
  make_elements(tetra.deck, tetra.nodes, d);
  EXPECT_TRUE(d.items().empty());
}

/// With midside nodes IN sets the points: stresses at 2³, 3³ of them.
TEST(SolidScheme, PointsOfQuadraticBricks) {
  auto x = kBrick;
  std::vector<int> midsides;
  for (const auto& [i, j] : get_edges(SolidKind::Hexa)) {
    x.push_back((kBrick[static_cast<std::size_t>(i)] + kBrick[static_cast<std::size_t>(j)]) / 2);
    midsides.push_back(static_cast<int>(x.size()));
  }
  SmallModel m = make_solid("CHEXA", x, midsides);
  for (const auto& [points, num] : {std::pair{0, 27}, {2, 8}, {3, 27}}) {
    m.deck.psolid[0].points = points;
    m.elements.clear();
    m.make();
    EXPECT_EQ(m.elements[0]->stress_state()->num_internal_forces(), 6 * num);
  }
}

/// The brick of 32 grids follows cubics, from whichever side its grids are counted.
TEST(SolidScheme, CubicBricksFollowCubics) {
  const double C11 = 2 * kG * (1 - kNu) / (1 - 2 * kNu);
  for (const bool is_left_handed : {false, true}) {
    auto corners = kBrick;
    if (is_left_handed) std::rotate(corners.begin(), corners.begin() + 4, corners.end());
    auto x = corners;
    std::vector<int> thirds;
    for (const auto& [i, j] : get_edges(SolidKind::Hexa)) {
      const Vector3d a = corners[static_cast<std::size_t>(i)], b = corners[static_cast<std::size_t>(j)];
      for (const double s : {1.0 / 3, 2.0 / 3}) {
        x.push_back(a + s * (b - a));
        thirds.push_back(static_cast<int>(x.size()));
      }
    }
    SmallModel m = make_solid("CIHEX3", x, thirds);
    const auto cube = [](const Vector3d& at) { return at.x() * at.x() * at.x(); };
    EXPECT_NEAR(calc_energy(m, 0, false, cube), C11 * 72 / 5, 1e-12);  // ∫ C11 (3x²)²
    const auto mixed = [](const Vector3d& at) { return at.x() * at.x() * at.x() * at.y(); };
    EXPECT_NEAR(calc_energy(m, 0, false, mixed), C11 * 24 / 5 + kG * 8 / 7, 1e-12);  // and ∫ G x⁶
    VectorXd one = VectorXd::Zero(m.nodes.num_gdofs());
    for (int k = 0; k < m.nodes.num_nodes(); ++k) one[6 * k] = 1;
    EXPECT_NEAR(one.dot(m.calc_mass(MassKind::Consistent) * one), 0.8 * 8, 1e-12);
    EXPECT_LT((m.calc_stiffness() * one).norm(), 1e-12);
    // Points a direction; x³y under two: Σ w (3x²y)² = 4 · 2 (x² = y² = 1/3), and G x⁶ = 8/27.
    for (const auto& [points, num] : {std::pair{0, 64}, {2, 8}, {3, 27}, {4, 64}}) {
      m.deck.psolid[0].points = points;
      m.elements.clear();
      m.make();
      EXPECT_EQ(m.elements[0]->stress_state()->num_internal_forces(), 6 * num);
    }
    EXPECT_NEAR(calc_energy(m, 2, false, mixed), C11 * 8 / 3 + kG * 8 / 27, 1e-12);
    EXPECT_NEAR(calc_energy(m, 4, false, mixed), C11 * 24 / 5 + kG * 8 / 7, 1e-12);
    EXPECT_NEAR(one.dot(m.calc_mass(MassKind::Consistent) * one), 0.8 * 8, 1e-12);
  }
}

/// A curved wedge is the same element from whichever corner it is counted, and near the exact integral: its stiffness
/// was 1e-3 off by the collapsed rule.
TEST(SolidScheme, CurvedWedgesDoNotDependOnTheirFirstCorner) {
  const auto& edges = get_edges(SolidKind::Penta);
  auto x = kWedge;
  for (const auto& [i, j] : edges) {
    const Vector3d middle = (kWedge[static_cast<std::size_t>(i)] + kWedge[static_cast<std::size_t>(j)]) / 2;
    x.push_back(middle + 0.12 * Vector3d(middle.y() - 0.3, middle.z() * middle.x(), 0.4 - middle.x() * middle.y()));
  }
  std::vector<int> midsides;
  for (int i = 7; i <= 15; ++i) midsides.push_back(i);
  const auto calc = [&](const std::vector<Vector3d>& points) {
    SmallModel m = make_solid("CPENTA", points, midsides);
    m.make();
    return m.calc_stiffness();
  };
  const MatrixXd K = calc(x);
  const auto turn = [](int i) { return i / 3 * 3 + (i + 1) % 3; };  // corners 1 2 3 become 2 3 1
  std::vector<int> from(15);
  for (int i = 0; i < 6; ++i) from[static_cast<std::size_t>(i)] = turn(i);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const int a = turn(edges[e].first), b = turn(edges[e].second);
    for (std::size_t other = 0; other < edges.size(); ++other)
      if (edges[other] == std::pair(a, b) || edges[other] == std::pair(b, a)) from[6 + e] = 6 + static_cast<int>(other);
  }
  std::vector<Vector3d> turned;
  for (const int i : from) turned.push_back(x[static_cast<std::size_t>(i)]);
  const MatrixXd K_turned = calc(turned);
  double error = 0;
  for (int i = 0; i < 15; ++i)
    for (int j = 0; j < 15; ++j)
      error =
          std::max(error, (K_turned.block<3, 3>(6 * i, 6 * j) -
                           K.block<3, 3>(6 * from[static_cast<std::size_t>(i)], 6 * from[static_cast<std::size_t>(j)]))
                              .norm());
  EXPECT_LT(error, 1e-13 * K.norm());
}

/// A skewed, curved body counted both ways is the same element, whichever midside grids it has.
TEST(SolidScheme, LeftHandedSolidsAreTurnedRound) {
  struct Case {
    std::string card;
    std::vector<Vector3d> x;
    std::vector<int> corners;  ///< left-handed order
    SolidKind kind;
  };
  const Case cases[] = {{"CHEXA", kBrick, {5, 6, 7, 8, 1, 2, 3, 4}, SolidKind::Hexa},
                        {"CHEXA", kBrick, {1, 4, 3, 2, 5, 8, 7, 6}, SolidKind::Hexa},
                        {"CPENTA", kWedge, {4, 5, 6, 1, 2, 3}, SolidKind::Penta},
                        {"CTETRA", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {2, 1, 3, 4}, SolidKind::Tetra}};
  for (const auto& c : cases)
    for (const int with_midsides : {0, 1, 2}) {  // none, all, every other
      SCOPED_TRACE(c.card + " " + std::to_string(with_midsides));
      auto x = c.x;
      for (auto& p : x) p += Vector3d(0.1 * p.y() * p.y(), 0.07 * p.x() * p.z(), 0.05 * p.x());
      // The middle of each edge, by its ends.
      std::map<std::pair<int, int>, int> middle;
      std::vector<int> right;
      int e = 0;
      for (const auto& [i, j] : get_edges(c.kind)) {
        const bool here = with_midsides == 1 || (with_midsides == 2 && e++ % 2 == 0);
        if (here) {
          x.push_back((x[static_cast<std::size_t>(i)] + x[static_cast<std::size_t>(j)]) / 2 +
                      0.03 * Vector3d(1, -1, 0.5));
          middle[{std::min(i, j) + 1, std::max(i, j) + 1}] = static_cast<int>(x.size());
        }
        if (with_midsides > 0) right.push_back(here ? static_cast<int>(x.size()) : 0);
      }
      SmallModel m = make_solid(c.card, x, right);
      m.make();
      const MatrixXd K = m.calc_stiffness(), M = m.calc_mass(MassKind::Consistent);
      m.elements.clear();
      auto& card = m.deck.solids[0];
      card.corners = c.corners;
      card.midsides.clear();
      for (const auto& [i, j] : get_edges(c.kind)) {
        const int a = c.corners[static_cast<std::size_t>(i)], b = c.corners[static_cast<std::size_t>(j)];
        const auto found = middle.find({std::min(a, b), std::max(a, b)});
        if (with_midsides > 0) card.midsides.push_back(found == middle.end() ? 0 : found->second);
      }
      m.make();
      EXPECT_LT((m.calc_stiffness() - K).norm(), 1e-12 * K.norm());
      EXPECT_LT((m.calc_mass(MassKind::Consistent) - M).norm(), 1e-13 * M.norm());
      Diagnostics d;
      make_elements(m.deck, m.nodes, d);
      ASSERT_EQ(d.items().size(), 1u);
      EXPECT_EQ(d.items()[0].id, "fe.left-handed");
    }
}

TEST(SolidScheme, ManyLeftHandedSolidsAreOneNoteAndFoldedOnesErrors) {
  SmallModel m = make_solid("CHEXA", kBrick);
  auto card = m.deck.solids[0];
  card.corners = {5, 6, 7, 8, 1, 2, 3, 4};
  m.deck.solids.assign(3, card);
  Diagnostics d;
  make_elements(m.deck, m.nodes, d);
  ASSERT_EQ(d.items().size(), 1u);
  EXPECT_NE(d.items()[0].what.find("and 2 solids more"), std::string::npos);
  m.deck.solids[1].corners = {1, 2, 3, 4, 5, 6, 8, 7};  // the upper face crosses itself
  Diagnostics folded;
  make_elements(m.deck, m.nodes, folded);
  ASSERT_EQ(folded.num_errors(), 1);
  EXPECT_TRUE(folded.has("fe.bad-solid"));
  EXPECT_NE(folded.items()[0].what.find("fold"), std::string::npos);
}

}  // namespace
}  // namespace bough::fe::test
