/// Cards and commands of responses: what each becomes, and that other readers leave them alone.
#include <gtest/gtest.h>

#include "formats/nastran/dynamic_reader.hpp"
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

constexpr const char* kDeck = R"(SOL 111
CEND
SDAMPING = 6
SET 3 = 1, 2, 5 THRU 40 EXCEPT 7, 12, 50
DISPLACEMENT(SORT2,PHASE,PUNCH) = 3
SUBCASE 4
  DLOAD = 501
  LOADSET = 502
  FREQ = 503
  OFREQ = 8
  SET 8 = .5, 20.25
  RESVEC = NO
  VELO = ALL
  SPCF = NONE
SUBCASE 5
  DLOAD = 511
  TSTEP = 504
  IC = 505
BEGIN BULK
PARAM,W3,3.
RLOAD1,511,521,.1,30.,531,,DISP
TLOAD1,513,523,541,ACCE,533
TLOAD2,514,524,.25,,.5,3.,1.25,45.
,-.1,2.
DLOAD,501,2.,.5,511,-1.5,512
DAREA,521,1,3,2.5,2,1,-1.
LSEQ,502,523,300,310
TIC,505,1,3,.1,-.2
TABLED1,531,LOG
,.1,1.,2.,2.,SKIP,SKIP,10.,3.
,ENDT
TABLED4,534,0.,1.,-5.,5.
,1.,-2.,.25,ENDT
TABDMP1,6,CRIT
,1.,.02,100.,.03,ENDT
FREQ3,503,1.,100.,LOG,5,2.
TSTEP,504,100,.01,2
,,50,.1
ENDDATA
)";

TEST(DynamicCards, Records) {
  Diagnostics diagnostics;
  const auto deck = read_dynamic_deck_text(kDeck, "d.bdf", {}, diagnostics);
  for (const auto& item : diagnostics.items()) ADD_FAILURE() << format(item);
  const auto& d = deck.dynamics;
  ASSERT_EQ(d.loads.size(), 3u);
  using records::DynamicLoad;
  EXPECT_EQ(d.loads[0].kind, DynamicLoad::Kind::Rload1);
  EXPECT_EQ(d.loads[0].excitation, DynamicLoad::Excitation::Displacement);
  EXPECT_EQ(d.loads[0].delay, .1);
  EXPECT_EQ(d.loads[0].phase_deg, 30);
  EXPECT_EQ(d.loads[0].table_a, 531);
  EXPECT_EQ(d.loads[1].delay_set, 541);
  EXPECT_EQ(d.loads[1].excitation, DynamicLoad::Excitation::Acceleration);
  EXPECT_EQ(d.loads[2].t2, 3);
  EXPECT_EQ(d.loads[2].growth, -.1);
  EXPECT_EQ(d.loads[2].power, 2);
  ASSERT_EQ(d.sums.size(), 1u);
  EXPECT_EQ(d.sums[0].terms[1], (std::pair{-1.5, 512}));
  ASSERT_EQ(d.areas.size(), 2u);
  EXPECT_EQ(d.areas[1].value, -1);
  EXPECT_EQ(d.lseq.at(0).temperature, 310);
  EXPECT_EQ(d.initial.at(0).v0, -.2);
  ASSERT_EQ(d.tables.size(), 2u);
  EXPECT_TRUE(d.tables[0].is_log_x);
  EXPECT_EQ(d.tables[0].points.size(), 3u);
  EXPECT_EQ(d.tables[1].coefficients.size(), 3u);
  EXPECT_EQ(d.damping.at(0).type, "CRIT");
  EXPECT_EQ(d.frequencies.at(0).spread, 2);
  ASSERT_EQ(d.steps.at(0).parts.size(), 2u);
  EXPECT_EQ(d.steps[0].parts[1].count, 50);
}

TEST(DynamicCards, Selections) {
  Diagnostics diagnostics;
  const auto deck = read_dynamic_deck_text(kDeck, "d.bdf", {}, diagnostics);
  ASSERT_EQ(deck.selections.size(), 2u);
  const auto& first = deck.selections.at(4);
  EXPECT_EQ(first.dload, 501);
  EXPECT_EQ(first.loadset, 502);
  EXPECT_EQ(first.frequency, 503);
  EXPECT_EQ(first.sdamping, 6);
  EXPECT_EQ(first.resvec, std::optional(false));
  EXPECT_EQ(first.sets.at(8).ranges.at(1).first, 20.25);
  const auto& displacement = first.outputs.at("DISPLACEMENT");
  EXPECT_TRUE(displacement.is_phase && displacement.is_punched && !displacement.is_all);
  EXPECT_TRUE(first.outputs.at("VELOCITY").is_all);
  EXPECT_TRUE(first.outputs.at("SPCFORCES").is_none);
  const auto& set = first.sets.at(3);
  for (const int id : {1, 2, 5, 6, 40, 50}) EXPECT_TRUE(set.contains(id)) << id;
  for (const int id : {3, 4, 7, 12, 41}) EXPECT_FALSE(set.contains(id)) << id;
  EXPECT_EQ(deck.selections.at(5).ic, 505);
  EXPECT_EQ(deck.selections.at(5).frequency, 0);
  EXPECT_EQ(deck.subcases.at(0).find_command("DLOAD").line, 7);
}

/// A reader of structures names them, and looks at nothing of them.
TEST(DynamicCards, AreLeftAloneElsewhere) {
  Diagnostics diagnostics;
  read_deck_text("SOL 111\nCEND\nDLOAD = x\nBEGIN BULK\nRLOAD1,1,x\nPARAM,W3,x\nENDDATA\n", "d.bdf", {}, diagnostics);
  EXPECT_EQ(diagnostics.num_errors(), 0);
  EXPECT_TRUE(diagnostics.has("deck.unused-card"));
  EXPECT_TRUE(diagnostics.has("deck.case-control-ignored"));
  EXPECT_TRUE(diagnostics.has("deck.unused-params"));
  Diagnostics read;
  read_dynamic_deck_text("SOL 111\nCEND\nDLOAD = x\nBEGIN BULK\nRLOAD1,1,x\nPARAM,W3,x\nENDDATA\n", "d.bdf", {}, read);
  EXPECT_TRUE(read.has("deck.case-control-value"));
  EXPECT_TRUE(read.has("deck.bad-integer"));
  EXPECT_TRUE(read.has("fe.bad-param"));
}

TEST(DynamicCards, IdsStandOnce) {
  Diagnostics diagnostics;
  read_dynamic_deck_text("BEGIN BULK\nRLOAD1,1,2,,,1.\nTLOAD2,1,2,,,0.,1.\nRLOAD1,1,3,,,1.\nENDDATA\n", "d.bdf", {},
                         diagnostics);
  EXPECT_TRUE(diagnostics.has("deck.duplicate-id"));
}

}  // namespace
}  // namespace bough::nastran
