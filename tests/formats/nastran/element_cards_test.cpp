/// \file The table of element cards against cards written by hand.
#include "formats/records/element_cards.hpp"

#include <map>

#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

using records::ElementRole;
using records::ElementView;

std::map<std::string, ElementView> list_views(const records::Deck& deck, ElementRole role) {
  std::map<std::string, ElementView> views;
  records::visit_elements(deck, {role}, [&](const ElementView& view) { views[view.card] = view; });
  return views;
}

constexpr const char* kCards =
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,9,,0.,0.,1.\n"
    "CBAR,11,21,1,2,9\nCELAS2,12,5.,3,2\nCVISC,13,23,1,4\nCQUAD4,14,24,1,2,3,4\nCONM2,15,3,,2.\nPLOTEL,16,1,3\n"
    "RBE2,31,1,126,2,3\nRBE3,32,,4,123,1.,123,1,2\nMPC,33,1,2,1.,2,2,-1.\n";

TEST(ElementCards, GridsPropertyAndEnds) {
  const auto views = list_views(read_clean(kCards), ElementRole::Element);
  ASSERT_EQ(views.size(), 5u);
  EXPECT_EQ(views.at("CBAR").id, 11);
  EXPECT_EQ(views.at("CBAR").property, 21);
  EXPECT_EQ(views.at("CBAR").orientation, 9);
  EXPECT_TRUE(views.at("CBAR").has_moments);
  EXPECT_TRUE(views.at("CELAS2").is_grounded);
  EXPECT_EQ(views.at("CELAS2").property, 0);
  EXPECT_FALSE(views.at("CELAS2").has_moments);
  EXPECT_EQ(views.at("CVISC").grids, (std::vector<int>{1, 4}));
  EXPECT_EQ(views.at("CVISC").property, 23);
  EXPECT_EQ(views.at("CQUAD4").num_corners, 4u);
  EXPECT_EQ(views.at("CONM2").grids, std::vector<int>{3});
}

TEST(ElementCards, RigidElementsEliminateComponents) {
  const auto views = list_views(read_clean(kCards), ElementRole::Rigid);
  ASSERT_EQ(views.size(), 3u);
  using Dependent = std::vector<std::pair<int, unsigned>>;
  EXPECT_EQ(views.at("RBE2").dependent, (Dependent{{2, 0b100011}, {3, 0b100011}}));
  EXPECT_TRUE(views.at("RBE2").has_moments);
  EXPECT_EQ(views.at("RBE3").dependent, (Dependent{{4, 0b111}}));
  EXPECT_EQ(views.at("RBE3").spokes, (std::vector<int>{1, 2}));
  EXPECT_EQ(views.at("MPC").dependent, (Dependent{{1, 0b10}}));
}

TEST(ElementCards, CountKeepAndClear) {
  auto deck = read_clean(kCards);
  EXPECT_EQ(records::count_elements(deck, ElementRole::Element), 5u);
  // In the order of the table: CBAR, CELAS2, CVISC, CQUAD4, CONM2, PLOTEL.
  records::keep_elements(deck, {ElementRole::Element, ElementRole::Drawn}, {1, 0, 1, 0, 0, 1});
  EXPECT_EQ(deck.beams.size(), 1u);
  EXPECT_TRUE(deck.springs.empty());
  EXPECT_EQ(deck.cvisc.size(), 1u);
  EXPECT_TRUE(deck.shells.empty());
  EXPECT_EQ(deck.plotel.size(), 1u);
  records::clear_elements(deck, ElementRole::Element);
  EXPECT_EQ(records::count_elements(deck, ElementRole::Element), 0u);
  EXPECT_EQ(deck.plotel.size(), 1u);
  EXPECT_EQ(deck.rbe2.size(), 1u);
}

}  // namespace
}  // namespace bough::nastran
