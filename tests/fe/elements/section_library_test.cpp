/// Section properties against Green's theorem over hand-drawn outlines, and against textbook closed forms.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fe/sections/section_library.hpp"
#include "fe/sections/thin_wall.hpp"

namespace bough::fe {
namespace {

using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;  ///< figure axes, counter-clockwise; holes clockwise
constexpr double kPi = std::numbers::pi;

LibrarySection calc(const std::string& shape, const std::vector<double>& dims) {
  std::string problem;
  const auto section = calc_library_section(shape, dims, &problem);
  if (!section) ADD_FAILURE() << shape << " " << problem;
  return section.value_or(LibrarySection{});
}

/// Area and second moments about the centroid: Green's theorem, edge by edge.
struct Moments {
  double A = 0, xx = 0, yy = 0, xy = 0;
};
Moments calc_moments(const std::vector<Polygon>& loops) {
  double A = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (const Polygon& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector2d p = loop[i], q = loop[(i + 1) % loop.size()];
      const double c = p[0] * q[1] - q[0] * p[1];
      A += c / 2;
      x += c * (p[0] + q[0]) / 6;
      y += c * (p[1] + q[1]) / 6;
      xx += c * (p[0] * p[0] + p[0] * q[0] + q[0] * q[0]) / 12;
      yy += c * (p[1] * p[1] + p[1] * q[1] + q[1] * q[1]) / 12;
      xy += c * (p[0] * q[1] + 2 * p[0] * p[1] + 2 * q[0] * q[1] + q[0] * p[1]) / 24;
    }
  }
  return {A, xx - x * x / A, yy - y * y / A, xy - x * y / A};
}

Polygon make_rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }
/// The corners x, y, x, y, ...
Polygon outline(const std::vector<double>& xy) {
  Polygon p;
  for (std::size_t i = 0; i + 1 < xy.size(); i += 2) p.emplace_back(xy[i], xy[i + 1]);
  return p;
}
Polygon reverse(const Polygon& p) { return {p.rbegin(), p.rend()}; }

Polygon make_circle(double r) {
  Polygon p;
  const int n = 4000;
  for (int i = 0; i < n; ++i) p.push_back(r * Vector2d(std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n)));
  return p;
}

struct Drawn {
  std::string shape;
  std::vector<double> dims;
  std::vector<Polygon> loops;
};

std::vector<Drawn> draw_all() {
  return {
      {"ROD", {1.3}, {make_circle(1.3)}},
      {"TUBE", {1.3, 1.0}, {make_circle(1.3), reverse(make_circle(1.0))}},
      {"TUBE2", {1.3, 0.3}, {make_circle(1.3), reverse(make_circle(1.0))}},
      {"BAR", {2, 1.5}, {make_rectangle(0, 0, 2, 1.5)}},
      {"HEXA", {0.5, 2, 1.5}, {{{0.5, 0}, {1.5, 0}, {2, 0.75}, {1.5, 1.5}, {0.5, 1.5}, {0, 0.75}}}},
      {"I", {5, 2, 3, 0.25, 0.375, 0.5}, {outline({-1,    0,   1,      0,   1,      0.375, 0.125, 0.375,
                                                   0.125, 4.5, 1.5,    4.5, 1.5,    5,     -1.5,  5,
                                                   -1.5,  4.5, -0.125, 4.5, -0.125, 0.375, -1,    0.375})}},
      {"I1", {1, 0.75, 4, 5}, {outline({0,    0, 1.75, 0, 1.75, 0.5, 1.25, 0.5, 1.25, 4.5, 1.75, 4.5,
                                        1.75, 5, 0,    5, 0,    4.5, 0.5,  4.5, 0.5,  0.5, 0,    0.5})}},
      {"CHAN", {2, 4, 0.25, 0.5}, {{{0, 0}, {2, 0}, {2, 0.5}, {0.25, 0.5}, {0.25, 3.5}, {2, 3.5}, {2, 4}, {0, 4}}}},
      {"CHAN1",
       {0.75, 1, 3.5, 4},
       {{{0, 0}, {1.75, 0}, {1.75, 0.25}, {1, 0.25}, {1, 3.75}, {1.75, 3.75}, {1.75, 4}, {0, 4}}}},
      {"CHAN2",
       {0.375, 0.5, 2, 4},
       {{{0, 0}, {4, 0}, {4, 2}, {3.625, 2}, {3.625, 0.5}, {0.375, 0.5}, {0.375, 2}, {0, 2}}}},
      {"T",
       {3, 4, 0.375, 0.25},
       {{{1.375, 0}, {1.625, 0}, {1.625, 3.625}, {3, 3.625}, {3, 4}, {0, 4}, {0, 3.625}, {1.375, 3.625}}}},
      {"T1",
       {3, 3.5, 0.375, 0.25},
       {{{0, 0}, {0.375, 0}, {0.375, 3}, {0, 3}, {0, 1.625}, {-3.5, 1.625}, {-3.5, 1.375}, {0, 1.375}}}},
      {"T2",
       {3, 4, 0.375, 0.5},
       {{{0, 0}, {3, 0}, {3, 0.375}, {1.75, 0.375}, {1.75, 4}, {1.25, 4}, {1.25, 0.375}, {0, 0.375}}}},
      {"CROSS", {1.5, 0.375, 3, 0.25}, {outline({0.75,  0,     1.125, 0,     1.125, 1.375, 1.875, 1.375,
                                                 1.875, 1.625, 1.125, 1.625, 1.125, 3,     0.75,  3,
                                                 0.75,  1.625, 0,     1.625, 0,     1.375, 0.75,  1.375})}},
      {"H", {2, 0.75, 3.5, 0.25}, {outline({0,     0,     0.375, 0,     0.375, 1.625, 2.375, 1.625,
                                            2.375, 0,     2.75,  0,     2.75,  3.5,   2.375, 3.5,
                                            2.375, 1.875, 0.375, 1.875, 0.375, 3.5,   0,     3.5})}},
      {"Z",
       {1.125, 0.5, 3.5, 4},
       {{{1.125, 0}, {2.75, 0}, {2.75, 0.25}, {1.625, 0.25}, {1.625, 4}, {0, 4}, {0, 3.75}, {1.125, 3.75}}}},
      {"L", {3, 6, 0.375, 0.625}, {{{0, 0}, {3, 0}, {3, 0.375}, {0.625, 0.375}, {0.625, 6}, {0, 6}}}},
      {"BOX", {4, 3, 0.375, 0.5}, {make_rectangle(0, 0, 4, 3), reverse(make_rectangle(0.5, 0.375, 3.5, 2.625))}},
      {"BOX1",
       {4, 3, 0.375, 0.5, 0.25, 0.75},
       {make_rectangle(0, 0, 4, 3), reverse(make_rectangle(0.75, 0.5, 3.75, 2.625))}},
      {"DBOX",
       {8, 3, 3, 0.5, 0.625, 0.75, 0.375, 0.25, 0.5, 0.375},
       {make_rectangle(0, 0, 8, 3), reverse(make_rectangle(0.5, 0.25, 2.6875, 2.625)),
        reverse(make_rectangle(3.3125, 0.375, 7.25, 2.5))}},
      {"HAT", {1.25, 0.25, 1.5, 0.5}, {outline({0,    0, 0.75, 0, 0.75, 1,   1.75, 1,   1.75, 0, 2.5, 0, 2.5,
                                                0.25, 2, 0.25, 2, 1.25, 0.5, 1.25, 0.5, 0.25, 0, 0.25})}},
      {"HAT1",
       {4, 2, 1.5, 0.1875, 0.375},
       {{{0, 0}, {4, 0}, {4, 0.5625}, {2.75, 0.5625}, {2.75, 2}, {1.25, 2}, {1.25, 0.5625}, {0, 0.5625}},
        reverse(make_rectangle(1.4375, 0.375, 2.5625, 1.8125))}},
  };
}

TEST(SectionLibrary, AreaAndMomentsOfEveryShape) {
  std::vector<std::string> drawn;
  for (const Drawn& d : draw_all()) {
    drawn.push_back(d.shape);
    const LibrarySection s = calc(d.shape, d.dims);
    const Moments m = calc_moments(d.loops);
    const double tolerance = d.loops.front().size() > 100 ? 1e-5 : 1e-12;  // the circles are polygons here
    EXPECT_NEAR(s.A / m.A, 1, tolerance) << d.shape;
    EXPECT_NEAR(s.I1 / m.yy, 1, tolerance) << d.shape;
    EXPECT_NEAR(s.I2 / m.xx, 1, tolerance) << d.shape;
    EXPECT_NEAR(s.I12, -m.xy, tolerance * (m.xx + m.yy)) << d.shape;  // element z is the figures' -x
    EXPECT_GT(s.J, 0) << d.shape;
    EXPECT_LT(s.J, 1.02 * (m.xx + m.yy)) << d.shape;
    EXPECT_GT(std::min(s.k1, s.k2), 0.05) << d.shape;
    EXPECT_LE(std::max(s.k1, s.k2), 1) << d.shape;
  }
  std::sort(drawn.begin(), drawn.end());
  EXPECT_EQ(drawn, list_section_shapes());
}

/// The faces of the pictures against the outlines drawn by hand; of round ones the polygon of 16 sides between circles.
TEST(SectionLibrary, FacesCoverEveryShape) {
  const double u = 2 * kPi / kRoundSides, area = std::sin(u) / u, inertia = area * (2 + std::cos(u)) / 3;
  for (const Drawn& d : draw_all()) {
    const bool is_round = d.loops.front().size() > 100;
    const double tolerance = is_round ? 1e-5 : 1e-12;
    const Moments m = calc_moments(d.loops), faces = calc_moments(calc(d.shape, d.dims).faces);
    EXPECT_NEAR(faces.A / m.A, is_round ? area : 1, tolerance) << d.shape;
    EXPECT_NEAR(faces.xx / m.yy, is_round ? inertia : 1, tolerance) << d.shape;
    EXPECT_NEAR(faces.yy / m.xx, is_round ? inertia : 1, tolerance) << d.shape;
    EXPECT_NEAR(faces.xy, -m.xy, tolerance * (m.xx + m.yy)) << d.shape;
  }
}

/// Flange 3 x 0.375 above a web 0.25 wide; the centroid by hand. Figures show x to the right and y up.
TEST(SectionLibrary, CornersOfATee) {
  const double web = 3.625 * 0.25, flange = 3 * 0.375, c = (web * 1.8125 + flange * 3.8125) / (web + flange);
  const auto faces = calc("T", {3, 4, 0.375, 0.25}).faces;
  ASSERT_EQ(faces.size(), 2U);
  const Polygon expected_flange{{3.625 - c, 1.5}, {3.625 - c, -1.5}, {4 - c, -1.5}, {4 - c, 1.5}};
  const Polygon expected_web{{-c, 0.125}, {-c, -0.125}, {3.625 - c, -0.125}, {3.625 - c, 0.125}};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_TRUE(faces[0][k].isApprox(expected_flange[k], 1e-12)) << faces[0][k].transpose();
    EXPECT_TRUE(faces[1][k].isApprox(expected_web[k], 1e-12)) << faces[1][k].transpose();
  }
}

/// A rectangle, also in rotated axes, and a tube come back; a section without inertia is a circle, without area
/// nothing.
TEST(EquivalentSections, ShapesComeBack) {
  const double h = 0.3, w = 0.1, A = h * w, I1 = w * h * h * h / 12, I2 = h * w * w * w / 12;
  for (const double angle : {0.0, 0.4}) {
    const double mean = (I1 + I2) / 2, half = (I1 - I2) / 2;
    const double a = mean + half * std::cos(2 * angle), b = mean - half * std::cos(2 * angle);
    const auto found = find_equivalent_section(A, a, b, half * std::sin(2 * angle), 1e-5);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->kind, EquivalentSection::Kind::Rectangle);
    const auto faces = list_faces(*found);
    const Eigen::Rotation2Dd turn(angle);
    const Polygon corners{{h / 2, -w / 2}, {h / 2, w / 2}, {-h / 2, w / 2}, {-h / 2, -w / 2}};
    for (std::size_t k = 0; k < 4; ++k) EXPECT_TRUE(faces[0][k].isApprox(turn * corners[k], 1e-12)) << k;
  }
  const double R = 0.2, r = 0.15, I = kPi / 4 * (std::pow(R, 4) - std::pow(r, 4));
  const auto tube = find_equivalent_section(kPi * (R * R - r * r), I, I, 0, 2 * I);
  ASSERT_TRUE(tube);
  EXPECT_EQ(tube->kind, EquivalentSection::Kind::Ring);
  EXPECT_NEAR(tube->d1, 2 * R, 1e-12);
  EXPECT_NEAR(tube->d2, 2 * r, 1e-12);
  EXPECT_EQ(list_faces(*tube).size(), static_cast<std::size_t>(kRoundSides));
  const auto solid = find_equivalent_section(kPi * R * R, kPi / 4 * std::pow(R, 4), kPi / 4 * std::pow(R, 4), 0,
                                             kPi / 2 * std::pow(R, 4));
  ASSERT_TRUE(solid);
  EXPECT_NEAR(solid->d1, 2 * R, 1e-12);
  EXPECT_EQ(solid->d2, 0);
  const auto rod = find_equivalent_section(kPi * R * R, 0, 0, 0, 0);
  ASSERT_TRUE(rod);
  EXPECT_NEAR(rod->d1, 2 * R, 1e-12);
  EXPECT_FALSE(find_equivalent_section(0, 1, 1, 0, 1));
}

/// The shipped listing of the MSC/NX run of beam_modes prints K1 = K2 = 0.9 for ROD.
TEST(SectionLibrary, ShearFactorsOfSolids) {
  EXPECT_EQ(calc("ROD", {2}).k1, 0.9);
  EXPECT_EQ(calc("TUBE", {2, 1.9}).k2, 0.5);
  EXPECT_EQ(calc("BAR", {2, 1}).k1, 5.0 / 6);
}

/// Torsion of a rectangle: b/a = 1: 0.1406 a⁴; 2: 0.229 a b³; 10: 0.312 a b³ (Timoshenko & Goodier, art. 109).
TEST(SectionLibrary, RectangleTorsion) {
  EXPECT_NEAR(calc("BAR", {1, 1}).J, 0.1406, 3e-4);
  EXPECT_NEAR(calc("BAR", {2, 1}).J, 0.2287 * 2, 1e-3);
  EXPECT_NEAR(calc("BAR", {1, 10}).J, 0.3123 * 10, 5e-3);
}

/// Thin channel, midline b and h: e = 3 b² tf / (6 b tf + h tw) outside the web; J = Σ b t³/3.
TEST(SectionLibrary, ChannelShearCenter) {
  const double t = 1e-3, b = 1, h = 2;
  const LibrarySection s = calc("CHAN", {b + t / 2, h + t, t, t});
  const double e = 3 * b * b / (6 * b + h);
  const double centroid = b * b / (2 * b + h);  // from the web's midline, to the right
  EXPECT_NEAR(s.n[0], 0, 1e-12);
  EXPECT_NEAR(s.n[1], -(centroid + e), 1e-3);  // z points to the left
  EXPECT_NEAR(s.J, (2 * b + h) * t * t * t / 3, 1e-12);
}

/// Angle and tee: the flows meet where the walls do, and so does the shear centre.
TEST(SectionLibrary, ShearCenterWhereWallsMeet) {
  const LibrarySection l = calc("L", {3, 6, 0.375, 0.625});
  const double A1 = 3 * 0.375, A2 = 0.625 * 5.625;
  const double x = (A1 * 1.5 + A2 * 0.3125) / (A1 + A2), y = (A1 * 0.1875 + A2 * (0.375 + 5.625 / 2)) / (A1 + A2);
  EXPECT_NEAR(l.n[0], y - 0.1875, 1e-12);
  EXPECT_NEAR(l.n[1], -(x - 0.3125), 1e-12);
  const LibrarySection t = calc("T", {3, 4, 0.375, 0.25});
  EXPECT_LT(t.n[0], 0);
  EXPECT_NEAR(t.n[1], 0, 1e-12);
  EXPECT_NEAR(calc("T2", {3, 4, 0.375, 0.25}).n[0], -t.n[0], 1e-12);
}

/// Unequal flanges: the shear centre divides the height by the flanges' own moments of inertia.
TEST(SectionLibrary, UnsymmetricIShearCenter) {
  const double h = 5, wb = 2, wt = 3, tw = 1e-4, tb = 2e-3, tt = 3e-3;
  const LibrarySection s = calc("I", {h, wb, wt, tw, tb, tt});
  const double Ib = tb * wb * wb * wb / 12, It = tt * wt * wt * wt / 12, between = h - (tb + tt) / 2;
  const double shear_center = tb / 2 + between * It / (It + Ib);
  const double A = wb * tb + wt * tt + tw * (h - tb - tt);
  const double centroid = (wb * tb * tb / 2 + wt * tt * (h - tt / 2) + tw * (h - tb - tt) * (h + tb - tt) / 2) / A;
  EXPECT_NEAR(s.n[0], centroid - shear_center, 2e-3);
}

/// One and two cells: Bredt, J = 4 A² / ∮ds/t; a double box with equal cells carries no flow in its middle wall.
TEST(SectionLibrary, BoxTorsionAndShear) {
  const double w = 4, h = 3, t1 = 0.03, t2 = 0.05, b = w - t2, d = h - t1;
  const LibrarySection box = calc("BOX", {w, h, t1, t2});
  EXPECT_NEAR(box.J, 2 * t1 * t2 * b * b * d * d / (b * t2 + d * t1), 1e-12);
  EXPECT_LT(box.n.norm(), 1e-12);
  const LibrarySection twin = calc("DBOX", {w, h, w / 2, t2, t2, t2, t1, t1, t1, t1});
  EXPECT_NEAR(twin.J, box.J, 1e-10);
  // Thin square tube: V² / (∫q²/t ds A) = 5/12 (Cowper 1966 with ν = 0: 20/48).
  const ThinWallResult tube =
      calc_thin_wall({{{0, 0}, {1, 0}, 1e-4}, {{1, 0}, {1, 1}, 1e-4}, {{1, 1}, {0, 1}, 1e-4}, {{0, 1}, {0, 0}, 1e-4}});
  EXPECT_NEAR(tube.shear_area_1 / 4e-4, 5.0 / 12, 1e-12);
}

/// A listing of MSC Nastran prints K1 = .90876, K2 = .087591 for BOX .05 x .5 x .001; BOX1 with equal walls is that
/// BOX.
TEST(SectionLibrary, BoxShearFactorsOfTheVendor) {
  const LibrarySection box = calc("BOX", {.05, .5, .001, .001});
  EXPECT_NEAR(box.k1, .90876, 5e-6);
  EXPECT_NEAR(box.k2, .087591, 5e-7);
  const LibrarySection twin = calc("BOX1", {.05, .5, .001, .001, .001, .001});
  EXPECT_NEAR(twin.k1, box.k1, 1e-14);
  EXPECT_NEAR(twin.k2, box.k2, 1e-14);
}

/// A box slit nowhere but thick on one side: the shear centre moves to that side, the centroid less so or more.
TEST(SectionLibrary, Box1ThickSide) {
  const LibrarySection s = calc("BOX1", {4, 3, 0.1, 0.1, 0.1, 0.4});  // DIM6: the left wall, +z
  const LibrarySection mirrored = calc("BOX1", {4, 3, 0.1, 0.1, 0.4, 0.1});
  EXPECT_NEAR(s.n[1], -mirrored.n[1], 1e-12);
  EXPECT_NEAR(s.n[0], 0, 1e-12);
  EXPECT_NEAR(s.k1, mirrored.k1, 1e-12);
}

TEST(SectionLibrary, RefusesWhatDoesNotFit) {
  std::string problem;
  EXPECT_FALSE(calc_library_section("TUBES", {1}, &problem));
  EXPECT_NE(problem.find("did you mean TUBE"), std::string::npos);
  EXPECT_FALSE(calc_library_section("BAR", {1}, &problem));
  EXPECT_NE(problem.find("expected 2"), std::string::npos);
  EXPECT_FALSE(calc_library_section("BAR", {1, -1}, &problem));
  EXPECT_FALSE(calc_library_section("TUBE", {1, 1.2}, &problem));
  EXPECT_TRUE(calc_library_section("TUBE", {1, 0}, &problem));
}

}  // namespace
}  // namespace bough::fe
