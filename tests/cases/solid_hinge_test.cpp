// Grids of solids have no rotation: a hinge there is an error that says so, through RBE2 it turns as the end face does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "formats/nastran/reader.hpp"
#include "tests/cases/support/example.hpp"

namespace bough::test {
namespace {

constexpr int kCells = 6, kSpider = 100;

/// A bar of kCells x 1 x 1 CHEXA along x, clamped at x = 0; grid kSpider amid the end face, tied to it by an RBE2.
records::Deck make_bar() {
  const std::string path = ::testing::TempDir() + "solid_hinge.bdf";
  std::ofstream file(path);
  file << "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nMAT1,1,7.+10,,0.3,2700.\nPSOLID,1,1\n";
  const auto id = [](int i, int corner) { return 1 + 4 * i + corner; };
  const double y[] = {0, 0.1, 0.1, 0}, z[] = {0, 0, 0.1, 0.1};
  for (int i = 0; i <= kCells; ++i)
    for (int c = 0; c < 4; ++c) file << "GRID," << id(i, c) << ",," << 0.2 * i << "," << y[c] << "," << z[c] << "\n";
  for (int i = 0; i < kCells; ++i) {
    file << "CHEXA," << i + 1 << ",1";
    for (int c = 0; c < 6; ++c) file << "," << id(i + c / 4, c % 4);
    file << "\n+," << id(i + 1, 2) << "," << id(i + 1, 3) << "\n";
  }
  file << "GRID," << kSpider << ",," << 0.2 * kCells << ",0.05,0.05\n";
  file << "RBE2,99," << kSpider << ",123456";
  for (int c = 0; c < 4; ++c) file << "," << id(kCells, c);
  file << "\nSPC1,1,123456,1,2,3,4\nENDDATA\n";
  file.close();
  Diagnostics diagnostics;
  auto deck = nastran::read_deck(path, {}, diagnostics);
  diagnostics.throw_if_errors();
  return deck;
}

Example make_tip_on(records::BodyFrame frame, int node) {
  records::BodySpec spec;
  spec.name = "bar";
  spec.num_modes = 4;
  spec.frame = frame;
  spec.interface_nodes = {4 * kCells - 3, kSpider};
  spec.output_nodes = spec.interface_nodes;
  Example example;
  example.flex = {{"bar.h5", reduce(make_bar(), spec)}};
  records::BodyRecord bar, tip;
  bar.name = "bar";
  bar.file = "bar.h5";
  tip.name = "tip";
  tip.mass = 1;
  tip.inertia = Eigen::Vector3d(0.1, 0.1, 0.1).asDiagonal();
  example.spec.bodies = {bar, tip};
  records::HingeRecord pin;
  pin.name = "pin";
  pin.type = records::HingeType::Revolute;
  pin.parent = "bar";
  pin.parent_node = node;
  pin.child = "tip";
  example.spec.hinges = {pin};
  return example;
}

TEST(SolidHinge, GridsOfSolidsHaveNoRotation) {
  for (const auto frame : {records::BodyFrame::Fixed, records::BodyFrame::MeanAxes}) {
    const Example example = make_tip_on(frame, 4 * kCells - 3);
    const auto& flex = example.flex.at("bar.h5");
    EXPECT_EQ(flex.phi[0].bottomRows<3>().cwiseAbs().maxCoeff(), 0);  // nor that of the body's frame
    EXPECT_GT(flex.phi[1].bottomRows<3>().cwiseAbs().maxCoeff(), 0);
    EXPECT_EQ(flex.locators.size(), 9u);
    EXPECT_LT(flex.find_locator(4 * kCells - 3, 4), 0);
    EXPECT_GE(flex.find_locator(kSpider, 6), 0);
    try {
      example.build();
      FAIL() << "accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.items().back().id, "system.node-without-rotation");
      EXPECT_THAT(error.items().back().advice, ::testing::HasSubstr("RBE2 or RBE3"));
    }
  }
}

TEST(SolidHinge, ThroughRbe2ItTurnsAsTheFaceDoes) {
  for (const auto frame : {records::BodyFrame::Fixed, records::BodyFrame::MeanAxes})
    EXPECT_NO_THROW(make_tip_on(frame, kSpider).build());
}

}  // namespace
}  // namespace bough::test
