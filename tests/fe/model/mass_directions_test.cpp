/// \file Masses that differ by direction, and directions without stiffness that carry mass.
#include "fe/matrices/mass_directions.hpp"

#include <gtest/gtest.h>

#include "fe/matrices/assembly.hpp"
#include "fe/matrices/grid_point_weight.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe {
namespace {

struct Built {
  Diagnostics diagnostics;
  records::Deck deck;
  std::unique_ptr<Model> model;

  explicit Built(const std::string& bulk)
      : deck(nastran::read_deck_text("SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n" + bulk, "deck.bdf", {}, diagnostics)) {
    diagnostics.throw_if_errors();
    model = std::make_unique<Model>(build_model(deck, {}, diagnostics));
  }
  records::MassProperties mass() const { return calc_mass_properties(*model, model->mass_kind(), Vector3d::Zero()); }
  double difference() const { return calc_mass_difference(mass().rigid_mass); }
};

const std::string kBars =
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nCBAR,2,1,2,3,0.,1.,0.\n"
    "PBAR,1,1,1.-3,1.-8,1.-8,1.-8\nMAT1,1,7.+10,,.3,2000.\nSPC1,1,123456,1\n";  // mass 4

TEST(MassDirections, BodiesHaveOneMass) {
  EXPECT_LT(Built(kBars).difference(), 1e-14);
  EXPECT_LT(Built(kBars + "PARAM,COUPMASS,1\nCONM2,9,3,,5.,.1,.2,.3\n,.4,.01,.5,.02,.03,.6\n").difference(), 1e-13);
  EXPECT_LT(Built(kBars + "CMASS2,9,6.,3,1\nCMASS2,10,6.,3,2\nCMASS2,11,6.,3,3\n").difference(), 1e-14);
}

TEST(MassDirections, ScalarMassesAreSeenInSizeAndInPlace) {
  const Built sideways(kBars + "CMASS2,9,6.,3,2\n");
  EXPECT_NEAR(sideways.difference(), 6. / 10 * 2 / 3, 1e-12);
  SourceLocation at;
  EXPECT_EQ(describe_mass(*sideways.model, sideways.deck, sideways.mass().rigid_mass, at),
            "the mass is 4 along x, 10 along y, 4 along z (CMASS2 9)");
  EXPECT_EQ(at.line, 13);
  const auto weight = calc_grid_point_weight(sideways.mass().rigid_mass);
  EXPECT_LT((weight.mass - Vector3d(4, 10, 4)).norm(), 1e-12);
  // Along y the 6 at x = 2 draw the centre to (4 * 1 + 6 * 2) / 10.
  EXPECT_NEAR(weight.cg(1, 0), 1.6, 1e-12);
  EXPECT_NEAR(weight.cg(2, 0), 1, 1e-12);
  // One mass in all directions, but not in one place.
  EXPECT_GT(Built(kBars + "CMASS2,9,6.,1,1\nCMASS2,10,6.,2,2\nCMASS2,11,6.,3,3\n").difference(), 1e-2);
  // In oblique axes: of a principal system.
  const Built oblique(kBars +
                      "CORD2R,5,,0.,0.,0.,1.,1.,1.\n,1.,0.,0.\nGRID,4,,2.,0.,0.,5\nRBE2,8,3,123456,4\n"
                      "CMASS2,9,6.,4,3\n");
  const std::string text = describe_mass(*oblique.model, oblique.deck, oblique.mass().rigid_mass, at);
  EXPECT_NE(text.find("10 along"), std::string::npos) << text;
  EXPECT_NE(text.find("of its principal axes"), std::string::npos) << text;
}

TEST(ObliqueSingularities, TheDirectionIsHeldWhereItHasMass) {
  const std::string rod =
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,2.,.5\nCONROD,1,1,2,1,1.-4\nMAT1,1,7.+10,,.3\nSPC1,1,123456,1\n";
  const Built massive(rod + "CONM2,2,2,,10.\n");
  ASSERT_EQ(massive.model->num_fdofs(), 1);
  // u = n q: along the rod, wherever q is counted.
  const Vector3d u = MatrixXd(massive.model->T()).col(0).segment<3>(6);
  const Vector3d n = Vector3d(1, 2, .5).normalized();
  EXPECT_LT(u.cross(n).norm(), 1e-12 * u.norm());
  int num_oblique = 0;
  for (const auto& entry : massive.model->autospc()) num_oblique += entry.is_skew && !entry.terms.empty() ? 1 : 0;
  EXPECT_EQ(num_oblique, 2);
  EXPECT_EQ(Built(rod + "CONM2,2,2,,10.\nASET1,123,2\n").model->num_fdofs(), 1);  // what is held may be named
  // Without mass the components that Nastran holds: 2 is the nearest to the rod and stays.
  const Built massless(rod);
  ASSERT_EQ(massless.model->num_fdofs(), 1);
  EXPECT_EQ(massless.model->find_fdof(1, 2), 0);
  for (const auto& entry : massless.model->autospc()) EXPECT_TRUE(entry.terms.empty());
}

TEST(ObliqueSingularities, WhatHangsOnTheGridFollows) {
  // Two rods in an oblique plane, a mass on a rigid arm whose translations follow grid 3.
  const Built b(
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,1.,1.\nGRID,3,,.2,1.3,.4\nGRID,4,,.2,1.3,.4\nCONROD,1,1,3,1,1.-4\n"
      "CONROD,2,2,3,1,2.-4\nMAT1,1,7.+10,,.3\nSPC1,1,123456,1,2\nRBE2,8,3,123,4\nCONM2,2,4,,10.\nSPC1,1,456,4\n");
  ASSERT_EQ(b.model->num_fdofs(), 2);
  const Vector3d normal = Vector3d(.2, 1.3, .4).cross(Vector3d(-.8, .3, -.6)).normalized();
  const MatrixXd T(b.model->T());
  EXPECT_LT((normal.transpose() * T.middleRows<3>(12)).norm(), 1e-12);
  EXPECT_LT((T.middleRows<3>(12) - T.middleRows<3>(18)).norm(), 1e-14);
}

}  // namespace
}  // namespace bough::fe
