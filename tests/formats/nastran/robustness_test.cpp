/// \file Damaged decks: whatever the bytes, the reader ends and reports.
#include <random>

#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

constexpr std::string_view sound_deck =
    "NASTRAN SYSTEM(442)=-1\nSOL 103\nCEND\nTITLE = robust\nSET 1 = 1 THRU 9,\n 12\nSPC = 1\nSUBCASE 1\n METHOD = 2\n"
    "BEGIN BULK\n"
    "GRDSET,,,,,,,6\n"
    "GRID*                  1                              0.              0.*G1\n*G1                   0.\n"
    "GRID    2               1.0     0.0     0.0\n"
    "GRID,101,0,1.0,10.5,,0,345\n=,*1,=,*0.2,==\n=(3)\n"
    "CBAR,1,1,1,2,0.,1.,0.\nCBEAM   2       2       1       2       0.      1.      0.      GGG     +B1\n+B1     56\n"
    "PBAR    1       1       7.175-2 9.83-6          36.8-6\n"
    "PBEAM,2,1,15.,2.,2.,0.0,25.,0.0\n,.1,.1,-0.1,.1,-0.1,-0.1,.1,-0.1\n,YES,.5,3.\n,.1,.1,-0.1,.1,-0.1,-0.1,.1,-0.1\n,"
    "1.,1.\n"
    "PBEAML,3,1,,T\n,12.,14.8,2.5,2.6,,NO,.4,6.\n,7.,1.2,2.6,,YES,.6,6.,7.8\n,5.6,2.3,,YES\n"
    "PBUSH,1,K,1.,2.,3.\n,,B,.1\nMAT1\t1\t2.+11\t\t.3\t7800.\n"
    "RBE2,9,1,123456,2,101,THRU,104\nSPC1,1,123456,1,THRU,5,EXCEPT,3\nMPC,1,1,1,1.,2,1,-1.\n,,101,1,.5\n"
    "LOAD,9,2.,1.,1,.5,5\nFORCE,1,2,,1.0E8,0.25,0.5,-1.0\n"
    "EIGRL   2                       10\n        NORM=MAX\nPARAM,INREL,0\nENDDATA\n";

TEST(Robustness, TheDeckItselfIsSound) {
  const auto deck = read_clean(sound_deck);
  EXPECT_EQ(deck.grids.size(), 7u);
  EXPECT_EQ(deck.sol, "103");
  EXPECT_EQ(deck.eigen_methods[0].norm, "MAX");
}

/// A cut deck is read up to the cut: nothing appears that the whole deck does not have.
TEST(Robustness, EveryTruncation) {
  const auto whole = read_clean(sound_deck);
  for (std::size_t n = 0; n < sound_deck.size(); ++n) {
    const auto r = read(sound_deck.substr(0, n));
    ASSERT_GE(r.deck.subcases.size(), 1u) << n;
    ASSERT_LE(r.deck.grids.size(), whole.grids.size()) << n;
    for (const auto& d : r.diagnostics.items()) ASSERT_GE(d.where.line, 0) << n;
  }
}

TEST(Robustness, RandomBytes) {
  std::mt19937 random(20240611);
  constexpr std::string_view likely = "+*=,$ \t\n\r()'\"019.-EDABGINCLUDETHRU\0\xff";
  const auto pick = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  int num_damaged = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::string text(sound_deck);
    const std::size_t num_changes = 1 + pick(8);
    for (std::size_t k = 0; k < num_changes; ++k) {
      const std::size_t at = pick(text.size());
      switch (pick(4)) {
        case 0:
          text[at] = likely[pick(likely.size())];
          break;
        case 1:
          text.insert(at, 1, likely[pick(likely.size())]);
          break;
        case 2:
          text.erase(at, 1 + pick(12));
          break;
        default:
          text.insert(at, text.substr(pick(text.size()), pick(60)));
          break;
      }
    }
    const auto r = read(text);
    ASSERT_GE(r.deck.subcases.size(), 1u);
    num_damaged += r.diagnostics.num_errors() > 0 ? 1 : 0;
  }
  EXPECT_GT(num_damaged, 500) << "the damage must be seen";
}

TEST(Robustness, PureNoise) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 200; ++trial) {
    std::string text;
    for (int i = 0; i < 3000; ++i) text += static_cast<char>(random() & 0xff);
    read(text);
    read("CEND\nBEGIN BULK\n" + text);
  }
}

TEST(Robustness, VeryLongLinesAndCards) {
  EXPECT_GT(read(std::string(1'000'000, ',')).deck.subcases.size(), 0u);
  std::string rbe2 = "RBE2,1,1,123456\n";
  for (int i = 0; i < 5000; ++i) rbe2 += "+,2,3,4,5,6,7,8,9\n";
  EXPECT_EQ(read_clean(rbe2).rbe2[0].gm.size(), 40000u);
  std::string tags;
  for (int i = 0; i < 5000; ++i) tags += "+A" + std::to_string(i) + ",1\n";
  EXPECT_EQ(read(tags).count("deck.orphan-continuation"), 5000);
}

}  // namespace
}  // namespace bough::nastran
