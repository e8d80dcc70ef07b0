/// No element card is dropped between the reader and the model.
#include <gtest/gtest.h>

#include "fe/model/model.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::fe {
namespace {

TEST(Unmodelled, CardsWithoutAnElementAreAnError) {
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(
      "GRID,1\nGRID,2,,1.\nGRID,3,,1.,1.\nGRID,4,,0.,1.\nCSHEAR,1,1,1,2,3,4\nCSHEAR,2,1,1,2,3,4\nCTRIA6,3,1,1,2,3\n"
      "CBUSH1D,1,1,1,2\n",
      "deck.bdf", {}, diagnostics);
  const auto make_none = [](const records::Deck&, const NodeTable&, Diagnostics&) { return ElementList{}; };
  EXPECT_THROW(build_model(deck, {}, make_none, diagnostics), InputError);
  std::vector<std::string> found;
  for (const auto& item : diagnostics.items())
    if (item.id == "fe.not-modelled") found.push_back(item.what);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[1], "CSHEAR is read but there is no element for it (2 cards, the first here)");
}

}  // namespace
}  // namespace bough::fe
