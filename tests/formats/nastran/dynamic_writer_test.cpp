/// \file Cards and commands of responses, complex modes, rotors and superelements: read -> write -> read gives equal
/// records.
#include <algorithm>
#include <map>

#include "formats/nastran/detail/dynamic_cards.hpp"
#include "formats/nastran/whole_deck.hpp"
#include "tests/formats/nastran/compare_decks.hpp"
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

constexpr const char* kControl = R"(SOL 111
CEND
SDAMPING = 6
AUTOSPC = NO
METHOD = 1
K2PP = 1.25*KP, KQ
SET 3 = 1, 2, 5 THRU 40 EXCEPT 7, 12, 50, 101, 102, 103, 104, 105, 106, 107, 108, 109, 110,
  111, 112, 113
DISPLACEMENT(SORT2,PHASE,PUNCH) = 3
SUBCASE 4
  LABEL = shaken
  DLOAD = 501
  LOADSET = 502
  FREQ = 503
  OFREQ = 8
  SET 8 = .5, 20.25, .333333333333333
  RESVEC = NO
  VELO(PLOT) = ALL
  SPCF = NONE
  RANDOM = 601
  RCROSS = 602
  MEFFMASS(GRID=1) = YES
SUBCASE 5
  DLOAD = 511
  TSTEPNL = 505
  IC = 506
  CMETHOD = 701
  TFL = 702
  RGYRO = 801
  RMETHOD = 805
  SET 9 = ALL
SUBCOM 6
  SUBTITLE = the difference
  SUBSEQ = 1., -1.
  DISP = ALL
REPCASE 7
  STRESS(VONMISES) = 3
BEGIN BULK
GRID,1
GRID,2,,1.
SPOINT,51
EIGRL,1,,,3
PARAM,W3,3.
DMIG,KP,0,6,2,0
DMIG,KP,1,1,,1,1,5.
DMIG,KQ,0,6,2,0
DMIG,KQ,1,2,,1,2,7.
)";

constexpr const char* kCards = R"(RLOAD1,511,521,.333333333333333333,30.,531,,DISP
RLOAD1,512,521,541,542,1.5,532,ACCE
RLOAD2,515,521,,,2.5,-12.345678901234567
TLOAD1,513,523,541,ACCE,533
TLOAD1,516,523,,,1.25
TLOAD2,514,524,.25,,.5,3.,1.25,45.
,-.1,2.
DLOAD,501,2.,.5,511,-1.23456789012345-7,512,1.,513,1.,514
DAREA,521,1,3,2.5,2,1,-1.
DAREA,521,51,,123456789.123
DELAY,541,1,3,.001
DPHASE,542,1,3,45.,2,2,90.
LSEQ,502,523,300,310
TIC,506,1,3,.1,-.2
TABLED1,531,LOG
,.1,1.,2.,2.,SKIP,SKIP,10.,3.
,ENDT
TABLED1,532,LINEAR,LOG,1
,3.,1.,2.,2.,2.,.333333333333333333,1.,3.
,ENDT
TABLED2,533,.125
,0.,1.,.1,2.,ENDT
TABLED3,535,1.,2.
,0.,1.,.1,2.,ENDT
TABLED4,534,0.,1.,-5.,5.
,1.,-2.,.25,ENDT
TABDMP1,6,CRIT
,1.,.02,100.,.03,ENDT
FREQ,503,.1,20.25,.333333333333333333
FREQ1,503,1.,.5,10
FREQ2,503,1.,100.,4
FREQ3,503,1.,100.,LOG,5,2.
FREQ4,503,,100.,.05,5
FREQ5,503,1.,100.,.9,1.,1.1
TSTEP,504,100,.01,2
,,50,.1
TSTEPNL,505,10,.0123456789012345,0
USET,U6,1,123,2,3
USET1,U6,2,1,THRU,2
RVDOF,1,4,51
RVDOF1,5,1,THRU,2
RANDPS,601,4,4,1.25,,611
RANDPS,601,4,5,1.5,-.5
RANDT1,601,10,0.,.5
RCROSS,602,DISP,1,3,,2,,9
TABRND1,611,LOG,LOG,1
,1.,.01,100.,.02,ENDT
TABRNDG,612,2,.25,1.5
PELAST,613,531,532
PDAMPT,614,533
PBUSHT,615,K,531,,532,,,533
,,B,,534
,,GE,535
EIGC,701,INV,POINT,1,3,,4
,-1.,10.,1.,30.,,,2
EIGC,703,LAN,,,,,5
EPOINT,901,902
TF,702,901,,1.,2.,3.
,1,3,.5,.25,.125
,2,1,-1.,.333333333333333333
ROTORG,10,1,THRU,9,BY,2
ROTORG,10,20,THRU,25,EXCEPT,22
ROTORG,11,30,31
RSPINR,10,1,2,RPM,1.25
,.01,.1,.002,5.,6.
RSPINR,11,1,2,FREQ,806
RGYRO,801,ASYNC,10,RPM,,,1234.5
RGYRO,802,SYNC,10,FREQ,1.,90.
RGYRO,803,SYNC,10,RPM,,,804
RSPEED,804,100.,50.,7
DDVAL,806,1.,2.,THRU,3.,BY,.25,9.
ROTORD,805,1000.,100.,5,FIX,-1.
,
,1,10,1.,5,2.,3.
,2,11,-1.5
UNBALNC,807,.001,1,0.,1.,0.
,.05,30.,.1,1.,100.
UNBALNC,808,531,2,1.,0.,0.
,532,,533
)";

WholeDeck read_whole(const std::string& text, bool has_no_warning = true) {
  Diagnostics diagnostics;
  auto deck = read_whole_deck_text(text, "d.bdf", {}, diagnostics);
  std::string messages;
  for (const auto& item : diagnostics.items()) messages += format(item) + "\n";
  EXPECT_EQ(diagnostics.num_errors(), 0) << messages << text;
  if (has_no_warning) EXPECT_EQ(diagnostics.num_warnings(), 0) << messages << text;
  return deck;
}

std::string write_whole(const WholeDeck& deck, FieldFormat format, std::string_view left_out = "") {
  Diagnostics diagnostics;
  auto text = write_deck(deck, {format}, diagnostics);
  EXPECT_EQ(diagnostics.has("deck.left-out"), !left_out.empty());
  for (const auto& item : diagnostics.items())
    EXPECT_NE(item.what.find(left_out), std::string::npos) << bough::format(item);
  return text;
}

/// Free fields keep each number to the last bit, large ones ten digits at least.
void expect_same_again(const WholeDeck& deck, bool has_no_warning = true) {
  for (const auto& [format, tolerance] : {std::pair(FieldFormat::Free, 0.0), std::pair(FieldFormat::Large, 1e-10)}) {
    Diagnostics diagnostics;
    const auto text = has_no_warning ? write_whole(deck, format) : write_deck(deck, {format}, diagnostics);
    EXPECT_EQ(diagnostics.num_errors(), 0);
    SCOPED_TRACE(text);
    expect_equal_dynamics(deck, read_whole(text, has_no_warning), tolerance);
  }
}

TEST(WrittenDynamics, EveryCardThatIsRead) {
  const auto deck = read_whole(std::string(kControl) + kCards + "ENDDATA\n");
  for (const auto* table :
       {&detail::get_dynamic_parsers(), &detail::get_complex_parsers(), &detail::get_rotor_parsers()})
    for (const auto& [name, row] : *table) {
      EXPECT_EQ(deck.card_counts.count(std::string(name)), 1u) << name << " is read but not in this test";
      EXPECT_TRUE(row.write != nullptr || row.written_as != nullptr) << name;
    }
  EXPECT_EQ(deck.combinations.size(), 2u);
  EXPECT_EQ(deck.selections.at(4).random, 601);
  const auto text = write_whole(deck, FieldFormat::Large);
  for (const char* request : {"DISPLACEMENT(SORT2,PHASE,PUNCH) = 3", "VELOCITY(PLOT) = ALL", "STRESS(VONMISES) = 3"})
    EXPECT_NE(text.find(request), std::string::npos) << request << "\n" << text;
  expect_same_again(deck);
}

/// Each card by itself: a card that reads a field of another one's record would be right above.
TEST(WrittenDynamics, CardAfterCard) {
  std::string lines(kCards), card;
  int num_cards = 0;
  for (std::size_t at = 0; at < lines.size();) {
    const auto end = lines.find('\n', at) + 1;
    card += lines.substr(at, end - at);
    at = end;
    if (at < lines.size() && lines[at] == ',') continue;
    SCOPED_TRACE(card);
    expect_same_again(read_whole("BEGIN BULK\n" + card + "ENDDATA\n"));
    card.clear();
    ++num_cards;
  }
  EXPECT_GT(num_cards, 50);
}

TEST(WrittenDynamics, OwnAndSharedModels) {
  int num_decks = 0;
  for (const auto& path : list_decks()) {
    SCOPED_TRACE(path);
    Diagnostics diagnostics;
    ReadOptions options;
    for (const auto& card : read_whole_deck(path, options, diagnostics).unused)
      options.ignore_cards.push_back(card.name);
    diagnostics = {};
    const auto deck = read_whole_deck(path, options, diagnostics);
    if (diagnostics.num_errors() > 0) continue;
    ++num_decks;
    expect_same_again(deck, false);
  }
  EXPECT_GT(num_decks, 5);
}

TEST(WrittenDynamics, SubcasesOfSymmetry) {
  const std::string control =
      "SOL 101\nCEND\nSYM 1\nLOAD = 1\nSYM 2\nLOAD = 2\nSYMCOM 3\nSYMSEQ = .5, -.5\nLABEL = both\nSUBCASE 9\nLOAD = "
      "1\n";
  const auto deck = read_whole(control + "BEGIN BULK\nGRID,1\nFORCE,1,1,,1.,1.\nFORCE,2,1,,1.,1.\nENDDATA\n");
  ASSERT_EQ(deck.combinations.size(), 1u);
  expect_same_again(deck);
}

TEST(WrittenDynamics, FieldsThatAreNotKeptAreNamed) {
  const auto deck = read_whole("BEGIN BULK\nTSTEPNL,5,10,.1,1,AUTO,2\nENDDATA\n");
  write_whole(deck, FieldFormat::Large, "fields of TSTEPNL");
  const auto rotors = read_whole("BEGIN BULK\nROTORD,1,1000.,100.,5,FIX\n,\n,1,10,1.,5,2.,3.,901\nENDDATA\n");
  ASSERT_TRUE(rotors.dynamics.rotors.sweeps.at(0).rotors.at(0).has_stress);
  write_whole(rotors, FieldFormat::Large, "the set of RFORCE on ROTORD");
}

constexpr const char* kAssembly = R"(ASSIGN INPUTT4='parts/panel.op4',UNIT=101
SOL 103
CEND
METHOD=1
EXTSEOUT(ASMBULK,EXTBULK,EXTID=7,MATOP4=30)
SUBCASE 1
SET 101 = 1 THRU 5
DISP = 101
SUBCASE 2
SUPER=102
SPC=4
SUBCASE 3
SET 55 = 101, 102
SUPER=55
METHOD=2
BEGIN BULK
EIGRL,1,,,3
SEBULK,101,EXTOP4,,MANUAL,.001,,101
SEBULK,102,PRIMARY
SECONCT,101,0,.333333333333333,NO,,,,,+
+,3,13,4,14,201,301
SEBNDRY,102,0,3,4
SELOAD,5,101,1102
GRID,13
GRID,14,,1.
SPOINT,301
BEGIN SUPER=101
EXTRN,3,123456,4,126,201,0
GRID,3
GRID,4,,1.
SPOINT,201
DTI,TUG1,2,,,,,,,+
+,TYPE,ID,COMP,ROW,TYPE,ID,COMP,ROW,+
+,1,3,6,1,2,202,1,7,+
+,ENDREC
DTI,SELOAD,1,1102,2
BEGIN SUPER=102
EIGRL,2,,,3
GRID,3
GRID,4,,1.
CBAR,1,1,3,4,0.,1.,0.
PBAR,1,1,.1,.1,.1,.1
MAT1,1,1.+9,,.3
SPC1,4,1,3
ENDDATA
)";

TEST(WrittenDynamics, SuperelementsWithTheirSections) {
  const auto deck = read_whole(kAssembly);
  ASSERT_EQ(deck.super.sections.size(), 2u);
  ASSERT_EQ(deck.super.sections[1].deck->subcases.size(), 2u);
  expect_same_again(deck);
}

}  // namespace
}  // namespace bough::nastran
