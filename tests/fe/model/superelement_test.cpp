/// External superelements: matrices given in the displacement systems of their section, on points of a deck with
/// others.
#include <gtest/gtest.h>

#include "fe/elements/superelement.hpp"
#include "fe/statics/superelement_check.hpp"
#include "model_matrices.hpp"
#include "text_model.hpp"

namespace bough::fe {
namespace {

using test::get_mass;
using test::get_stiffness;
using test::rotate_to_displacement_axes;

const std::string kSystems = "CORD2R,3,,1.,2.,3.,2.,3.,5.\n,4.,1.,0.\nCORD2C,4,,0.,0.,-1.,0.,1.,1.\n,3.,0.,0.\n";
const std::string kBars =
    "PARAM,COUPMASS,1\nCBAR,1,5,1,2,0.,1.,1.\nCBAR,2,5,2,3,0.,0.,1.\nPBAR,5,6,.01,2.-4,1.-4,1.5-4\n"
    "MAT1,6,7.+7,,.3,2700.\n";
const std::string kSection = kSystems + "GRID,1,,0.,0.,0.,3\nGRID,2,,1.,.2,.1,4\nGRID,3,,1.3,1.4,-.2\n";
// Places of kSection in other displacement systems, with other ids.
const std::string kMain = kSystems + "GRID,11,,0.,0.,0.,4\nGRID,12,,1.,.2,.1\nGRID,13,,1.3,1.4,-.2,3\n";

class SuperelementTest : public testing::Test {
 protected:
  /// A deck with the bars as a superelement of its matrices.
  records::Deck make_deck(const std::string& main) {
    Diagnostics diagnostics;
    auto deck = nastran::read_deck_text(main + "PARAM,AUTOSPC,NO\nPARAM,WTMASS,.5\n", "main.bdf", {}, diagnostics);
    records::Superelement s;
    s.id = 101;
    s.section = std::make_shared<const records::Deck>(nastran::read_deck_text(kSection, "part.bdf", {}, diagnostics));
    diagnostics.throw_if_errors();
    s.points = {{1, 63}, {2, 63}, {3, 63}};
    s.joined = {{1, 11}, {2, 12}, {3, 13}};
    s.checks_places = true;
    s.K = rotate_to_displacement_axes(bars_, get_stiffness(bars_));
    s.M = rotate_to_displacement_axes(bars_, get_mass(bars_));
    s.K4 = .03 * s.K;
    deck.superelements.push_back(std::move(s));
    deck.super.is_joined = true;
    return deck;
  }

  Model bars_ = test::build(kSection + kBars);
  Diagnostics diagnostics_;
};

TEST_F(SuperelementTest, JoinsPointsOfOtherDisplacementSystems) {
  const auto deck = make_deck(kMain);
  const auto model = build_model(deck, {}, diagnostics_);
  const MatrixXd K = get_stiffness(bars_), M = get_mass(bars_);
  EXPECT_LT((get_stiffness(model) - K).cwiseAbs().maxCoeff(), 1e-12 * K.cwiseAbs().maxCoeff());
  // PARAM,WTMASS of the assembly is not for its mass.
  EXPECT_LT((get_mass(model) - M).cwiseAbs().maxCoeff(), 1e-12 * M.cwiseAbs().maxCoeff());
  const MatrixXd I = MatrixXd::Identity(K.rows(), K.rows());
  EXPECT_LT((calc_structural_damping_times(model, .01, I) - .04 * K).cwiseAbs().maxCoeff(),
            1e-12 * K.cwiseAbs().maxCoeff());
}

TEST_F(SuperelementTest, RecoversItsInterior) {
  auto deck = make_deck(kMain);
  MatrixXd rows = MatrixXd::Random(2, 18);
  deck.superelements[0].recovery.push_back({"MEF1", {{1, 77, 2, 0}}, rows});
  const auto model = build_model(deck, {}, diagnostics_);
  const auto& item = *model.elements().back();
  EXPECT_EQ(item.card(), "MEF1_101");
  EXPECT_EQ(item.id(), 77);
  ASSERT_NE(item.printed_forces(), nullptr);
  EXPECT_EQ(item.printed_forces()->printed_force_names(), (std::vector<std::string>{"axial", "torque"}));
  const VectorXd u = VectorXd::Random(18);
  VectorXd own = u;  // in the displacement systems of the section
  for (const Node& node : bars_.nodes())
    for (int part = 0; part < 6; part += 3)
      own.segment<3>(node.first_gdof + part) = node.R_basic_cd.transpose() * u.segment<3>(node.first_gdof + part);
  EXPECT_LT((item.printed_forces()->calc_printed_forces(u) - rows * own).norm(), 1e-12 * own.norm());
}

TEST_F(SuperelementTest, AnotherPlaceIsAnotherBoundary) {
  for (const std::string& main : {kSystems + "GRID,11,,0.,0.,0.,4\nGRID,12,,1.,.2,.1\nGRID,13,,1.3,1.4,-.3,3\n",
                                  kSystems + "GRID,11,,0.,0.,0.,4\nGRID,12,,1.,.2,.1\n",
                                  kSystems + "GRID,11,,0.,0.,0.,4\nGRID,12,,1.,.2,.1\nSPOINT,13\n"}) {
    Diagnostics diagnostics;
    EXPECT_THROW(build_model(make_deck(main), {}, diagnostics), InputError) << main;
    EXPECT_TRUE(diagnostics.has("fe.superelement-boundary")) << main;
  }
}

TEST_F(SuperelementTest, ChecksOfADeliveredComponent) {
  auto deck = make_deck(kMain);
  const auto check = check_superelement(deck, deck.superelements[0], diagnostics_);
  EXPECT_EQ(diagnostics_.items().size(), 0u);
  EXPECT_LT(check.rigid_energy.maxCoeff(), 1e-13);
  const auto mass = calc_mass_properties(bars_, bars_.mass_kind(), Vector3d::Zero());
  EXPECT_NEAR(check.mass.mass, mass.mass, 1e-12 * mass.mass);
  EXPECT_LT((check.mass.cg - mass.cg).norm(), 1e-12);
  EXPECT_LT((check.mass.inertia - mass.inertia).norm(), 1e-12 * mass.inertia.norm());
  deck.superelements[0].K(2, 2) *= 1.001;
  check_superelement(deck, deck.superelements[0], diagnostics_);
  EXPECT_TRUE(diagnostics_.has("fe.superelement-grounded"));
}

}  // namespace
}  // namespace bough::fe
