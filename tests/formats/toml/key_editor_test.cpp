#include "formats/toml/key_editor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace bough::toml_files {
namespace {

using testing::HasSubstr;

const std::string system_text =
    "# Größe, ein Träger\n"
    "[[body]] # é\n"
    "name = \"böm\" # name\n"
    "file = 'boom.h5'\n"
    "\n"
    "[[hinge]]\n"
    "name = \"spin\"\n"
    "axis = [ 0.0, 0.0, 1.0 ] # z\n"
    "limits = { low = -1.0, high = 1.0 }\n"
    "\n"
    "[simulation]\n"
    "duration = 20.0 # s\n";

std::string set(const std::string& path, const std::string& value) {
  auto text = system_text;
  EXPECT_EQ(set_key(text, path, value), "") << path;
  return text;
}

/// The text with one piece replaced.
std::string with(const std::string& old, const std::string& piece) {
  auto text = system_text;
  return text.replace(text.find(old), old.size(), piece);
}

TEST(KeyEditor, OnlyTheValueChanges) {
  EXPECT_EQ(set("simulation.duration", "2.5"), with("20.0", "2.5"));
  EXPECT_EQ(set("hinge.spin.axis.3", "-1.0"), with("1.0 ]", "-1.0 ]"));
  EXPECT_EQ(set("hinge.1.axis", "[1.0, 0.0, 0.0]"), with("[ 0.0, 0.0, 1.0 ]", "[1.0, 0.0, 0.0]"));
  EXPECT_EQ(set("hinge.spin.limits.low", "-2.0"), with("-1.0", "-2.0"));
  // Letters of several bytes stand before on the line, and above.
  EXPECT_EQ(set("body.böm.name", "\"arm\""), with("\"böm\"", "\"arm\""));
  EXPECT_EQ(set("body.1.file", "\"x.h5\""), with("'boom.h5'", "\"x.h5\""));
}

TEST(KeyEditor, AKeyThatIsAbsentIsAdded) {
  EXPECT_EQ(set("simulation.output_step", "0.1"), with("[simulation]\n", "[simulation]\noutput_step = 0.1\n"));
  EXPECT_EQ(set("hinge.spin.limits.mid", "0"), with("{ low", "{ mid = 0, low"));
  EXPECT_EQ(set("hinge.spin.damping", "2.0"), with("[[hinge]]\n", "[[hinge]]\ndamping = 2.0\n"));
  EXPECT_EQ(set("name", "\"s\""), "name = \"s\"\n" + system_text);
}

TEST(KeyEditor, WhatCannotBeSetIsSaid) {
  auto text = system_text;
  EXPECT_THAT(set_key(text, "hinge.spun.axis", "1"), HasSubstr("'spun'"));
  EXPECT_THAT(set_key(text, "hinge.2.axis", "1"), HasSubstr("'2'"));
  EXPECT_THAT(set_key(text, "simulation.duration.x", "1"), HasSubstr("below a single value"));
  EXPECT_THAT(set_key(text, "simulation", "1"), HasSubstr("a table"));
  EXPECT_EQ(text, system_text);
}

TEST(KeyEditor, FilesThatATextNames) {
  std::string text = "[body]\ndeck = \"a.bdf\"\n[body.output]\nfile = \"a.h5\"\n";
  change_file_keys(text, [](const std::string& file) { return "/x y/" + file; });
  EXPECT_EQ(text, "[body]\ndeck = \"/x y/a.bdf\"\n[body.output]\nfile = \"a.h5\"\n");
  text = system_text;
  change_file_keys(text, [](const std::string& file) { return "../" + file; });
  EXPECT_EQ(text, with("'boom.h5'", "\"../boom.h5\""));
}

TEST(KeyEditor, QuotedTextReadsBack) { EXPECT_EQ(quote_text("a\"b\\c"), "\"a\\\"b\\\\c\""); }

}  // namespace
}  // namespace bough::toml_files
