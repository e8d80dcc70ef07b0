/// \file Load cards against closed forms: lines along beams, pressure on faces, rotation, directions by grids.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "base/rotation.hpp"
#include "fe/elements/beam.hpp"
#include "fe/loads/enforced.hpp"
#include "fe/loads/loads.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe {
namespace {

struct Loaded {
  records::Deck deck;
  Model model;
};

Loaded make_loaded(const std::string& bulk, Diagnostics& diagnostics, int subcase = 0) {
  auto deck = nastran::read_deck_text(bulk, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  ModelOptions options;
  options.autospc = false;
  options.subcase = subcase;
  options.uses_enforced = true;
  auto model = build_model(deck, options, diagnostics);
  return {std::move(deck), std::move(model)};
}

using Vector6d = Eigen::Matrix<double, 6, 1>;

std::string say(const Diagnostics& d) {
  std::string text;
  for (const auto& item : d.items()) text += item.id + " ";
  return text;
}

records::StaticSubcase solve(const Loaded& l, int set, Diagnostics& d) {
  const StaticSolver solver(l.model, assemble_stiffness(l.model, DofSet::Free));
  const auto load = calc_static_load(l.model, l.deck, set, d);
  d.throw_if_errors();
  return solve_static_case(l.model, solver, load);
}

// One bar of length 2 along x, EI1 = 700 (plane 1: y), EI2 = 350.
const std::string kBar =
    "SPC = 1\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,1.-3,1.-8,5.-9,1.-8\n"
    "MAT1,1,7.+10,,.3,2700.\nSPC1,1,123456,1\n";

TEST(BeamLoads, UniformLoadDeflectsAsTheory) {
  Diagnostics d;
  const auto l = make_loaded(kBar + "PLOAD1,4,1,FY,LE,0.,3.,2.,3.\nPLOAD1,5,1,FZE,FR,0.,0.,1.,3.\n", d);
  const double L = 2, EI1 = 700, EI2 = 350, p = 3;
  const auto uniform = solve(l, 4, d);
  EXPECT_NEAR(uniform.displacement[7], p * std::pow(L, 4) / (8 * EI1), 1e-12);
  EXPECT_NEAR(uniform.displacement[11], p * std::pow(L, 3) / (6 * EI1), 1e-12);
  // Triangular, p at the tip: 11 p L^4 / (120 EI).
  EXPECT_NEAR(solve(l, 5, d).displacement[8], 11 * p * std::pow(L, 4) / (120 * EI2), 1e-12);
  // Section forces at A and B: V = pL, M = pL²/2 at the root, none at the tip.
  const auto forces = calc_element_forces(l.model, uniform.displacement, l.deck, 4, d);
  ASSERT_EQ(forces.size(), 1u);
  const Eigen::VectorXd f = forces[0].force.row(0);
  EXPECT_NEAR(std::abs(f[1]), p * L, 1e-10);
  EXPECT_NEAR(std::abs(f[5]), p * L * L / 2, 1e-10);
  EXPECT_NEAR(f[7], 0, 1e-10);
  // The reaction carries both.
  EXPECT_NEAR(uniform.reaction[1], -p * L, 1e-10);
  EXPECT_NEAR(uniform.reaction[5], -p * L * L / 2, 1e-10);
}

TEST(BeamLoads, PointLoadAndMomentWithinTheSpan) {
  Diagnostics d;
  const auto l =
      make_loaded(kBar + "PLOAD1,4,1,FYE,FR,.25,8.\nPLOAD1,5,1,MZ,LE,.5,6.\nPLOAD1,6,1,MXE,LE,0.,1.,2.,1.\n", d);
  const double a = 0.5, L = 2, EI = 700;
  EXPECT_NEAR(solve(l, 4, d).displacement[7], 8 * a * a * (3 * L - a) / (6 * EI), 1e-12);
  const auto moment = solve(l, 5, d);
  EXPECT_NEAR(moment.displacement[11], 6 * a / EI, 1e-12);
  EXPECT_NEAR(moment.displacement[7], 6 * a * (L - a / 2) / EI, 1e-12);
  const double GJ = 7e10 / 2.6 * 1e-8;
  EXPECT_NEAR(solve(l, 6, d).displacement[9], 1 * L * L / (2 * GJ), 1e-12);
}

TEST(BeamLoads, PinnedEndPropsTheBeam) {
  // Clamped at 1, held at 2 through a bar released in bending there: 3/8 of the load on the prop, tip moment zero.
  Diagnostics d;
  std::string bulk = kBar;
  bulk.replace(bulk.find("CBAR,1,1,1,2,0.,1.,0."), 21, "CBAR,1,1,1,2,0.,1.,0.\n,,56");
  const auto l = make_loaded(bulk + "SPC1,1,123456,2\nPLOAD1,4,1,FY,LE,0.,3.,2.,3.\n", d);
  const auto s = [&] {
    const auto load = calc_static_load(l.model, l.deck, 4, d);
    VectorXd R = -load.F;  // everything is held
    return R;
  }();
  EXPECT_NEAR(s[7], -3.0 / 8 * 6, 1e-10);
  EXPECT_NEAR(s[1], -5.0 / 8 * 6, 1e-10);
  EXPECT_NEAR(s[11], 0, 1e-10);
  EXPECT_NEAR(s[5], -6.0 * 2 / 8, 1e-10);
  const auto forces = calc_element_forces(l.model, VectorXd::Zero(12), l.deck, 4, d);
  EXPECT_NEAR(forces[0].force(0, 7), 0, 1e-10);
  EXPECT_NEAR(std::abs(forces[0].force(0, 5)), 6.0 * 2 / 8, 1e-10);
  EXPECT_NEAR(std::abs(forces[0].force(0, 1)), 5.0 / 8 * 6, 1e-10);
}

TEST(BeamLoads, ProjectedLoadCountsTheLengthSeenAlongIt) {
  Diagnostics d;
  const auto l = make_loaded(
      "GRID,1,,0.,0.,0.\nGRID,2,,3.,4.,0.\nCBAR,1,1,1,2,0.,0.,1.\nPBAR,1,1,1.-3,1.-8,1.-8,1.-8\nMAT1,1,7.+10,,.3\n"
      "PLOAD1,4,1,FY,FRPR,0.,2.,1.,2.\nPLOAD1,5,1,FY,FR,0.,2.,1.,2.\n",
      d);
  const Vector6d seen = calc_resultant(l.model, calc_load(l.model, l.deck, 4, d));
  const Vector6d along = calc_resultant(l.model, calc_load(l.model, l.deck, 5, d));
  EXPECT_NEAR(seen[1], 2 * 3, 1e-12);
  EXPECT_NEAR(along[1], 2 * 5, 1e-12);
  EXPECT_NEAR(along[5], 2 * 5 * 1.5, 1e-12);
  EXPECT_NEAR(seen.head<3>().norm(), 6, 1e-12);
}

TEST(BeamLoads, ResultantOfATrapezoidOnAnOffsetTaperedBeam) {
  Diagnostics d;
  const auto l = make_loaded(
      "GRID,1,,1.,0.,0.\nGRID,2,,1.,2.,1.\nCBEAM,1,1,1,2,1.,0.,0.\n,,,.1,.2,.3,0.,-.1,.2\n"
      "PBEAM,1,1,2.-3,2.-8,2.-8,,3.-8\n,,,,,,,,\n,NO,1.,1.-3,1.-8,1.-8,,1.-8\nMAT1,1,7.+10,,.3\n"
      "PLOAD1,4,1,FZ,FR,.2,2.,.7,5.\nPLOAD1,4,1,MYE,LE,.3,1.,.9,4.\n",
      d);
  const auto& beam = static_cast<const Beam&>(*l.model.elements()[0]);
  const double L = beam.geometry().length;
  const Vector3d a = Vector3d(1, 0, 0) + beam.geometry().wa, axis = beam.geometry().R_basic_element.col(0);
  const double F = 0.5 * L * 3.5, centre = L * (0.2 + 0.5 * (2 + 2 * 5) / (3 * 7.0));
  Vector6d expected;
  const Vector3d f(0, 0, F);
  expected << f, (a + centre * axis).cross(f) + beam.geometry().R_basic_element.col(1) * 0.6 * 2.5;
  EXPECT_LT((calc_resultant(l.model, calc_load(l.model, l.deck, 4, d)) - expected).norm(), 1e-11 * expected.norm());
}

TEST(Pressure, WarpedQuadCarriesItsVectorArea) {
  Diagnostics d;
  const auto l = make_loaded(
      "GRID,1,,0.,0.,0.\nGRID,2,,2.,.1,.3\nGRID,3,,2.2,1.5,-.2\nGRID,4,,-.1,1.2,.4\nCQUAD4,1,1,1,2,3,4\n"
      "PSHELL,1,1,.1,1,,1\nMAT1,1,7.+10,,.3\n"
      "PLOAD2,4,3.,1\nPLOAD4,5,1,3.\nPLOAD,6,3.,1,2,3,4\nPLOAD4,7,1,1.,2.,3.,4.\n,0,0.,0.,2.\n",
      d);
  const Vector3d x1(0, 0, 0), x2(2, .1, .3), x3(2.2, 1.5, -.2), x4(-.1, 1.2, .4);
  const Vector3d area = 0.5 * (x3 - x1).cross(x4 - x2);  // Stokes: whatever the surface between the edges
  for (int set : {4, 5, 6}) {
    const Vector6d r = calc_resultant(l.model, calc_load(l.model, l.deck, set, d));
    EXPECT_LT((r.head<3>() - 3 * area).norm(), 1e-13) << set;
    // ∫ x × n dA of the bilinear surface, by a fine midpoint rule.
    Vector3d moment = Vector3d::Zero();
    const int n = 400;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double s = (i + 0.5) / n, t = (j + 0.5) / n;
        const Vector3d x = (1 - s) * (1 - t) * x1 + s * (1 - t) * x2 + s * t * x3 + (1 - s) * t * x4;
        const Vector3d ds = (1 - t) * (x2 - x1) + t * (x3 - x4), dt = (1 - s) * (x4 - x1) + s * (x3 - x2);
        moment += x.cross(ds.cross(dt)) / (n * n);
      }
    EXPECT_LT((r.tail<3>() - 3 * moment).norm(), 1e-4) << set;
  }
  // With a direction: along it, by the true area.
  const Vector6d along = calc_resultant(l.model, calc_load(l.model, l.deck, 7, d));
  EXPECT_NEAR(along.head<2>().norm(), 0, 1e-14);
  EXPECT_GT(along[2], 2.5 * area.norm() * 0.9);
}

/// Serendipity's work-equivalent forces of a uniform pressure on a flat square: -1/12 and 1/3; 0 and 1/3 of a triangle.
/// On half a cylinder the resultant is p times the projected area, in the limit of the parabolas' arcs.
TEST(Pressure, QuadraticShells) {
  Diagnostics d;
  const std::string plate = "PSHELL,1,1,.1,1,,1\nMAT1,1,7.+10,,.3\n";
  const auto flat = make_loaded(
      "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,2.,2.,0.\nGRID,4,,0.,2.,0.\nGRID,5,,1.,0.,0.\nGRID,6,,2.,1.,0.\n"
      "GRID,7,,1.,2.,0.\nGRID,8,,0.,1.,0.\nGRID,9,,5.,0.,0.\nGRID,10,,3.5,0.,0.\nGRID,11,,3.5,1.,0.\n"
      "CQUAD8,1,1,1,2,3,4,5,6\n,7,8\nCTRIA6,2,1,2,9,3,10,11,6\n" +
          plate + "PLOAD2,4,3.,1\nPLOAD4,5,2,3.\n",
      d);
  const auto quad = calc_load(flat.model, flat.deck, 4, d), tri = calc_load(flat.model, flat.deck, 5, d);
  const auto get = [&](const auto& f, int grid) {
    return f[flat.model.node(flat.model.find_node(grid)).first_gdof + 2];
  };
  for (int grid = 1; grid <= 8; ++grid) EXPECT_NEAR(get(quad, grid), 12 * (grid < 5 ? -1.0 / 12 : 1.0 / 3), 1e-13);
  for (int grid : {2, 9, 3}) EXPECT_NEAR(get(tri, grid), 0, 1e-13);
  for (int grid : {10, 11, 6}) EXPECT_NEAR(get(tri, grid), 9.0 / 3, 1e-13);

  std::string bulk = plate;
  const int n = 8;  // arcs over 180 degrees, length 1, radius 1
  const auto add_grid = [&](int id, double at, double y) {
    const double a = M_PI * at / (2 * n);
    bulk += "GRID," + std::to_string(id) + ",," + std::to_string(std::cos(a)) + "," + std::to_string(y) + "," +
            std::to_string(std::sin(a)) + "\n";
  };
  for (int k = 0; k <= 2 * n; ++k) {
    add_grid(3 * k + 1, k, 0);
    if (k % 2 == 0) add_grid(3 * k + 2, k, .5);
    add_grid(3 * k + 3, k, 1);
  }
  for (int k = 0; k < 2 * n; k += 2) {
    const auto id = [&](int column, int row) { return "," + std::to_string(3 * (k + column) + row); };
    bulk += "CQUAD8," + std::to_string(k + 1) + ",1" + id(0, 1) + id(0, 3) + id(2, 3) + id(2, 1) + id(0, 2) + id(1, 3) +
            "\n" + id(2, 2) + id(1, 1) + "\nPLOAD2,4,3.," + std::to_string(k + 1) + "\n";
  }
  const auto half = make_loaded(bulk, d);
  const Vector6d r = calc_resultant(half.model, calc_load(half.model, half.deck, 4, d));
  EXPECT_NEAR(std::abs(r[2]), 3 * 2 * 1, 1e-5);
  EXPECT_NEAR(r[0], 0, 1e-5);
  EXPECT_NEAR(r[1], 0, 1e-13);
}

TEST(Pressure, ClosedBrickIsInBalanceAndEachFacePushesInward) {
  Diagnostics d;
  std::string bulk =
      "GRID,1,,0.,0.,0.\nGRID,2,,2.,.1,.1\nGRID,3,,2.1,1.5,-.2\nGRID,4,,-.1,1.2,.2\nGRID,5,,.2,0.,1.\n"
      "GRID,6,,2.,-.1,1.3\nGRID,7,,1.8,1.4,1.\nGRID,8,,0.,1.,1.2\nCHEXA,1,1,1,2,3,4,5,6\n,7,8\nPSOLID,1,1\nMAT1,1,7.+"
      "10,,.3\n";
  // Every face by G1 and the corner across.
  for (const char* face : {"1,3", "8,6", "2,5", "3,6", "7,4", "4,5"})
    bulk += std::string("PLOAD4,4,1,3.,,,,") + face + "\n";
  bulk += "PLOAD4,5,1,3.,,,,6,8\nPLOAD4,6,1,0.,0.,9.,0.,5,7\n";
  const auto l = make_loaded(bulk, d);
  // A uniform pressure on a closed surface has no resultant.
  EXPECT_LT(calc_resultant(l.model, calc_load(l.model, l.deck, 4, d)).norm(), 1e-13);
  const Vector6d top = calc_resultant(l.model, calc_load(l.model, l.deck, 5, d));
  const Vector3d a = l.model.node(4).x, b = l.model.node(5).x, c = l.model.node(6).x, e = l.model.node(7).x;
  EXPECT_LT((top.head<3>() + 1.5 * (c - a).cross(e - b)).norm(), 1e-13);
  EXPECT_LT(top[2], 0);
  // P3 acts at the corner across from G1: the force there is the largest.
  const VectorXd F = calc_load(l.model, l.deck, 6, d);
  EXPECT_GT(std::abs(F[6 * 6 + 2]), 2 * std::abs(F[6 * 4 + 2]));
}

/// CIHEX3 in its own order; `place` maps the cube [0, 1]³.
std::string make_cubic(const std::function<Vector3d(const Vector3d&)>& place) {
  std::string grids, card = "CIHEX3,1,7";
  int id = 0;
  const auto add = [&](double x, double y, double z) {
    const Vector3d p = place({x, y, z});
    char text[120];
    std::snprintf(text, sizeof text, "GRID,%d,,%.15f,%.15f,%.15f\n", ++id, p.x(), p.y(), p.z());
    grids += text;
    card += "," + std::to_string(id);
  };
  const double corners[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  for (int z = 0; z <= 3; ++z)
    for (int k = 0; k < 4; ++k)
      for (int third = 0; third < (z == 0 || z == 3 ? 3 : 1); ++third) {
        const double s = third / 3.0, *a = corners[k], *b = corners[k + 1];
        add(a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), z / 3.0);
      }
  return grids + card + "\nPIHEX,7,1\nMAT1,1,7.+10,,.3\n";
}

// Faces of CIHEX3 by PLOAD4 (inward) and PLOAD3 (outward): the work of a pressure on cubic displacements is exact.
TEST(Pressure, CubicBrick) {
  Diagnostics d;
  const std::string straight = make_cubic([](const Vector3d& x) { return x; });
  for (const char* card : {"PLOAD4,4,1,3.,,,,1,7\n", "PLOAD4,4,1,3.,,,,10,4\n", "PLOAD3,4,-3.,1,7,1\n"}) {
    const auto l = make_loaded(straight + card, d);
    const VectorXd F = calc_load(l.model, l.deck, 4, d);
    double total = 0, cube = 0, mixed = 0, above = 0;
    for (const Node& node : l.model.nodes()) {
      const double f = F[node.first_gdof + 2];
      const Vector3d& x = node.x;
      total += f, cube += f * std::pow(x.x(), 3), mixed += f * std::pow(x.x(), 3) * x.y();
      above += std::abs(f) * x.z() + F.segment<2>(node.first_gdof).norm();
    }
    EXPECT_NEAR(total, 3, 1e-13);
    EXPECT_NEAR(cube, 3 / 4.0, 1e-13);
    EXPECT_NEAR(mixed, 3 / 8.0, 1e-13);
    EXPECT_NEAR(above, 0, 1e-13);
  }
  const auto bent = [](const Vector3d& x) {
    return Vector3d(x.x() + .1 * x.y() * x.y(), x.y() - .2 * x.z() * x.x() * x.x(), 1.3 * x.z() + .1 * x.x() * x.y());
  };
  // A closed surface has no resultant, whichever way the grids are counted.
  for (const double sign : {1.0, -1.0}) {
    std::string bulk = make_cubic([&](const Vector3d& x) { return Vector3d(bent({x.x(), x.y(), sign * x.z()})); });
    for (const char* face : {"1,7", "21,27", "1,24", "4,27", "7,30", "10,21"})
      bulk += std::string("PLOAD4,4,1,3.,,,,") + face + "\n";
    const auto l = make_loaded(bulk + "PLOAD4,5,1,3.,,,,21,27\n", d);
    EXPECT_LT(calc_resultant(l.model, calc_load(l.model, l.deck, 4, d)).norm(), 1e-13);
    EXPECT_LT(sign * calc_resultant(l.model, calc_load(l.model, l.deck, 5, d))[2], -2);
  }
}

TEST(Pressure, WedgeAndTetrahedronWithMidsideNodes) {
  Diagnostics d;
  std::string bulk =
      "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,0.,2.,0.\nGRID,4,,0.,0.,2.\nGRID,5,,1.,0.,-.1\nGRID,6,,1.1,1.,0.\n"
      "GRID,7,,0.,1.,.1\nGRID,8,,0.,0.,1.\nGRID,9,,1.,.1,1.\nGRID,10,,0.,1.,1.\nCTETRA,1,1,1,2,3,4,5,6\n,7,8,9,10\n"
      "PSOLID,1,1\nMAT1,1,7.+10,,.3\n"
      "GRID,11,,0.,0.,5.\nGRID,12,,1.,0.,5.\nGRID,13,,0.,1.,5.\nGRID,14,,0.,0.,6.\nGRID,15,,1.,0.,6.\nGRID,16,,0.,1.,6."
      "\n"
      "CPENTA,2,1,11,12,13,14,15,16\n";
  for (const char* face : {"1,4", "1,3", "2,1", "3,2"}) bulk += std::string("PLOAD4,4,1,3.,,,,") + face + "\n";
  for (const char* face : {"11,", "14,", "11,15", "12,16", "13,14"})
    bulk += std::string("PLOAD4,5,2,3.,,,,") + face + "\n";
  bulk += "PLOAD4,6,2,3.,,,,14\n";
  const auto l = make_loaded(bulk, d);
  for (int set : {4, 5}) EXPECT_LT(calc_resultant(l.model, calc_load(l.model, l.deck, set, d)).norm(), 1e-12) << set;
  const VectorXd top = calc_load(l.model, l.deck, 6, d);
  for (int grid : {14, 15, 16}) EXPECT_NEAR(top[l.model.node(l.model.find_node(grid)).first_gdof + 2], -0.5, 1e-13);
}

TEST(Rotation, CentrifugalAndTangentialForces) {
  Diagnostics d;
  const auto l = make_loaded(
      "GRID,1,,1.,0.,0.\nGRID,2,,3.,0.,1.\nCBAR,1,1,1,2,0.,1.,0.\nPBAR,1,1,1.-3,1.-8,1.-8,1.-8\nMAT1,1,7.+10,,.3,2700."
      "\n"
      "CONM2,9,2,,5.,0.,.5,0.\n,.4,,.6,,,.9\nGRID,3,,1.,1.,0.\nRFORCE,4,0,0,.3,0.,0.,2.\nRFORCE,5,1,0,0.,0.,0.,1.\n,."
      "7\n",
      d);
  const double omega = 2 * M_PI * 0.6, m_bar = 2700 * 1e-3 * std::sqrt(5.0);
  const VectorXd F = calc_load(l.model, l.deck, 4, d);
  // Lumped halves at the grids, and the mass at (3, 0.5, 1).
  EXPECT_NEAR(F[0], omega * omega * m_bar / 2 * 1, 1e-10);
  EXPECT_NEAR(F[6], omega * omega * (m_bar / 2 * 3 + 5 * 3), 1e-9);
  EXPECT_NEAR(F[7], omega * omega * 5 * 0.5, 1e-10);
  EXPECT_NEAR(F[8], 0, 1e-12);
  // Moment about the grid: arm (0, .5, 0) with the force of the mass, nothing gyroscopic about a principal axis.
  EXPECT_NEAR(F[11], -0.5 * omega * omega * 5 * 3, 1e-9);
  // An angular acceleration pushes along itself (OptiStruct's wording), about grid 1: the moment is I α.
  const VectorXd T = calc_load(l.model, l.deck, 5, d);
  const Vector6d r = calc_resultant(l.model, T, Vector3d(1, 0, 0));
  const double inertia = m_bar / 2 * 4 + 5 * (4 + 0.25) + 0.9;
  EXPECT_NEAR(r[5], inertia * 2 * M_PI * 0.7, 1e-9);
}

TEST(Rotation, OffsetBarsActWhereTheirMassIs) {
  const std::string bar =
      "GRID,1,,1.,0.,0.\nGRID,2,,3.,0.,1.\nCBAR,1,1,1,2,0.,1.,0.\n,,,-.2,.4,.1,.3,.5,-.6\nPBAR,1,1,1.-3,1.-8,1.-8,1.-"
      "8\n"
      "MAT1,1,7.+10,,.3,2700.\nRFORCE,4,0,0,.5,0.,0.,2.\n";
  const Vector3d a(0.8, 0.4, 0.1), b(3.3, 0.5, 0.4);  // the ends of the bar
  const double omega = 2 * M_PI, half = 2700 * 1e-3 * (b - a).norm() / 2;
  const auto push = [&](const Vector3d& p) { return Vector3d(omega * omega * half * Vector3d(p.x(), p.y(), 0)); };
  Diagnostics d;
  const auto lumped = make_loaded(bar, d), consistent = make_loaded(bar + "PARAM,COUPMASS,1\n", d);
  const VectorXd F = calc_load(lumped.model, lumped.deck, 4, d);
  EXPECT_LT((F.segment<3>(0) - push(a)).norm(), 1e-9);
  EXPECT_LT((F.segment<3>(3) - (a - Vector3d(1, 0, 0)).cross(push(a))).norm(), 1e-9);
  EXPECT_LT((F.segment<3>(6) - push(b)).norm(), 1e-9);
  EXPECT_LT((F.segment<3>(9) - (b - Vector3d(3, 0, 1)).cross(push(b))).norm(), 1e-9);
  const VectorXd G = calc_load(consistent.model, consistent.deck, 4, d);
  EXPECT_LT((G.segment<3>(0) + G.segment<3>(6) - push(a) - push(b)).norm(), 1e-9);
  EXPECT_GT((G - F).norm(), 1);
}

TEST(DirectedLoads, ForcesAndMomentsByGrids) {
  Diagnostics d;
  const auto l = make_loaded(
      "GRID,1,,0.,0.,0.\nGRID,2,,3.,4.,0.\nGRID,3,,0.,0.,2.\nCBAR,1,1,1,2,0.,0.,1.\nPBAR,1,1,1.-3,1.-8,1.-8,1.-8\n"
      "MAT1,1,7.+10,,.3\nCELAS2,8,2.,101\nSPOINT,101\n"
      "FORCE1,4,3,10.,1,2\nMOMENT1,4,2,5.,2,1\nFORCE2,5,1,10.,1,2,1,3\nMOMENT2,5,3,7.,1,2,1,3\nSLOAD,4,101,2.5\n"
      "LOAD,9,2.,1.,4,.5,5\n",
      d);
  const VectorXd F = calc_load(l.model, l.deck, 4, d), C = calc_load(l.model, l.deck, 5, d);
  EXPECT_LT((F.segment<3>(12) - Vector3d(6, 8, 0)).norm(), 1e-14);
  EXPECT_LT((F.segment<3>(9) - Vector3d(-3, -4, 0)).norm(), 1e-14);
  EXPECT_EQ(F[18], 2.5);
  EXPECT_LT((C.segment<3>(0) - Vector3d(8, -6, 0)).norm(), 1e-14);
  EXPECT_LT((C.segment<3>(15) - Vector3d(5.6, -4.2, 0)).norm(), 1e-14);
  EXPECT_LT((calc_load(l.model, l.deck, 9, d) - 2 * F - C).norm(), 1e-13);
}

TEST(Enforced, SettlementAndSpcdAgainstTheory) {
  // Clamped at 1; grid 2 moved by SPC d, overruled by SPCD; a rigid element carries the motion to grid 3.
  Diagnostics d;
  const auto l =
      make_loaded(kBar + "SPC,1,2,2,.01\nGRID,3,,2.,0.,1.\nRBE2,7,2,123456,3\nSPCD,4,2,2,.03\nSPCD,5,1,6,.2\n", d);
  const double EI = 700, L = 2;
  const auto by_spc = solve(l, 0, d), by_load = solve(l, 4, d), turned = solve(l, 5, d);
  EXPECT_NEAR(by_spc.displacement[7], 0.01, 1e-15);
  EXPECT_NEAR(by_spc.reaction[7], 3 * EI * 0.01 / std::pow(L, 3), 1e-10);
  EXPECT_NEAR(by_load.displacement[11], 1.5 * 0.03 / L, 1e-12);
  EXPECT_NEAR(by_load.reaction[1], -3 * EI * 0.03 / std::pow(L, 3), 1e-10);
  EXPECT_NEAR(by_load.displacement[13], 0.03, 1e-14);
  EXPECT_NEAR(by_load.strain_energy, 1.5 * EI * 0.03 * 0.03 / std::pow(L, 3), 1e-12);
  // SPCD 5 turns the root and leaves the SPC's value at grid 2.
  EXPECT_NEAR(turned.displacement[5], 0.2, 1e-15);
  EXPECT_NEAR(turned.displacement[7], 0.01, 1e-15);
  EXPECT_NEAR(turned.reaction[5], 3 * EI / L * (0.2 - 0.01 / L), 1e-9);
}

TEST(Enforced, ReactionsBalanceTheLoadsInTurnedAxes) {
  Diagnostics d;
  const auto l = make_loaded(
      "SPC = 1\nBEGIN BULK\nCORD2R,5,,0.,0.,0.,1.,1.,1.\n,1.,0.,0.\nGRID,1,,0.,0.,0.,5\nGRID,2,,2.,0.,0.,5\n"
      "GRID,3,,2.,2.,0.\nGRID,4,,2.,2.,1.\nCBAR,1,1,1,2,0.,1.,0.\nCBAR,2,1,2,3,0.,0.,1.\nPBAR,1,1,1.-3,1.-8,5.-9,1.-8\n"
      "MAT1,1,7.+10,,.3,2700.\nSPC1,1,123456,1\nSPC1,1,3,3\nRBE2,7,3,123456,4\n"
      "FORCE,4,4,,10.,1.,2.,3.\nPLOAD1,4,2,FX,FR,0.,2.,1.,6.\nGRAV,4,,9.81,0.,0.,-1.\n",
      d);
  const auto s = solve(l, 4, d);
  EXPECT_GT(s.load_resultant.norm(), 10);
  EXPECT_LT((s.load_resultant + s.reaction_resultant).norm(), 1e-9 * s.load_resultant.norm());
  EXPECT_LT(s.mpc_resultant.norm(), 1e-9 * s.load_resultant.norm());
  EXPECT_GT(s.mpc_force.norm(), 1);
  EXPECT_LT(s.epsilon, 1e-10);
  // Clapeyron: the loads did twice the strain energy (nothing is enforced).
  EXPECT_NEAR(s.displacement.dot(s.load), 2 * s.strain_energy, 1e-9 * s.strain_energy);
}

TEST(LoadErrors, AreReportedWithTheirIds) {
  const auto errors = [](const std::string& bulk, int set) {
    Diagnostics d;
    const auto l = make_loaded(kBar + bulk, d);
    calc_load(l.model, l.deck, set, d);
    calc_enforced(l.model, l.deck, set, d);
    return say(d);
  };
  EXPECT_NE(errors("PLOAD1,4,9,FY,LE,0.,1.,1.,1.\n", 4).find("fe.missing-element"), std::string::npos);
  EXPECT_NE(errors("PLOAD2,4,1.,9\n", 4).find("fe.missing-element"), std::string::npos);
  EXPECT_EQ(errors("PLOAD2,4,1.,8,THRU,9\n", 4).find("fe.missing-element"), std::string::npos);
  EXPECT_NE(errors("PLOAD1,4,1,FY,LE,0.,1.,5.,1.\n", 4).find("fe.load-off-beam"), std::string::npos);
  EXPECT_NE(errors("FORCE1,4,1,1.,2,2\n", 4).find("fe.no-direction"), std::string::npos);
  EXPECT_NE(errors("SPCD,4,2,1,.5\n", 4).find("fe.spcd-not-fixed"), std::string::npos);
  EXPECT_NE(errors("SLOAD,4,99,1.\n", 4).find("fe.missing-grid"), std::string::npos);
  EXPECT_NE(
      errors("GRID,11,,5.,0.,0.\nGRID,12,,6.,0.,0.\nGRID,13,,5.,1.,0.\nGRID,14,,5.,0.,1.\nCTETRA,8,1,11,12,13,14\n"
             "PSOLID,1,1\nPLOAD4,4,8,1.,,,,11,11\n",
             4)
          .find("fe.bad-face"),
      std::string::npos);
  // PLOAD2 names no face of a solid.
  Diagnostics d;
  const auto l = make_loaded(make_cubic([](const Vector3d& x) { return x; }) + "PLOAD2,4,1.,1\n", d);
  calc_load(l.model, l.deck, 4, d);
  ASSERT_TRUE(d.has("fe.bad-face"));
  EXPECT_NE(d.items().back().what.find("names no face of the CIHEX3"), std::string::npos);
}

}  // namespace
}  // namespace bough::fe
