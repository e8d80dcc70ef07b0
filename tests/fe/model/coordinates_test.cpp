#include "fe/model/coordinates.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/rotation.hpp"
#include "tests/fe/model/spring_model.hpp"

namespace bough::fe {
namespace {

using namespace test;
using records::CoordKind;

records::CoordSystem make_system(int id, CoordKind kind, int rid, Vector3d a, Vector3d b, Vector3d c) {
  return {.id = id, .kind = kind, .rid = rid, .a = a, .b = b, .c = c, .at = {}};
}

records::CoordSystem make_by_grids(int id, CoordKind kind, int g1, int g2, int g3) {
  records::CoordSystem s;
  s.id = id;
  s.kind = kind;
  s.by_grids = true;
  s.grids = {g1, g2, g3};
  return s;
}

TEST(Coordinates, rectangular_axes_from_three_points) {
  auto deck = make_deck({{0, 0, 0}});
  // z along basic x, x along basic y.
  deck.coord_systems.push_back(make_system(7, CoordKind::Rectangular, 0, {1, 2, 3}, {5, 2, 3}, {4, 9, 3}));
  Diagnostics d;
  const CoordinateSystems systems(deck, Vector3d::Zero(), d);
  ASSERT_EQ(d.num_errors(), 0);
  EXPECT_TRUE(systems.calc_point(7, {10, 20, 30}, {}, d).isApprox(Vector3d(31, 12, 23), 1e-15));
  Matrix3d expected;
  expected << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  EXPECT_TRUE(systems.calc_axes(7, {5, 5, 5}, {}, d).isApprox(expected, 1e-15));
}

TEST(Coordinates, cylindrical_and_spherical_points_and_axes) {
  auto deck = make_deck({{0, 0, 0}});
  deck.coord_systems.push_back(make_system(1, CoordKind::Cylindrical, 0, {1, 0, 0}, {1, 0, 1}, {2, 0, 0}));
  deck.coord_systems.push_back(make_system(2, CoordKind::Spherical, 0, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}));
  Diagnostics d;
  const CoordinateSystems systems(deck, Vector3d::Zero(), d);
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  const Vector3d p = systems.calc_point(1, {2, 30, 4}, {}, d);
  EXPECT_TRUE(p.isApprox(Vector3d(1 + 2 * c, 2 * s, 4), 1e-14));
  Matrix3d axes;
  axes << c, -s, 0, s, c, 0, 0, 0, 1;
  EXPECT_TRUE(systems.calc_axes(1, p, {}, d).isApprox(axes, 1e-14));
  // Spherical: r, angle from z, azimuth; its axes are the derivatives of the position.
  const Vector3d x(3, 50, 110);
  const Matrix3d spherical = systems.calc_axes(2, systems.calc_point(2, x, {}, d), {}, d);
  for (int i = 0; i < 3; ++i) {
    const Vector3d h = 1e-4 * Vector3d::Unit(i);
    const Vector3d slope = systems.calc_point(2, x + h, {}, d) - systems.calc_point(2, x - h, {}, d);
    EXPECT_LT((slope.normalized() - spherical.col(i)).norm(), 1e-8) << "axis " << i;
  }
  EXPECT_NEAR(spherical.determinant(), 1, 1e-14);
  // On the axis the directions are those of angle zero.
  EXPECT_TRUE(systems.calc_axes(1, {1, 0, 9}, {}, d).isIdentity(1e-15));
}

TEST(Coordinates, chain_through_systems_and_grids_in_any_order) {
  auto deck = make_deck({{2, 90, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}});
  deck.grids[0].cp = 10;  // in a system by grids 2, 3, 4
  deck.coord_systems.push_back(make_by_grids(10, CoordKind::Cylindrical, 2, 3, 4));
  deck.coord_systems.push_back(make_system(9, CoordKind::Rectangular, 8, {1, 0, 0}, {1, 0, 1}, {2, 0, 0}));
  deck.coord_systems.push_back(make_system(8, CoordKind::Cylindrical, 0, {0, 0, 5}, {0, 0, 6}, {0, 1, 5}));
  Diagnostics d;
  const CoordinateSystems systems(deck, Vector3d::Zero(), d);
  ASSERT_EQ(d.num_errors(), 0);
  // z along basic y, x along basic x, so y along -z basic.
  EXPECT_TRUE(systems.get_grid_position(0).isApprox(Vector3d(0, 0, -2), 1e-14));
  // The points of 9 are cylindrical in 8 (x of 8 along basic y): origin (r=1, 0°, 0) = (0,1,5).
  EXPECT_TRUE(systems.calc_point(9, {0, 0, 0}, {}, d).isApprox(Vector3d(0, 1, 5), 1e-14));
}

TEST(Coordinates, origin_moves_every_position) {
  auto deck = make_deck({{1, 2, 3}});
  deck.coord_systems.push_back(make_system(4, CoordKind::Rectangular, 0, {1, 1, 1}, {1, 1, 2}, {2, 1, 1}));
  Diagnostics d;
  const CoordinateSystems systems(deck, Vector3d(10, 0, 0), d);
  EXPECT_TRUE(systems.get_grid_position(0).isApprox(Vector3d(-9, 2, 3)));
  EXPECT_TRUE(systems.calc_point(0, {0, 0, 0}, {}, d).isApprox(Vector3d(-10, 0, 0)));
  EXPECT_TRUE(systems.calc_point(4, {0, 0, 0}, {}, d).isApprox(Vector3d(-9, 1, 1)));
}

TEST(Coordinates, errors_are_all_reported) {
  auto deck = make_deck({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}});
  deck.grids[0].cp = 99;
  deck.coord_systems.push_back(make_system(1, CoordKind::Rectangular, 2, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}));
  deck.coord_systems.push_back(make_system(2, CoordKind::Rectangular, 1, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}));
  deck.coord_systems.push_back(make_system(3, CoordKind::Rectangular, 0, {0, 0, 0}, {0, 0, 1}, {0, 0, 7}));
  deck.coord_systems.push_back(make_by_grids(4, CoordKind::Rectangular, 1, 2, 77));
  Diagnostics d;
  const CoordinateSystems systems(deck, Vector3d::Zero(), d);
  EXPECT_TRUE(d.has("fe.missing-coordinates"));
  EXPECT_TRUE(d.has("fe.cyclic-coordinates"));
  EXPECT_TRUE(d.has("fe.degenerate-coordinates"));
  EXPECT_TRUE(d.has("fe.missing-grid"));
  EXPECT_EQ(d.num_errors(), 4);
  systems.calc_axes(55, {0, 0, 0}, {}, d);
  EXPECT_EQ(d.num_errors(), 5);
}

TEST(Coordinates, cycle_through_a_grid) {
  auto deck = make_deck({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}});
  deck.grids[2].cp = 5;
  deck.coord_systems.push_back(make_by_grids(5, CoordKind::Rectangular, 1, 2, 3));
  Diagnostics d;
  const CoordinateSystems systems(deck, Vector3d::Zero(), d);
  EXPECT_TRUE(d.has("fe.cyclic-coordinates"));
  EXPECT_EQ(d.num_errors(), 1);
}

}  // namespace
}  // namespace bough::fe
