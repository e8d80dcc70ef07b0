/// Cards of plates, shells and solids, and the constraints and scalar points that come with them.
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

TEST(ShellCards, PropertiesAndElements) {
  const auto d = read_clean(
      "PSHELL,7,1,.1,2,1.5,3,.8,.02\n,.1,-.1,4\nPSHELL,8,1,.2\n"
      "CQUAD4,1,7,11,12,13,14,30.,.05\n,,1,.1,.2,.3,.4\nCQUAD4,2,7,11,12,13,14,5\nCTRIA3,3,,11,12,13,-10.\n");
  ASSERT_EQ(d.pshell.size(), 2u);
  const auto& p = d.pshell[0];
  EXPECT_EQ(values(p.mid1, p.mid2, p.mid3, p.mid4, p.t, p.bending_ratio, p.shear_ratio, p.nsm),
            values(1, 2, 3, 4, 0.1, 1.5, 0.8, 0.02));
  EXPECT_EQ(d.pshell[1].mid2, 0);
  EXPECT_DOUBLE_EQ(d.pshell[1].shear_ratio, 5.0 / 6);
  ASSERT_EQ(d.shells.size(), 3u);
  EXPECT_EQ(d.shells[0].theta_deg, 30);
  EXPECT_EQ(d.shells[0].z_offset, 0.05);
  EXPECT_TRUE(d.shells[0].relative_thickness);
  EXPECT_EQ(values(d.shells[0].t, d.shells[1].mcid, d.shells[2].pid),
            values((std::vector<double>{0.1, 0.2, 0.3, 0.4}), 5, 3));
  EXPECT_EQ(values(d.shells[2].theta_deg, d.shells[2].grids), values(-10, (std::vector<int>{11, 12, 13})));
}

TEST(ShellCards, Laminates) {
  const auto d =
      read_clean("PCOMP,5,-.3,.1,,,,,SYM\n,1,.1,0.,,2,.2,45.\n,,,-45.\nPCOMPG,6\n,101,1,.1,30.\n,102,2,.3\n");
  ASSERT_EQ(d.pcomp.size(), 2u);
  const auto& p = d.pcomp[0];
  ASSERT_EQ(p.plies.size(), 6u);  // three, mirrored
  EXPECT_EQ(p.z0, -0.3);
  EXPECT_EQ(p.nsm, 0.1);
  EXPECT_EQ(p.plies[2].mid, 2);  // blank: as the ply before
  EXPECT_EQ(values(p.plies[2].t, p.plies[3].theta_deg, p.plies[5].mid), values(0.2, -45, 1));
  EXPECT_DOUBLE_EQ(d.pcomp[1].z0, -0.2);  // blank: half of the whole
  EXPECT_EQ(d.pcomp[1].plies[1].mid, 2);
  EXPECT_EQ(d.pcomp[1].plies[0].theta_deg, 30);
}

TEST(SolidCards, MaterialsAndElements) {
  const auto d = read_clean(
      "MAT2,1,1.,2.,3.,4.,5.,6.,7.\nMAT8,2,10.,5.,.3,4.,3.,2.,1.\n"
      "MAT9,3,1.,2.,3.,4.,5.,6.,7.\n,8.,9.,10.,11.,12.,13.,14.,15.\n,16.,17.,18.,19.,20.,21.,22.\n"
      "PSOLID,4,3,-1\nCTETRA,1,4,1,2,3,4\nCTETRA,2,4,1,2,3,4,5\n,7\nCHEXA,3,4,1,2,3,4,5,6\n,7,8\nCPENTA,4,4,1,2,3,4,5,"
      "6\n");
  EXPECT_EQ(values(d.mat2[0].G(1, 2), d.mat2[0].rho, d.mat8[0].G2z), values(5, 7, 2));
  EXPECT_EQ(values(d.mat9[0].G(0, 5), d.mat9[0].G(5, 0), d.mat9[0].G(5, 5), d.mat9[0].rho), values(6, 6, 21, 22));
  EXPECT_EQ(d.psolid[0].cordm, -1);
  EXPECT_TRUE(d.solids[0].midsides.empty());
  EXPECT_EQ(values(d.solids[1].midsides, d.solids[2].corners, d.solids[3].corners.size()),
            values((std::vector<int>{5, 0, 7, 0, 0, 0}), (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8}), 6u));
}

TEST(ContinuumCards, WhatIsWrong) {
  EXPECT_EQ(values(read("PSHELL,7,,.1\n").count("deck.missing-field"), read("PCOMP,5\n").count("deck.missing-field"),
                   read_clean("PCOMP,5,,,,,,,SMEAR\n,1,.1\n").pcomp[0].layup),
            values(1, 1, records::Layup::Smeared));
  const auto old = read_clean("PCOMP,5,,,,,,,SYMMEM\n,1,.1,0.,,2,.2,90.\nPCOMP,6,,,,,,,ALL\n,1,.1,0.\n").pcomp;
  ASSERT_EQ(old.size(), 2u);
  EXPECT_EQ(old[0].plies.size(), 4u);
  EXPECT_TRUE(old[0].membrane && !old[0].bending && old[1].membrane && old[1].bending);
  const std::string law = ",4,1.,2.,3.,4.,5.,6.,7.\n,8.,9.,10.,11.,12.,13.,14.,15.\n,16.,17.,18.,19.,20.,21.,.5,.1\n";
  const auto six = read_clean("MAT6" + law).mat9, nine = read_clean("MAT9" + law).mat9;
  ASSERT_EQ(six.size(), 1u);
  EXPECT_TRUE(six[0].id == 4 && six[0].G == nine[0].G && six[0].rho == 0.5 && six[0].alpha == nine[0].alpha);
  EXPECT_EQ(read_clean("PCOMP1,5,,,,,1,.1,SMCORE\n,0.,90.\n").pcomp[0].layup, records::Layup::SmearedCore);
  EXPECT_EQ(read("PCOMP,5,,,,,,,SMCORE\n,1,.1\n").count("deck.missing-field"), 1);
  EXPECT_EQ(
      read("CQUAD4,1,1,1,2,3\n").count("deck.bad-integer") + read("CQUAD4,1,1,1,2,3\n").count("deck.missing-field"), 1);
  EXPECT_EQ(values(read("CQUAD4,1,1,1,2,3,4\n,,2,.1\n").count("deck.field-range"),
                   read("PSHELL,7,1,.1\nPCOMP,7\n,1,.1\n").count("deck.duplicate-id"),
                   read("MAT1,7,1.,,.3\nMAT8,7,1.,1.\n").count("deck.duplicate-id")),
            values(1, 1, 1));
  EXPECT_EQ(values(read("RROD,1,2,3\n").count("deck.field-range"), read("RBE3,1,,2,123\n").count("deck.missing-field"),
                   read("SPOINT\n").count("deck.missing-field")),
            values(1, 1, 1));
  EXPECT_EQ(read("CELAS4,1,2.\n").count("deck.missing-field"), 1);
}

TEST(InterpolationCards, GroupsAndDependents) {
  const auto d =
      read_clean("RBE3,1,,2,123456,1.,123,5,6\n,7,THRU,9,.5,12,11\n,UM,5,12,6,3\n,ALPHA,1.-5\nRROD,3,1,2,,3\n");
  ASSERT_EQ(d.rbe3.size(), 1u);
  const auto& e = d.rbe3[0];
  EXPECT_EQ(e.ref_grid, 2);
  EXPECT_EQ(e.ref_c, 63u);
  ASSERT_EQ(e.groups.size(), 2u);
  EXPECT_EQ(values(e.groups[0].grids, e.groups[1].weight, e.groups[1].c),
            values((std::vector<int>{5, 6, 7, 8, 9}), 0.5, 3u));
  EXPECT_EQ(e.groups[1].grids, (std::vector<int>{11}));
  ASSERT_EQ(e.um.size(), 2u);
  EXPECT_EQ(values(e.um[0].g, e.um[1].c, d.rrod[0].cmb), values(5, 4u, 3));
}

}  // namespace
}  // namespace bough::nastran
