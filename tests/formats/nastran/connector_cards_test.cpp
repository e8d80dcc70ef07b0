/// CFAST, CWELD, CPYRAM, MATTi and TABLEMi: read, written and read again.
#include <gtest/gtest.h>

#include "formats/nastran/writer.hpp"
#include "formats/records/element_cards.hpp"
#include "tests/formats/nastran/card_samples.hpp"
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

constexpr const char* cards =
    "CFAST,600,601,PROP,40,41,,1,2\nCFAST,616,601,ELEM,42,43,,,,+\n+,.25,.5,.125\nPFAST,601,.006,,,1.+6,2.+6,3.+6,10.,+"
    "\n+,20.,30.,.125,.02\n"
    "CWELD,602,603,,PARTPAT\n,40,41\n,.25,.5,.125\nCWELD,604,603,1,GRIDID,,,QT\n,1,2,3,4\n,5,6,7\n"
    "CWELD,605,603,,ALIGN,1,2\nPWELD,603,1,.006,,,,,SPOT\n,.25,4.\nCPYRAM,606,607,1,2,3,4,5\n"
    "MATT1,608,609\nMATT2,610,,609\nMATT8,611,609,,,,,,,+\n+,612,,,,,,,613\nMATT9,614,609\n"
    "TABLEM1,609\n,0.,2.+11,100.,1.+11,ENDT\nTABLEM2,612,10.\n,0.,1.,100.,1.5,ENDT\nTABLEM3,613,10.,2.\n"
    ",0.,1.,100.,1.5,ENDT\nTABLEM4,615,0.,100.,0.,200.\n,1.,.5,ENDT\n";
const CardSample sample(cards);

TEST(ConnectorCards, AreReadAndWritten) {
  auto deck = read_clean(cards);
  for (const bool is_again : {false, true}) {
    ASSERT_EQ(deck.special.cfast.size(), 2u);
    const auto& e = deck.special.cfast[0];
    EXPECT_EQ(std::tuple(e.id, e.pid, e.by_elements, e.ida, e.idb, e.gs, e.ga, e.gb),
              std::tuple(600, 601, false, 40, 41, 0, 1, 2));
    EXPECT_EQ(deck.special.cfast[1].xs, Eigen::Vector3d(.25, .5, .125));
    const auto& p = deck.special.pfast.at(0);
    EXPECT_EQ(std::tuple(p.id, p.d, p.mcid, p.mflag, p.mass, p.ge), std::tuple(601, .006, -1, 0, .125, .02));
    EXPECT_EQ(p.kt, (std::array<double, 3>{1e6, 2e6, 3e6}));
    EXPECT_EQ(p.kr, (std::array<double, 3>{10, 20, 30}));
    ASSERT_EQ(deck.special.cweld.size(), 3u);
    EXPECT_EQ(deck.special.cweld[0].format, "PARTPAT");
    EXPECT_EQ(deck.special.cweld[0].xs, Eigen::Vector3d(.25, .5, .125));
    EXPECT_EQ(deck.special.cweld[1].grids_a, (std::vector<int>{1, 2, 3, 4}));
    EXPECT_EQ(deck.special.cweld[1].grids_b, (std::vector<int>{5, 6, 7}));
    EXPECT_EQ(deck.special.cweld[1].types, "QT");
    const auto& w = deck.special.pweld.at(0);
    EXPECT_EQ(std::tuple(w.mid, w.d, w.is_spot, w.ld_min, w.ld_max), std::tuple(1, .006, true, .25, 4.));
    EXPECT_EQ(deck.solids.at(0).corners.size(), 5u);
    const auto& t = deck.temperatures;
    ASSERT_EQ(t.materials.size(), 4u);
    EXPECT_EQ(t.materials[2].tables.at(0), 609);
    EXPECT_EQ(t.materials[2].tables.at(7), 612);
    EXPECT_EQ(t.materials[2].tables.at(14), 613);
    ASSERT_EQ(t.tables.size(), 4u);
    EXPECT_EQ(records::evaluate(t.tables[0], 50), 1.5e11);
    EXPECT_EQ(records::evaluate(t.tables[1], 60), 1.25);
    EXPECT_EQ(records::evaluate(t.tables[3], 100), 1.5);
    if (is_again) break;
    Diagnostics diagnostics;
    deck = read_clean(write_deck(deck, {}, diagnostics));
    EXPECT_EQ(diagnostics.num_errors(), 0);
  }
}

TEST(ConnectorCards, AreAnErrorWithoutADiameterOrShells) {
  EXPECT_NE(read("PFAST,601,-1.,,,1.+6\n").get_messages().find("a positive diameter"), std::string::npos);
  EXPECT_NE(read("CFAST,600,601,PROP,40\n").get_messages().find("IDB"), std::string::npos);
  EXPECT_NE(read("MATT1,608,,,,,,7\n").get_messages().find("TREF"), std::string::npos);
}

}  // namespace
}  // namespace bough::nastran
