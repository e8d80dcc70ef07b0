/// \file Values of PARAM, places of the case control, names of fields, cards that were refused.
#include "tests/formats/nastran/deck_text.hpp"

namespace bough::nastran {
namespace {

struct Value {
  const char* card;
  Severity severity;
  const char* read_as;  ///< what the record has; nullptr: nothing
};

TEST(Params, EveryValueThatIsNoneOfItsKindIsNamedWithItsLine) {
  for (const Value& v : {Value{"COUPMASS,YES", Severity::Warning, "1"}, {"COUPMASS,NO", Severity::Warning, "-1"},
                         {"COUPMASS,1.", Severity::Warning, "1"},       {"COUPMASS,MANY", Severity::Error, nullptr},
                         {"G,YES", Severity::Error, nullptr},           {"G,", Severity::Error, nullptr},
                         {"CK1,ABC", Severity::Error, nullptr},         {"CK2,ABC", Severity::Error, nullptr},
                         {"CK3,ABC", Severity::Error, nullptr},         {"CM1,X", Severity::Error, nullptr},
                         {"CM2,X", Severity::Error, nullptr},           {"CB1,X", Severity::Error, nullptr},
                         {"CB2,X", Severity::Error, nullptr},           {"K6ROT,-1.", Severity::Error, nullptr},
                         {"SNORM,FLAT", Severity::Error, nullptr},      {"EPZERO,-1.-8", Severity::Error, nullptr},
                         {"FOLLOWK,MAYBE", Severity::Error, nullptr},   {"WTMASS,0.", Severity::Error, nullptr},
                         {"WTMASS,-1.", Severity::Error, nullptr},      {"INREL,-3", Severity::Error, nullptr},
                         {"INREL,-1.", Severity::Warning, "-1"},        {"GRDPNT,HERE", Severity::Error, nullptr},
                         {"AUTOSPC,N0", Severity::Warning, "YES"}}) {
    const auto r = read(std::string("GRID,1\nPARAM,") + v.card + "\n");
    ASSERT_EQ(r.count("fe.bad-param"), 1) << v.card << r.get_messages();
    const auto* d = r.find("fe.bad-param");
    EXPECT_EQ(d->severity, v.severity) << v.card;
    EXPECT_EQ(d->where.line, 2) << v.card;
    const std::string name(v.card, std::string_view(v.card).find(','));
    const auto* param = r.deck.find_param(name);
    ASSERT_EQ(param != nullptr, v.read_as != nullptr) << v.card;
    if (param) EXPECT_EQ(param->value, v.read_as) << v.card;
  }
}

TEST(Params, GoodValuesPass) {
  for (const char* card :
       {"COUPMASS,1",  "COUPMASS,-1", "G,.02",        "G,0",         "G,4.-2",     "CK2,2.",        "K6ROT,0.",
        "K6ROT,1.E+5", "SNORM,20.",   "EPZERO,1.D-8", "FOLLOWK,YES", "FOLLOWK,NO", "WTMASS,2.59-3", "WTMASS,1",
        "INREL,0",     "INREL,-1",    "INREL,-2",     "AUTOSPC,YES", "AUTOSPC,NO", "AUTOSPC,N"})
    EXPECT_EQ(read(std::string("GRID,1\nPARAM,") + card + "\n").count("fe.bad-param"), 0) << card;
}

TEST(Params, ThoseOfTheCaseControlToo) {
  const auto r = read("SOL 103\nCEND\nPARAM,WTMASS,0.\nBEGIN BULK\nGRID,1\n");
  ASSERT_EQ(r.count("fe.bad-param"), 1) << r.get_messages();
  EXPECT_EQ(r.find("fe.bad-param")->where.line, 3);
}

TEST(CaseControl, EveryCommandHasItsPlace) {
  const auto r = read(
      "SOL 101\nCEND\nSPC = 5\nSUBCASE 1\nLOAD = 3\nTEMP(LOAD) = 4\nSUBCASE 2\nSPC = 6\nMETHOD = 7\nSTATSUB = 1\n"
      "BEGIN BULK\nGRID,1\n");
  ASSERT_EQ(r.deck.subcases.size(), 2u);
  const auto &one = r.deck.subcases[0], &two = r.deck.subcases[1];
  EXPECT_EQ(values(one.find_command("SPC").line, one.find_command("LOAD").line, one.find_command("TEMPERATURE").line,
                   one.find_command("METHOD").line),
            values(3, 5, 6, 0));
  EXPECT_EQ(values(two.find_command("SPC").line, two.find_command("METHOD").line, two.find_command("STATSUB").line),
            values(8, 9, 10));
}

TEST(CaseControl, LoadsIsASlipAndLoadsetIsNot) {
  const auto slip = read("SOL 101\nCEND\nLOADS = 3\nBEGIN BULK\nGRID,1\n");
  expect_messages(slip, "deck.unknown-case-control", 1, "did you mean LOAD");
  EXPECT_EQ(read("SOL 101\nCEND\nLOADSET = 3\nBEGIN BULK\nGRID,1\n").count("deck.unknown-case-control"), 0);
}

TEST(Fields, OfAGroupAreNamedOneByOne) {
  const auto says = [](const std::string& text, const std::string& words) {
    const auto r = read(text);
    EXPECT_NE(r.get_messages().find(words), std::string::npos) << r.get_messages();
  };
  says("FORCE,1,2,,1.,0.,.,0.\n", "FORCE: N2 (field 7) is '.', expected a real number");
  says("GRID,1,,1.,x,0.\n", "GRID: X2 (field 5) is 'x'");
  says("PBAR,1,1,1.\n,0.,0.,1.,q\n", "PBAR: D2 (field 5 of line 2) is 'q'");
  says("CBAR,1,1,1,2,0.,1.,0.\n,,,0.,0.,z\n", "W3A (field 6 of line 2) is 'z'");
}

TEST(Refused, CardsAreRememberedById) {
  const auto r = read("MAT1,7,abc,,.3\nPBARL,8,7,,BAR\n,1.,x\nGRID,9,,y\nGRID,10\n");
  EXPECT_TRUE(r.deck.is_refused(7, {"MAT8", "MAT1"}));
  EXPECT_TRUE(r.deck.is_refused(8, {"PBARL"}));
  EXPECT_TRUE(r.deck.is_refused(9, {"GRID"}));
  EXPECT_FALSE(r.deck.is_refused(10, {"GRID"}));
  EXPECT_FALSE(r.deck.is_refused(8, {"PBAR"}));
}

}  // namespace
}  // namespace bough::nastran
