/// \file Executive and case control, bulk-only fragments, ENDDATA, INCLUDE.
#include <filesystem>
#include <fstream>

#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

namespace fs = std::filesystem;

TEST(Control, ExecutiveJunkAndSolution) {
  const auto solution = [](const std::string& head) { return read_clean(head + "CEND\nBEGIN BULK\nENDDATA\n").sol; };
  EXPECT_EQ(values(solution("INIT MASTER(S)\nNASTRAN SYSTEM(442)=-1,SYSTEM(319)=1\nID a,b\nSOL 103\nTIME 10\n"),
                   solution("ASSIGN OUTPUT2='x.op2',UNIT=12\nsol semodes $ modes\n"), solution("APP DISP\nSOL 3,0\n")),
            values("103", "SEMODES", "3"));
  EXPECT_EQ(solution("DIAG 8\n"), "");
}

TEST(Control, ValuesAboveTheFirstSubcaseAreInherited) {
  const auto deck = read_clean(
      "SOL 105\nCEND\nTITLE = Column, pinned\nSUBT = base\nSPC = 3\nMPC=7\nECHO = NONE\nDISP(PLOT,PUNCH) = ALL\n"
      "SUBCASE 1\n  LABEL = push\n  LOAD = 4\n"
      "SUBCASE=2\n  METHOD(STRUCTURE) = 5\n  STATSUB(BUCKLING) = 1\n  SPC = 9\n  SUBTITLE = buckling\n"
      "BEGIN BULK\nENDDATA\n");
  ASSERT_EQ(deck.subcases.size(), 2u);
  const auto &a = deck.subcases[0], &b = deck.subcases[1];
  EXPECT_EQ(values(a.id, a.title, a.subtitle, a.label, a.spc, a.mpc, a.load, a.method),
            values(1, "Column, pinned", "base", "push", 3, 7, 4, 0));
  EXPECT_EQ(values(b.id, b.spc, b.load, b.method, b.statsub, b.subtitle, b.title),
            values(2, 9, 0, 5, 1, "buckling", "Column, pinned"));
}

TEST(Control, WithoutSubcaseThereIsOne) {
  const auto deck = read_clean("SOL 101\nCEND\nLOAD 12\nSPC=2\nBEGIN BULK\n");
  ASSERT_EQ(deck.subcases.size(), 1u);
  EXPECT_EQ(deck.subcases[0].id, 0);
  EXPECT_EQ(deck.subcases[0].load, 12);
}

TEST(Control, SetsWrapAndPlotSectionsAreIgnored) {
  const auto deck = read_clean(
      "CEND\nSET 80 = 1 THRU 5,\n 7, 9,\n LOAD, 12\nLOAD = 3\nPARAM,WTMASS,.00259\n"
      "OUTPUT(PLOT)\nSET 1 = ALL\nLABEL = no\nMAXIMUM DEFORMATION 3.\nOUTPUT (XYOUT)\nXYPLOT VG / 1(G,F)\nTCURVE = x\n"
      "BEGIN BULK\n");
  EXPECT_EQ(deck.subcases[0].load, 3);
  EXPECT_EQ(deck.subcases[0].label, "");
  ASSERT_NE(deck.find_param("WTMASS"), nullptr);
  EXPECT_EQ(deck.find_param("WTMASS")->value, ".00259");
}

TEST(Control, PartsWithSymmetryAreSubcasesAndTheirCombinationIsNone) {
  const auto r = read(
      "CEND\nSYM 1\nSPC = 11\nLOAD = 12\nSYM 2\nSPC = 21\nLOAD = 22\nSYMCOM 3\nSYMSEQ 1.0, -1.0\nLOAD = 7\n"
      "BEGIN BULK\n");
  ASSERT_EQ(r.deck.subcases.size(), 2u);
  EXPECT_EQ(values(r.deck.subcases[0].id, r.deck.subcases[0].spc, r.deck.subcases[0].load), values(1, 11, 12));
  EXPECT_EQ(values(r.deck.subcases[1].spc, r.deck.subcases[1].load), values(21, 22));
  ASSERT_EQ(r.count("deck.case-control-ignored"), 1);
  EXPECT_NE(r.find("deck.case-control-ignored")->what.find("SYMCOM"), std::string::npos);
}

// AUTOSPC of the case control stands above the PARAM, without a value it says YES, and EPS is EPZERO.
TEST(Control, AutospcStandsAboveTheParam) {
  const auto find = [](const std::string& command) {
    const auto r = read("CEND\n" + command + "\nBEGIN BULK\nPARAM,AUTOSPC,NO\n");
    EXPECT_EQ(r.count("deck.case-control-ignored"), 0) << r.get_messages();
    return r.deck;
  };
  EXPECT_EQ(values(find("SPC = 1").find_param("AUTOSPC")->value, find("AUTOSPC = YES").find_param("AUTOSPC")->value,
                   find("AUTOSPC").find_param("AUTOSPC")->value),
            values("NO", "YES", "YES"));
  const auto deck = find("AUTOSPC(NOPRINT, SID=100, EPS=1.E-6, SINGLE) = YES");
  EXPECT_EQ(values(deck.find_param("AUTOSPC")->value, deck.find_param("EPZERO")->value,
                   read("CEND\nAUTOSPC = PERHAPS\nBEGIN BULK\n").count("deck.case-control-value")),
            values("YES", "1.E-6", 1));
}

TEST(Control, WhatIsNotRecognizedIsOneNote) {
  const auto r = read("CEND\nFMETHOD = 3\nSPC = 1\nDSAPRT = 4\nFMETHOD = 5\nBEGIN BULK\n");
  ASSERT_EQ(r.count("deck.case-control-ignored"), 1);
  EXPECT_EQ(r.find("deck.case-control-ignored")->severity, Severity::Note);
  EXPECT_EQ(r.find("deck.case-control-ignored")->where.line, 2);
  EXPECT_NE(r.find("deck.case-control-ignored")->what.find("FMETHOD"), std::string::npos);
}

TEST(Control, MisspelledAndUnusedCommands) {
  const auto r = read("SOL 103\nCEND\nRESVEC = YES\nMETOD = 3\nMODTRAK = 4\nMPCC = 2\nBEGIN BULK\n");
  ASSERT_EQ(r.count("deck.unknown-case-control"), 2) << r.get_messages();
  EXPECT_EQ(values(r.find("deck.unknown-case-control")->where.line, r.find("deck.unknown-case-control")->advice,
                   r.find("deck.case-control-ignored")->what),
            values(4, "did you mean METHOD", "case control not used: RESVEC (line 3), MODTRAK (line 5)"));
}

TEST(Control, PreloadAndScaledLoad) {
  const auto find = [](const std::string& sol, const std::string& word) {
    const auto deck =
        read_clean("SOL " + sol + "\nCEND\nSUBCASE 1\nLOAD = 1\nSUBCASE 2\n" + word + " = 1\nBEGIN BULK\n");
    EXPECT_TRUE(deck.unused.empty());
    EXPECT_EQ(deck.subcases[0].preload, 0);
    EXPECT_EQ(deck.subcases[1].preload_at.line, deck.subcases[1].preload == 0 ? 0 : 6);
    return std::pair(deck.subcases[1].preload, deck.subcases[1].statsub);
  };
  EXPECT_EQ(values(find("103", "STATSUB"), find("103", "STATSUB(PRELOAD)"), find("105", "STATSUB(PRELOAD)")),
            values(std::pair(1, 1), std::pair(1, 0), std::pair(1, 0)));
  EXPECT_EQ(values(find("105", "STATSUB"), find("105", "STATSUB(BUCKLING)"), find("SEBUCKL", "STATSUB")),
            values(std::pair(0, 1), std::pair(0, 1), std::pair(0, 1)));
}

TEST(Params, WhatIsNotUsedIsOneNoteAndWhatNobodyKnowsAWarning) {
  const auto r = read(
      "CEND\nPARAM,POST,-1\nBEGIN BULK\nPARAM,WTMAS,.1\nPARAM,K6R0T,1.\nPARAM,GRDPNT,0\nPARAM,WTMASS,2.\n"
      "PARAM,XYZZYQ,1\nPARAM,MARCPOS,1\nPARAM,FCTC3,1.\nPARAM,POST,-1\n");
  ASSERT_EQ(r.count("deck.unknown-param"), 3) << r.get_messages();
  EXPECT_EQ(r.find("deck.unknown-param")->where.line, 4);
  EXPECT_EQ(r.find("deck.unknown-param")->advice, "did you mean WTMASS");
  ASSERT_EQ(r.count("deck.unused-params"), 1);
  EXPECT_EQ(r.find("deck.unused-params")->what,
            "PARAM not used: POST (line 2), GRDPNT (line 6, by check, --f06 and --op2 only), MARCPOS (line 9), "
            "FCTC3 (line 10)");
}

TEST(Control, BadValues) {
  const auto r = read("CEND\nSPC = all\nSUBCASE x\nSUBCASE 1\nSUBCASE 1\nBEGIN BULK\n");
  EXPECT_EQ(r.count("deck.case-control-value"), 3);
  EXPECT_EQ(r.find("deck.case-control-value")->where.line, 2);
}

// A slip in brackets took STATSUB(PRELOD) for the load of a buckling subcase.
TEST(Control, WordsInBracketsAreThoseOfTheCommand) {
  const auto r =
      read("SOL 103\nCEND\nSTATSUB(PRELOD) = 1\nTEMP(LAOD) = 2\nMETHOD(FLIUD) = 3\nTEMPERATURE(XYZ) = 4\nBEGIN BULK\n");
  ASSERT_EQ(r.count("deck.case-control-value"), 4) << r.get_messages();
  EXPECT_EQ(values(r.find("deck.case-control-value")->where.line, r.find("deck.case-control-value")->advice,
                   read_clean("CEND\nSTATSUB(PREL) = 1\nBEGIN BULK\n").subcases[0].preload),
            values(3, "did you mean PRELOAD", 1));
  EXPECT_EQ(values(read_clean("CEND\nTEMP(BOTH) = 5\nMETHOD(STRUC) = 6\nBEGIN BULK\n").subcases[0].temperature,
                   read_clean("CEND\nMETHOD(FLUID) = 6\nBEGIN BULK\n").subcases[0].method),
            values(5, 0));
}

TEST(Control, ALoadThatIsNotReadIsAWarning) {
  const auto r = read("CEND\nDEFORM = 4\nBEGIN BULK\n");
  EXPECT_EQ(r.count("deck.unused-load"), 1);
  EXPECT_EQ(r.count("deck.case-control-ignored"), 0);
}

TEST(Control, OtherKindsOfText) {
  EXPECT_EQ(read_clean("CEND\n\fBEGIN BULK\n\f\nGRID,1\n \x01 \nGRID,2\x1a\n").grids.size(), 2u);
  std::string wide;
  for (const char c : std::string("CEND\nBEGIN BULK\nGRID,1\n")) wide += std::string(1, c) + '\0';
  for (const std::string& text : {wide, "\xff\xfe" + wide, std::string("CEND\rBEGIN BULK\rGRID,1\r")}) {
    const auto r = read(text);
    EXPECT_EQ(r.count("deck.text-format"), 1);
    EXPECT_LT(r.get_messages().size(), 400u) << r.get_messages();
  }
}

TEST(Control, FragmentsAndDecksWithoutExecutive) {
  EXPECT_EQ(read_clean("GRID,1\nGRID,2\n").grids.size(), 2u);
  const auto deck = read_clean("SOL 103\nSPC = 4\nBEGIN BULK\nGRID,1\n");
  EXPECT_EQ(values(deck.sol, deck.subcases[0].spc, read_clean("").grids.size()), values("103", 4, 0u));
}

TEST(Control, TextAfterEnddataIsIgnored) {
  EXPECT_EQ(read_clean("GRID,1\nENDDATA 2cb29386\nGRID,2\nnonsense\nINCLUDE 'nowhere'\n").grids.size(), 1u);
}

TEST(Control, MissingBeginBulkAndSuperelements) {
  EXPECT_NE(read("SOL 101\nCEND\nSPC=1\nGRID,1\n").find("deck.no-begin-bulk"), nullptr);
  const auto r = read("CEND\nBEGIN BULK\nGRID,1\nBEGIN AUXMODEL=1\nGRID,1,,5.\n");
  ASSERT_NE(r.find("deck.unsupported-section"), nullptr);
  EXPECT_EQ(r.find("deck.unsupported-section")->where.line, 4);
  EXPECT_EQ(r.diagnostics.num_errors(), 1) << r.get_messages();
}

/// A folder of its own for each test, removed with it.
class Include : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("bough_include_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "parts" / "deep");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  Read read_file(const std::string& name) const {
    Read r;
    r.deck = read_deck((folder_ / name).string(), {}, r.diagnostics);
    return r;
  }
  fs::path folder_;
};

TEST_F(Include, NestedRelativeSplitOverLines) {
  write("main.bdf",
        "CEND\nINCLUDE 'case.inc'\nBEGIN BULK\nGRID,1\nInclude 'parts/\n   a.bdf' $ the rest\nGRID,4\nENDDATA\n");
  write("case.inc", "SPC = 8\n");
  write("parts/a.bdf", "GRID,2\nINCLUDE \"deep\\b.bdf\"\n");
  write("parts/deep/b.bdf", "GRID,3,,1.\nGRID,x\n");
  const auto r = read_file("main.bdf");
  ASSERT_EQ(r.deck.grids.size(), 4u) << r.get_messages();
  for (int i = 0; i < 4; ++i) EXPECT_EQ(r.deck.grids[static_cast<std::size_t>(i)].id, i + 1);
  EXPECT_EQ(r.deck.subcases[0].spc, 8);
  ASSERT_EQ(r.deck.files.size(), 4u);
  ASSERT_EQ(r.diagnostics.num_errors(), 1);
  EXPECT_EQ(values(fs::path(r.diagnostics.items()[0].where.file).filename(), r.diagnostics.items()[0].where.line,
                   r.deck.locate(r.deck.grids[3].at).line),
            values("b.bdf", 2, 7));
}

TEST_F(Include, CircleIsAnErrorThatNamesTheChain) {
  write("main.bdf", "GRID,1\nINCLUDE 'a.bdf'\nGRID,9\n");
  write("a.bdf", "GRID,2\nINCLUDE 'b.bdf'\n");
  write("b.bdf", "GRID,3\nINCLUDE 'a.bdf'\n");
  const auto r = read_file("main.bdf");
  ASSERT_EQ(r.diagnostics.num_errors(), 1) << r.get_messages();
  const auto* d = r.find("deck.include-cycle");
  ASSERT_NE(d, nullptr);
  EXPECT_NE(d->what.find("a.bdf -> b.bdf -> a.bdf"), std::string::npos) << d->what;
  EXPECT_EQ(values(fs::path(d->where.file).filename(), d->where.line, r.deck.grids.size()), values("b.bdf", 2, 4u));
}

TEST_F(Include, MissingFilesAreAllReported) {
  write("main.bdf", "INCLUDE 'x.bdf'\nGRID,1\nINCLUDE y.bdf\nINCLUDE\n");
  const auto r = read_file("main.bdf");
  EXPECT_EQ(r.count("deck.include-missing"), 2) << r.get_messages();
  EXPECT_EQ(r.count("deck.include-syntax"), 1);
  EXPECT_EQ(r.deck.grids.size(), 1u);
  write("open.bdf", "INCLUDE 'x.bdf\nGRID,1\n");
  EXPECT_EQ(read_file("open.bdf").count("deck.include-syntax"), 1);
}

TEST_F(Include, DeckThatCannotBeRead) {
  const auto r = read_file("nowhere.bdf");
  ASSERT_NE(r.find("deck.cannot-open"), nullptr);
  EXPECT_EQ(r.diagnostics.num_errors(), 1);
  EXPECT_GE(r.deck.subcases.size(), 1u);
}

}  // namespace
}  // namespace bough::nastran
