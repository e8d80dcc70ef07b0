#include "formats/nastran/field_editor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "formats/nastran/reader.hpp"

namespace bough::nastran {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class FieldEditor : public testing::Test {
 protected:
  FieldEditor() {
    folder_ =
        fs::temp_directory_path() / ("bough-edit-" + std::to_string(testing::UnitTest::GetInstance()->random_seed()) +
                                     "-" + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_ / "parts");
  }
  ~FieldEditor() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  static FieldAddress at(const std::string& card, const std::string& id, const std::string& field) {
    return {card, id, 0, field, 0};
  }
  /// The deck's text with one field set.
  std::string edit(const std::string& text, const FieldAddress& address, const std::string& value) {
    const auto path = write("deck.bdf", text);
    Diagnostics diagnostics;
    const DeckEditor editor(path, diagnostics);
    const auto place = editor.find(address, {"campaign.toml", 7}, diagnostics);
    EXPECT_EQ(diagnostics.num_errors(), 0) << (diagnostics.items().empty() ? "" : format(diagnostics.items()[0]));
    if (!place) return {};
    return editor.write("deck.bdf", {{*place, value}}).at(0).text;
  }
  /// The one message of an address that does not fit.
  Diagnostic refuse(const std::string& text, const FieldAddress& address) {
    const auto path = write("deck.bdf", text);
    Diagnostics diagnostics;
    const DeckEditor editor(path, diagnostics);
    EXPECT_FALSE(editor.find(address, {"campaign.toml", 7}, diagnostics));
    EXPECT_EQ(diagnostics.items().size(), 1u);
    EXPECT_EQ(diagnostics.items().at(0).where.file, "campaign.toml");
    EXPECT_EQ(diagnostics.items().at(0).where.line, 7);
    return diagnostics.items().at(0);
  }

  fs::path folder_;
};

TEST_F(FieldEditor, LinesOfBlanksAndBeyondFieldNine) {
  const std::string bar = "PBAR,1,1,1.,2.,3.,4.,,,.1,.2,.3,.4\n";
  EXPECT_EQ(edit(bar, at("PBAR", "1", "C2"), ".25"), "PBAR,1,1,1.,2.,3.,4.,,,.1,.25,.3,.4\n");
  EXPECT_EQ(edit(bar, at("PBAR", "1", "E1"), ".5"), "PBAR,1,1,1.,2.,3.,4.,,,.1,.2,.3,.4,.5\n");
  EXPECT_EQ(edit("MAT1, 1 7.+10\n", at("MAT1", "1", "E"), "6.9+10"), "MAT1, 1 6.9+10\n");
  EXPECT_EQ(edit("MAT1, 1 7.+10\n", at("MAT1", "1", "NU"), ".3"), "MAT1, 1 7.+10,,.3\n");
}

TEST_F(FieldEditor, SmallFieldKeepsEveryOtherByte) {
  const std::string before =
      "$ head\r\nMAT1    1       7.+10           .3      2700.    $ aluminium\r\nENDDATA\r\n tail";
  EXPECT_EQ(edit(before, at("mat1", "1", "E"), "6.9+10"),
            "$ head\r\nMAT1    1       6.9+10          .3      2700.    $ aluminium\r\nENDDATA\r\n tail");
  EXPECT_EQ(edit(before, at("MAT1", "1", "G"), "2.7+10"),
            "$ head\r\nMAT1    1       7.+10   2.7+10  .3      2700.    $ aluminium\r\nENDDATA\r\n tail");
  EXPECT_EQ(
      edit(before, at("MAT1", "1", "GE"), ".01"),
      "$ head\r\nMAT1    1       7.+10           .3      2700.                   .01    $ aluminium\r\nENDDATA\r\n"
      " tail");
}

TEST_F(FieldEditor, RightAlignedStaysRightAligned) {
  EXPECT_EQ(edit("MAT1           1   7.+10              .3   2700.\n", at("MAT1", "1", "NU"), ".29"),
            "MAT1           1   7.+10             .29   2700.\n");
}

TEST_F(FieldEditor, ATextTooLongMakesTheLineFree) {
  EXPECT_EQ(edit("MAT1    1       7.+10           .3      2700.\nGRID    1\n", at("MAT1", "1", "RHO"), "2712.345678"),
            "MAT1,1,7.+10,,.3,2712.345678\nGRID    1\n");
}

TEST_F(FieldEditor, LargeFieldOverTwoLines) {
  const std::string before =
      "MAT1*                  1          7.E+10                              .3\n*                  2700.\n";
  const auto set = [&](const char* field, const char* value) { return edit(before, at("MAT1", "1", field), value); };
  EXPECT_EQ(set("E", "6.8765432123+10"),
            "MAT1*                  1 6.8765432123+10                              .3\n*                  2700.\n");
  EXPECT_EQ(set("RHO", "2712.5"),
            "MAT1*                  1          7.E+10                              .3\n*                 2712.5\n");
  EXPECT_EQ(set("E", "6.87654321234567891+10"), "MAT1*,1,6.87654321234567891+10,,.3\n*                  2700.\n");
}

TEST_F(FieldEditor, FreeField) {
  EXPECT_EQ(edit("MAT1, 1 ,7.+10 ,, .3,2700.\n", at("MAT1", "1", "E"), "6.9+10"), "MAT1, 1 ,6.9+10 ,, .3,2700.\n");
  EXPECT_EQ(edit("MAT1,1,7.+10,,.3\n", at("MAT1", "1", "A"), "1.-5"), "MAT1,1,7.+10,,.3,,1.-5\n");
  EXPECT_EQ(edit("MAT1,1,7.+10,,.3\n", at("MAT1", "1", "G"), "2.7+10"), "MAT1,1,7.+10,2.7+10,.3\n");
}

TEST_F(FieldEditor, ALineIsAddedWhereTheCardIsTooShort) {
  const auto read = [&](const std::string& text) {
    Diagnostics diagnostics;
    const auto deck = read_deck_text("BEGIN BULK\n" + text + "MAT1,1,7.+10,,.3\nENDDATA\n", "x", {}, diagnostics);
    EXPECT_EQ(diagnostics.num_errors(), 0);
    return deck.pbar.at(0);
  };
  for (const std::string before : {"PBAR,1,1,1.-4,1.-8\n", "PBAR    1       1       1.-4    1.-8\n",
                                   "PBAR    1       1       1.-4    1.-8                                    +A\n",
                                   "PBAR*   1               1               1.-4            1.-8\n",
                                   "PBAR*   1               1               1.-4            1.-8\n*       2.-8\n"}) {
    EXPECT_EQ(read(edit(before, at("PBAR", "1", "K1"), ".85")).k1, .85) << before;
    EXPECT_EQ(read(edit(before, at("PBAR", "1", "I1"), "3.-8")).I1, 3e-8) << before;
    EXPECT_EQ(read(edit(before, at("PBAR", "1", "J"), "5.-8")).J, 5e-8) << before;
    EXPECT_EQ(read(edit(before, at("PBAR", "1", "K2"), ".8")).I1, 1e-8) << before;
  }
}

TEST_F(FieldEditor, FieldsByNumberCountAsTheManualsDo) {
  EXPECT_EQ(edit("PBAR,1,1,1.-4,1.-8\n", {"PBAR", "1", 0, "", 4}, "2.-4"), "PBAR,1,1,2.-4,1.-8\n");
  EXPECT_EQ(edit("PBAR,1,1,1.-4,1.-8,,,,,+\n+,.1,.2\n", {"PBAR", "1", 0, "", 13}, ".3"),
            "PBAR,1,1,1.-4,1.-8,,,,,+\n+,.1,.3\n");
  EXPECT_EQ(refuse("PBAR,1,1,1.-4\n", {"PBAR", "1", 0, "", 10}).id, "batch.unknown-field");
  EXPECT_EQ(refuse("PBAR,1,1,1.-4\n", {"PBAR", "1", 0, "", 1}).id, "batch.unknown-field");
}

TEST_F(FieldEditor, SeveralEntriesOnALine) {
  EXPECT_EQ(edit("PELAS,1,1.+3,,,2,2.+3\n", at("PELAS", "2", "K"), "5.+3"), "PELAS,1,1.+3,,,2,5.+3\n");
  EXPECT_EQ(edit("PMASS,1,1.,2,2.,3,3.\n", at("PMASS", "3", "M"), "9."), "PMASS,1,1.,2,2.,3,9.\n");
}

TEST_F(FieldEditor, TabsOfAChangedLineBecomeBlanks) {
  EXPECT_EQ(edit("MAT1\t1\t7.+10\t\t.3\nGRID\t1\n", at("MAT1", "1", "NU"), ".2"),
            "MAT1    1       7.+10           .2\nGRID\t1\n");
}

TEST_F(FieldEditor, IncludedFiles) {
  write("parts/materials.inc", "MAT1,1,7.+10,,.3\nINCLUDE 'grids.inc'\n");
  write("parts/grids.inc", "GRID,1\n");
  const auto path = write("deck.bdf", "BEGIN BULK\nINCLUDE 'parts/\n materials.inc' $ here\nPBAR,1,1,1.-4\nENDDATA\n");
  Diagnostics diagnostics;
  const DeckEditor editor(path, diagnostics);
  const auto E = editor.find(at("MAT1", "1", "E"), {}, diagnostics);
  const auto A = editor.find(at("PBAR", "", "A"), {}, diagnostics);
  ASSERT_TRUE(E && A);
  EXPECT_EQ(editor.get_text(*E), "7.+10");
  auto files = editor.write("new.bdf", {{*A, "2.-4"}});
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].text,
            "BEGIN BULK\nINCLUDE '" + (folder_ / "parts/materials.inc").string() + "'\nPBAR,1,1,2.-4\nENDDATA\n");
  files = editor.write("new.bdf", {{*E, "8.+10"}});
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].text, "BEGIN BULK\nINCLUDE 'new.bdf.include1'\nPBAR,1,1,1.-4\nENDDATA\n");
  EXPECT_EQ(files[1].name, "new.bdf.include1");
  EXPECT_EQ(files[1].text, "MAT1,1,8.+10,,.3\nINCLUDE '" + (folder_ / "parts/grids.inc").string() + "'\n");
}

TEST_F(FieldEditor, WhatIsNotThereIsToldWithNearNames) {
  const std::string deck = "MAT1,1,7.+10,,.3\nMAT1,12,7.+10,,.3\nFORCE,5,1,,1.\nFORCE,5,2,,1.\n";
  auto error = refuse(deck, at("MATI", "1", "E"));
  EXPECT_EQ(error.id, "batch.unknown-card");
  EXPECT_THAT(error.advice, HasSubstr("did you mean MAT1"));
  error = refuse(deck, at("MAT1", "13", "E"));
  EXPECT_EQ(error.id, "batch.unknown-card");
  EXPECT_THAT(error.advice, HasSubstr("it has 1, 12"));
  error = refuse(deck, at("MAT1", "1", "RH0"));
  EXPECT_EQ(error.id, "batch.unknown-field");
  EXPECT_THAT(error.advice, HasSubstr("did you mean RHO"));
  error = refuse(deck, at("FORCE", "5", "F"));
  EXPECT_EQ(error.id, "batch.ambiguous-card");
  EXPECT_THAT(error.what, HasSubstr("lines 3, 4"));
  EXPECT_EQ(edit(deck, {"FORCE", "5", 2, "F", 0}, "3."),
            "MAT1,1,7.+10,,.3\nMAT1,12,7.+10,,.3\nFORCE,5,1,,1.\nFORCE,5,2,,3.\n");
  EXPECT_EQ(refuse("GRID,1,,0.,0.,0.\n=,*1,=,*1.,==\n", at("GRID", "1", "X1")).id, "batch.replicated-card");
}

TEST_F(FieldEditor, AFieldThatCannotTakeItsValue) {
  const auto path = write("deck.bdf",
                          "PBAR    1       1       1.-4    1.-8                                    12\n"
                          "+12     .1\nMAT1,1,7.+10,,.3\n");
  Diagnostics diagnostics;
  const DeckEditor editor(path, diagnostics);
  const auto A = editor.find(at("PBAR", "1", "A"), {}, diagnostics);
  ASSERT_TRUE(A);
  try {
    editor.write("deck.bdf", {{*A, "1.23456789-4"}});
    FAIL() << "expected batch.field-width";
  } catch (const InputError& error) {
    EXPECT_EQ(error.items().at(0).id, "batch.field-width");
    EXPECT_EQ(error.items().at(0).where.line, 1);
  }
}

}  // namespace
}  // namespace bough::nastran
