/// \file Every card that is read: fields, defaults, completion.
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

TEST(Cards, GridDefaultsOfGrdset) {
  const auto deck = read_clean("GRID,1\nGRID,2,0,1.,,,0,0\nGRID,3,7,1.,,,8,3\nGRDSET,,4,,,,5,345\n");
  EXPECT_EQ(values(deck.grids[0].cp, deck.grids[0].cd, deck.grids[0].ps), values(4, 5, 0b011100u));
  EXPECT_EQ(values(deck.grids[1].cp, deck.grids[1].cd, deck.grids[1].ps), values(0, 0, 0u));
  EXPECT_EQ(values(deck.grids[2].cp, deck.grids[2].cd, deck.grids[2].ps), values(7, 8, 0b000100u));
  EXPECT_EQ(deck.locate(deck.grids[2].at).line, 3);
}

TEST(Cards, CoordinateSystems) {
  const auto deck =
      read_clean("CORD1R,1,11,12,13,2,21,22,23\nCORD1C,3,1,2,3\nCORD2S,4,1,1.,2.,3.,4.,5.,6.\n,7.,8.,9.\n");
  ASSERT_EQ(deck.coord_systems.size(), 4u);
  EXPECT_TRUE(deck.coord_systems[1].by_grids);
  EXPECT_EQ(values(deck.coord_systems[1].id, deck.coord_systems[1].grids, deck.coord_systems[2].kind),
            values(2, (std::array<int, 3>{21, 22, 23}), records::CoordKind::Cylindrical));
  const auto& s = deck.coord_systems[3];
  EXPECT_EQ(s.kind, records::CoordKind::Spherical);
  EXPECT_FALSE(s.by_grids);
  EXPECT_EQ(values(s.rid, s.a, s.b, s.c), values(1, Vector3d(1, 2, 3), Vector3d(4, 5, 6), Vector3d(7, 8, 9)));
}

TEST(Cards, MaterialCompletion) {
  const auto deck = read_clean(
      "MAT1,1,2.6,,.3,7.8,1.2-5,20.,.01\n,1.,2.,3.\nMAT1,2,2.6,1.\nMAT1,3,,1.,.3\nMAT1,4,2.\nMAT1,5,,3.\nMAT1,6,2.6,1.,"
      ".3\n");
  const auto& m = deck.mat1;
  EXPECT_DOUBLE_EQ(m[0].G, 1.0);
  EXPECT_EQ(values(m[0].rho, m[0].alpha, m[0].tref, m[0].ge), values(7.8, 1.2e-5, 20.0, 0.01));
  EXPECT_DOUBLE_EQ(m[1].nu, 0.3);
  EXPECT_DOUBLE_EQ(m[2].E, 2.6);
  EXPECT_EQ(values(m[3].nu, m[3].G, m[4].E), values(0.0, 0.0, 0.0));
  EXPECT_EQ(values(m[4].nu, m[5].G), values(0.0, 1.0));
}

TEST(Cards, BarProperties) {
  const auto deck = read_clean(
      "PBAR,1,2,3.,4.,5.,6.,7.\n,1.,2.,3.,4.,5.,6.,7.,8.\n,.8,.9,1.5\nPBAR,2,2,3.,4.,5.\n"
      "PBAR,3,2,3.,4.,5.\n,\n,0.,0.\nPBARL,4,2,,I\n,10.,5.,5.,.1,.2,.3,.7\nPBARL,5,2,MSCBML0,rod\n,1.\n");
  const auto& p = deck.pbar[0];
  EXPECT_EQ(values(p.A, p.I1, p.I2, p.J, p.nsm, p.recovery[0], p.recovery[3], p.k1),
            values(3.0, 4.0, 5.0, 6.0, 7.0, Vector2d(1, 2), Vector2d(7, 8), 0.8));
  EXPECT_EQ(values(p.k2, p.I12), values(0.9, 1.5));
  EXPECT_FALSE(deck.pbar[1].k1.has_value());
  EXPECT_EQ(deck.pbar[1].recovery[2], Vector2d(0, 0));
  EXPECT_FALSE(deck.pbar[2].k2.has_value());
  EXPECT_EQ(values(deck.pbarl[0].shape, deck.pbarl[0].dims, deck.pbarl[0].nsm),
            values("I", (std::vector<double>{10, 5, 5, .1, .2, .3}), 0.7));
  EXPECT_EQ(values(deck.pbarl[1].shape, deck.pbarl[1].nsm), values("ROD", 0.0));
}

TEST(Cards, PbeamConstant) {
  const auto deck = read_clean(
      "PBEAM,1,5,2.,3.,4.,.5,6.,.7\n,1.,2.,3.,4.,5.,6.,7.,8.\n,0.,.9,.1,.2,.3,,.4\n,1.,2.,,,3.,4.,5.,6.\n"
      "PBEAM,2,5,2.,3.,4.\n");
  const auto& p = deck.pbeam[0];
  ASSERT_EQ(p.stations.size(), 2u);
  EXPECT_EQ(p.stations[0].x_over_L, 0.0);
  EXPECT_EQ(p.stations[1].x_over_L, 1.0);
  for (const auto& s : p.stations) {
    EXPECT_EQ(values(s.A, s.I1, s.I2, s.I12, s.J, s.nsm, s.recovery[1]),
              values(2.0, 3.0, 4.0, 0.5, 6.0, 0.7, Vector2d(3, 4)));
  }
  EXPECT_EQ(values(p.k1, p.k2, p.s1, p.s2, p.nsi_a, p.nsi_b, p.cw_a, p.cw_b),
            values(0.0, 0.9, 0.1, 0.2, 0.3, 0.3, 0.4, 0.4));
  EXPECT_EQ(values(p.m1_b, p.m2_b, p.n1_a, p.n2_b), values(1.0, 2.0, 3.0, 6.0));
  EXPECT_FALSE(deck.pbeam[1].k1.has_value());
  EXPECT_EQ(deck.pbeam[1].stations[1].I2, 4.0);
}

TEST(Cards, PbeamStations) {
  // End B at first, one station with its own points, one with those of A and blank values, one without points.
  const auto p = read_list(&records::Deck::pbeam, 1,
                           "PBEAM,1,5,2.,3.,4.,,6.\n,1.,2.,3.,4.,5.,6.,7.,8.\n"
                           "+,YES,1.,4.,,8.\n+,.1,.2,.3,.4,.5,.6,.7,.8\n"
                           "+,NO,.75,9.\n"
                           "+,YESA,.25\n"
                           "+,.5,.6\n")
                     .front();
  const auto& s = p.stations;
  ASSERT_EQ(s.size(), 4u);
  EXPECT_EQ(values(s[1].x_over_L, s[2].x_over_L, s[3].A), values(0.25, 0.75, 4.0));
  EXPECT_EQ(s[3].I1, 3.0) << "blank at end B is the value of end A";
  EXPECT_EQ(s[3].I2, 8.0);
  EXPECT_EQ(s[3].J, 6.0);
  EXPECT_EQ(s[1].A, 2.5) << "blank between is interpolated";
  EXPECT_EQ(values(s[1].I2, s[2].A, s[2].I2, s[1].recovery[0]), values(5.0, 9.0, 7.0, Vector2d(1, 2)));
  EXPECT_EQ(values(s[2].recovery[0], s[3].recovery[3], p.k1), values(Vector2d(0, 0), Vector2d(.7, .8), 0.5));
  EXPECT_EQ(p.k2, 0.6);
}

TEST(Cards, PbeamlStations) {
  // The example of the Quick Reference Guide: a T whose last station is all defaults.
  const auto deck = read_clean(
      "PBEAML,99,21,,T\n,12.,14.8,2.5,2.6,,NO,.4,6.\n,7.,1.2,2.6,,YES,.6,6.,7.8\n,5.6,2.3,,YES\n"
      "PBEAML,3,2,MSCBML0,ROD\n,1.,.5\nPBEAML,4,2,,BAR\n,1.,2.,.5,YES,1.,3.,,1.5\n,NO,.5\n");
  const auto& p = deck.pbeaml[0];
  EXPECT_EQ(p.shape, "T");
  ASSERT_EQ(p.stations.size(), 4u);
  EXPECT_EQ(values(p.stations[1].x_over_L, p.stations[1].dims, p.stations[2].dims),
            values(0.4, (std::vector<double>{6, 7, 1.2, 2.6}), (std::vector<double>{6, 7.8, 5.6, 2.3})));
  EXPECT_EQ(values(p.stations[3].x_over_L, p.stations[3].dims, deck.pbeaml[1].stations[1].dims),
            values(1.0, p.stations[0].dims, (std::vector<double>{1})));
  EXPECT_EQ(deck.pbeaml[1].stations[1].nsm, 0.5);
  const auto& t = deck.pbeaml[2].stations;
  ASSERT_EQ(t.size(), 3u);
  EXPECT_EQ(values(t[1].dims, t[1].nsm, t[2].dims),
            values((std::vector<double>{2, 2}), 1.0, (std::vector<double>{3, 2})));
}

TEST(Cards, ShapesAndTheirDimensions) {
  const std::vector<std::pair<std::string, int>> shapes{
      {"ROD", 1},   {"TUBE", 2}, {"TUBE2", 2}, {"I", 6},    {"CHAN", 4},  {"T", 4}, {"BOX", 4},   {"BAR", 2},
      {"CROSS", 4}, {"H", 4},    {"T1", 4},    {"I1", 4},   {"CHAN1", 4}, {"Z", 4}, {"CHAN2", 4}, {"T2", 4},
      {"BOX1", 6},  {"HEXA", 3}, {"HAT", 4},   {"HAT1", 5}, {"DBOX", 10}, {"L", 4}};
  for (const auto& [shape, count] : shapes) {
    std::string text = "PBARL,1,1,," + shape;
    for (int i = 0; i <= count; ++i) text += (i % 8 == 0 ? "\n," : ",") + std::to_string(i + 1) + ".";
    const auto deck = read_clean(text + "\n");
    ASSERT_EQ(deck.pbarl.size(), 1u) << shape;
    EXPECT_EQ(deck.pbarl[0].dims.size(), static_cast<std::size_t>(count)) << shape;
    EXPECT_EQ(deck.pbarl[0].nsm, count + 1.0) << shape;
  }
}

TEST(Cards, OtherProperties) {
  const auto deck = read_clean(
      "PROD,1,2,3.,4.,5.,6.\nPTUBE,1,2,10.,1.,.5,8.\nPTUBE,2,2,10.\nPELAS,1,2.,3.,4.,2,5.\n"
      "PMASS,1,1.5,2,2.5,3,3.5,4,4.5\n"
      "PBUSH,1,K,1.,2.,3.,4.,5.,6.\n,,B,.1,.2\n,,GE,.05\n,,RCV,1.,1.\n,,M,9.\nPBUSH,2,GE,.1,.2\n");
  EXPECT_EQ(values(deck.prod[0].A, deck.prod[0].J, deck.prod[0].c, deck.prod[0].nsm), values(3.0, 4.0, 5.0, 6.0));
  EXPECT_EQ(values(deck.ptube[0].t, deck.ptube[0].od2, deck.ptube[1].t), values(1.0, 8.0, 5.0));
  EXPECT_FALSE(deck.ptube[1].od2.has_value());
  EXPECT_EQ(values(deck.pelas[0].ge, deck.pelas[0].s, deck.pelas[1].id), values(3.0, 4.0, 2));
  EXPECT_EQ(deck.pelas[1].k, 5.0);
  ASSERT_EQ(deck.pmass.size(), 4u);
  EXPECT_EQ(values(deck.pmass[3].id, deck.pmass[3].m, deck.pbush[0].k[5]), values(4, 4.5, 6.0));
  EXPECT_EQ(values(deck.pbush[0].b[1], deck.pbush[0].b[2], deck.pbush[0].ge[5], deck.pbush[0].mass),
            values(0.2, 0.0, 0.05, 9.0));
  EXPECT_EQ(values(deck.pbush[1].ge[1], deck.pbush[1].ge[2]), values(0.2, 0.0));
}

TEST(Cards, BarsAndTheirDefaults) {
  const auto e = read_list(
      &records::Deck::beams, 6,
      "CBAR,1,9,1,2,0.,1.,0.,boe\n,45,6,1.,2.,3.,4.,5.,6.\nCBAR,2,,1,2,77\nCBAR,3,,1,2\n"
      "CBAR,4,,1,2,0,1,0\n"
      "BAROR,,8,,,0.,0.,2.,GOO\nCBEAM,5,,1,2,0.,1.,0.\n,,,,,,,,\n,101,102\nCBEAM,6,4,1,2\nBEAMOR,,,,,33,,,BGG\n");
  EXPECT_EQ(values(e[0].pid, e[0].v, e[0].offt, e[0].pin_a, e[0].pin_b, e[0].wa, e[0].wb),
            values(9, Vector3d(0, 1, 0), "BOO", 0b011000u, 0b100000u, Vector3d(1, 2, 3), Vector3d(4, 5, 6)));
  EXPECT_EQ(values(e[1].pid, e[1].g0, e[1].offt), values(8, 77, "GOO"));
  EXPECT_EQ(values(e[2].g0, e[2].v), values(0, Vector3d(0, 0, 2)));
  EXPECT_EQ(e[3].v, Vector3d(0, 1, 0)) << "integers where reals are wanted";
  EXPECT_TRUE(e[4].is_cbeam);
  EXPECT_EQ(values(e[4].pid, e[4].offt, e[4].sa, e[4].sb), values(5, "BGG", 101, 102));
  EXPECT_EQ(e[5].g0, 33);
  const auto old = read_clean("CBAR,1,1,1,2,0.,0.,1.,1\nCBAR,2,1,1,2,7,,,2\n");
  EXPECT_EQ(values(old.beams[0].v, old.beams[0].offt, old.beams[1].g0), values(Vector3d(0, 0, 1), "GGG", 7));
}

TEST(Cards, RodsSpringsMasses) {
  const auto deck = read_clean(
      "CROD,1,2,3,4\nCROD,2,,3,4\nCTUBE,1,2,3,4\nCONROD,1,2,3,4,5.,6.,7.,8.\n"
      "CELAS1,1,2,3,4,5,6\nCELAS2,2,1.5,3,1,,,.1,.2\nCMASS1,1,2,3,1\nCMASS2,2,2.5,,,4,0\n");
  EXPECT_EQ(values(deck.crod[1].pid, deck.crod[0].gb, deck.ctube[0].pid), values(2, 4, 2));
  EXPECT_EQ(values(deck.conrod[0].mid, deck.conrod[0].A, deck.conrod[0].nsm), values(4, 5.0, 8.0));
  EXPECT_EQ(values(deck.springs[0].pid, deck.springs[0].c1, deck.springs[0].g2, deck.springs[0].c2),
            values(2, 4, 5, 6));
  EXPECT_EQ(values(deck.springs[1].pid, deck.springs[1].k, deck.springs[1].g2, deck.springs[1].ge, deck.springs[1].s),
            values(0, 1.5, 0, 0.1, 0.2));
  EXPECT_EQ(values(deck.scalar_masses[0].pid, deck.scalar_masses[1].m, deck.scalar_masses[1].g1), values(2, 2.5, 0));
  EXPECT_EQ(deck.scalar_masses[1].g2, 4);
}

TEST(Cards, Bushes) {
  const auto deck =
      read_clean("CBUSH,1,,3\nCBUSH,2,9,3,4,5\nCBUSH,3,9,3,4,1.,0.,0.\n,.25,7,1.,2.,3.\nCBUSH,4,9,3,4,,,,0\n");
  EXPECT_EQ(values(deck.cbush[0].pid, deck.cbush[0].gb, deck.cbush[0].s, deck.cbush[0].ocid), values(1, 0, 0.5, -1));
  EXPECT_FALSE(deck.cbush[0].cid.has_value());
  EXPECT_FALSE(deck.cbush[0].v.has_value());
  EXPECT_EQ(values(deck.cbush[1].g0, deck.cbush[2].v, deck.cbush[2].s), values(5, Vector3d(1, 0, 0), 0.25));
  EXPECT_EQ(values(deck.cbush[2].ocid, deck.cbush[2].s_offset, deck.cbush[3].cid), values(7, Vector3d(1, 2, 3), 0));
}

TEST(Cards, ConcentratedMasses) {
  const auto deck = read_clean(
      "CONM1,1,2,3,11.,21.,22.,31.,32.\n,33.,41.,42.,43.,44.,51.,52.,53.\n,54.,55.,61.,62.,63.,64.,65.,66.\n"
      "CONM2,2,7,-1,1.5,1.,2.,3.\n,11.,21.,22.,31.,32.,33.\n");
  const auto& m = deck.conm1[0].m;
  EXPECT_EQ(deck.conm1[0].cid, 3);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column <= row; ++column) {
      EXPECT_EQ(m(row, column), 10.0 * (row + 1) + column + 1);
      EXPECT_EQ(m(column, row), m(row, column));
    }
  const auto& c = deck.conm2[0];
  EXPECT_EQ(values(c.cid, c.m, c.x, c.inertia),
            values(-1, 1.5, Vector3d(1, 2, 3), (std::array<double, 6>{11, 21, 22, 31, 32, 33})));
}

TEST(Cards, RigidElementsAndConstraints) {
  const auto deck = read_clean(
      "GRID,1\nRBE2,1,10,123456,1,2,THRU,4,7\n,9,1.5-5\nRBAR,2,1,2,123456\nRBAR,3,1,2,123,456,4,1\n"
      "SPC,1,5,26,.5,6,1\nSPC1,1,345,1,8\nSPCADD,3,1,2\nMPCADD,5,6,7\n"
      "MPC,1,3,1,1.,4,2,-2.\n,,5,3,.5\n");
  EXPECT_EQ(values(deck.rbe2[0].gn, deck.rbe2[0].cm, deck.rbe2[0].gm),
            values(10, 63u, (std::vector<int>{1, 2, 3, 4, 7, 9})));
  EXPECT_EQ(values(deck.rbar[0].cma, deck.rbar[0].cmb, deck.rbar[1].cma), values(0u, 63u, 8u));
  EXPECT_EQ(deck.rbar[1].cmb, 1u);
  ASSERT_EQ(deck.spc.size(), 4u);
  EXPECT_EQ(values(deck.spc[0].c, deck.spc[0].d, deck.spc[1].g), values(0b100010u, 0.5, 6));
  EXPECT_EQ(values(deck.spc[3].g, deck.spc[3].c), values(8, 0b011100u));
  EXPECT_FALSE(deck.spc[3].skip_if_missing);
  EXPECT_EQ(deck.spcadd[0].sets, (std::vector<int>{1, 2}));
  EXPECT_EQ(deck.mpcadd[0].sets, (std::vector<int>{6, 7}));
  ASSERT_EQ(deck.mpc[0].terms.size(), 3u);
  EXPECT_EQ(values(deck.mpc[0].terms[1].a, deck.mpc[0].terms[2].g, deck.mpc[0].terms[2].c), values(-2.0, 5, 3));
}

TEST(Cards, Loads) {
  const auto deck = read_clean(
      "FORCE,1,2,3,4.,0.,0.,1.\nMOMENT,1,2,,4.,1.\nGRAV,5,,9.81,0.,0.,-1.\nLOAD,9,2.,1.,1,.5,5,1.,3\n,2.,4\n");
  EXPECT_FALSE(deck.point_loads[0].is_moment);
  EXPECT_EQ(deck.point_loads[0].cid, 3);
  EXPECT_EQ(deck.point_loads[0].f, 4.0);
  EXPECT_TRUE(deck.point_loads[1].is_moment);
  EXPECT_EQ(values(deck.point_loads[1].n, deck.gravity[0].a, deck.gravity[0].n),
            values(Vector3d(1, 0, 0), 9.81, Vector3d(0, 0, -1)));
  EXPECT_EQ(deck.loads[0].s, 2.0);
  ASSERT_EQ(deck.loads[0].terms.size(), 4u);
  EXPECT_EQ(deck.loads[0].terms[1], (std::pair<double, int>{0.5, 5}));
  EXPECT_EQ(deck.loads[0].terms[3], (std::pair<double, int>{2.0, 4}));
}

TEST(Cards, EigenvalueMethods) {
  const auto m = read_list(&records::Deck::eigen_methods, 6,
                           "EIGRL,1,.1,3.2,10,0,,,MAX\nEIGRL,2\nEIGRL,3,,50.\n"
                           "EIGRL   4\n        V1=0.5  V2 = 2.5 ND=7,NORM=MAX NUMS=2\n"
                           "EIGR,10,GIV,.0,.1,,6,,,+ER\n+ER,POINT,12,3\nEIGR,11,INV,1.,2.,4\n,MAX\n");
  EXPECT_EQ(values(m[0].f1, m[0].f2, m[0].num_modes, m[0].norm), values(0.1, 3.2, 10, "MAX"));
  EXPECT_EQ(m[1].num_modes, 1) << "without range and count: the lowest";
  EXPECT_EQ(values(m[1].norm, m[2].num_modes, m[3].f1), values("MASS", 0, 0.5));
  EXPECT_EQ(values(m[3].f2, m[3].num_modes, m[3].norm), values(2.5, 7, "MAX"));
  EXPECT_FALSE(m[4].is_eigrl);
  EXPECT_EQ(values(m[4].method, m[4].f2, m[4].num_modes, m[4].norm, m[4].norm_grid, m[4].norm_component),
            values("GIV", 0.1, 6, "POINT", 12, 3));
  EXPECT_EQ(values(m[5].num_modes, m[5].norm), values(12, "MAX"));
}

TEST(Cards, Parameters) {
  const auto deck =
      read_clean("PARAM   COUPMASS1\nPARAM    AUTOSPC no\nparam,wtmass,.00259\nPARAM*  EPZERO          7\n");
  EXPECT_EQ(values(deck.find_param("COUPMASS")->value, deck.find_param("AUTOSPC")->value,
                   deck.find_param("WTMASS")->value, deck.find_param("EPZERO")->value),
            values("1", "NO", ".00259", "7"));
}

}  // namespace
}  // namespace bough::nastran
