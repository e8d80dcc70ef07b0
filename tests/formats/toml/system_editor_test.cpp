#include "formats/toml/system_editor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/toml/key_editor.hpp"
#include "formats/toml/schema_help.hpp"

namespace bough::toml_files {
namespace {

using ::testing::HasSubstr;

const std::string edited_text =
    "# An arm on a hub.\n"
    "name = \"arm\" # böm\n"
    "\n"
    "[parameters]\n"
    "k = 3.0   # N m/rad\n"
    "\n"
    "# The hub.\n"
    "[[body]]\n"
    "name = \"hub\"\n"
    "mass = 2.0\n"
    "nodes = [\n"
    "  {id = 1, position = [0.0, 0.0, 1.0]},  # top\n"
    "  {id = 2, position = [0.0, 1.0, 0.0]},\n"
    "]\n"
    "\n"
    "[[body]]\n"
    "name = 'arm' # flexible\n"
    "file = \"arm.h5\"\n"
    "\n"
    "# On the ground.\n"
    "[[hinge]]\n"
    "name = \"root\"\n"
    "type = \"revolute\"\n"
    "child = \"hub\"\n"
    "stiffness = \"$k\"\n"
    "stops.lower = -1.0\n"
    "stops.stiffness = 1e3\n"
    "\n"
    "[[hinge]]\n"
    "name = \"joint\"\n"
    "type = \"fixed\"\n"
    "parent = \"hub\"   # \"hub\" in a comment\n"
    "child = \"arm\"\n"
    "[hinge.friction] # of the joint\n"
    "coulomb = 0.1\n"
    "\n"
    "[[sensor]]\n"
    "name = \"tip\"\n"
    "type = \"position\"\n"
    "body = \"arm\"\n"
    "\n"
    "[[controller]]\n"
    "name = \"law\"\n"
    "type = \"expression\"\n"
    "inputs = [\"tip:x\", \"tip:y\"]\n"
    "expression = \"u1 + tip\"\n"
    "\n"
    "[[event]]\n"
    "name = \"low\"\n"
    "signal = \"/sensors/tip:x\"\n"
    "\n"
    "[simulation]\n"
    "duration = 1.0\n"
    "record = [\"sensors/tip\", \"hinges/root/q\"]\n";

std::string replace(std::string text, const std::string& old, const std::string& piece) {
  for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += piece.size())
    text.replace(at, old.size(), piece);
  return text;
}

TableItem find_item_of(const std::string& path) {
  for (const auto& item : list_items(edited_text))
    if (item.path() == path) return item;
  ADD_FAILURE() << path;
  return {};
}

TEST(SystemEditor, ListsTheTablesInTheirOrder) {
  std::string list;
  for (const auto& item : list_items(edited_text)) list += item.path() + "=" + item.name + " ";
  EXPECT_EQ(list,
            "parameters= body.1=hub body.2=arm hinge.1=root hinge.2=joint sensor.1=tip "
            "controller.1=law event.1=low simulation= ")
      << "tables of an entry belong to it";
}

TEST(SystemEditor, ANewKeyComesLastInItsTable) {
  auto text = edited_text;
  EXPECT_EQ(set_value(text, "body.2.stiffening", "false"), "");
  EXPECT_EQ(text, replace(edited_text, "file = \"arm.h5\"\n", "file = \"arm.h5\"\nstiffening = false\n"));
  text = edited_text;
  EXPECT_EQ(set_value(text, "hinge.1.stops.upper", "2.0"), "");
  EXPECT_EQ(text, replace(edited_text, "stops.stiffness = 1e3\n", "stops.stiffness = 1e3\nstops.upper = 2.0\n"));
  text = edited_text;
  EXPECT_EQ(set_value(text, "hinge.2.damping", "2.0"), "");
  EXPECT_EQ(text, replace(edited_text, "child = \"arm\"\n", "child = \"arm\"\ndamping = 2.0\n"));
  text = edited_text;
  EXPECT_EQ(set_value(text, "body.1.nodes.2.id", "7"), "");
  EXPECT_EQ(text, replace(edited_text, "id = 2", "id = 7"));
  text = "[simulation]";
  EXPECT_EQ(set_value(text, "simulation.duration", "2"), "");
  EXPECT_EQ(text, "[simulation]\nduration = 2\n");
  EXPECT_EQ(set_value(text, "parameters.k", "2"), "");
  EXPECT_EQ(text, "[parameters]\nk = 2\n\n[simulation]\nduration = 2\n");
  EXPECT_EQ(set_value(text, "name", "\"x\""), "");
  EXPECT_EQ(text, "name = \"x\"\n\n[parameters]\nk = 2\n\n[simulation]\nduration = 2\n");
}

TEST(SystemEditor, WhatIsRemovedTakesItsLinesAlong) {
  auto text = edited_text;
  EXPECT_EQ(remove_path(text, "hinge.2"), "");
  EXPECT_EQ(text,
            replace(edited_text,
                    "[[hinge]]\nname = \"joint\"\ntype = \"fixed\"\nparent = \"hub\"   # \"hub\" in a comment\nchild "
                    "= \"arm\"\n[hinge.friction] # of the joint\ncoulomb = 0.1\n\n",
                    ""));
  text = edited_text;
  EXPECT_EQ(remove_path(text, "body.1.nodes.2"), "");
  EXPECT_EQ(text, replace(edited_text, "  {id = 2, position = [0.0, 1.0, 0.0]},\n", ""));
  text = edited_text;
  EXPECT_EQ(remove_path(text, "body.1.nodes"), "");
  EXPECT_THAT(text, HasSubstr("mass = 2.0\n\n[[body]]"));
  text = edited_text;
  EXPECT_EQ(remove_path(text, "body.1.nodes.1.id"), "");
  EXPECT_EQ(text, replace(edited_text, "{id = 1, position", "{position"));
  text = edited_text;
  EXPECT_EQ(remove_path(text, "parameters.k"), "");
  EXPECT_EQ(text, replace(edited_text, "k = 3.0   # N m/rad\n", ""));
  EXPECT_NE(remove_path(text, "hinge.9"), "");
}

TEST(SystemEditor, ANewTableStandsBehindThoseOfItsKind) {
  auto text = edited_text;
  EXPECT_EQ(add_item(text, "body", true, {{"name", "\"rod\""}, {"mass", "1.0"}}), "");
  EXPECT_EQ(text,
            replace(edited_text, "# On the ground.\n", "[[body]]\nname = \"rod\"\nmass = 1.0\n\n# On the ground.\n"));
  text = edited_text;
  EXPECT_EQ(add_item(text, "force", true, {{"name", "\"f\""}}), "");
  EXPECT_EQ(text, replace(edited_text, "[simulation]\n", "[[force]]\nname = \"f\"\n\n[simulation]\n"));
  text = "body = [{name = \"a\", mass = 1}]\n";
  EXPECT_EQ(add_item(text, "body", true, {{"name", "\"b\""}, {"mass", "2"}}), "");
  EXPECT_EQ(text, "body = [{name = \"a\", mass = 1}, {name = \"b\", mass = 2}]\n");
  EXPECT_EQ(remove_path(text, "body.1"), "");
  EXPECT_EQ(text, "body = [{name = \"b\", mass = 2}]\n");
  text = edited_text;
  EXPECT_EQ(copy_item(text, find_item_of("hinge.1"), "second"), "");
  EXPECT_THAT(text, HasSubstr("stops.stiffness = 1e3\n\n[[hinge]]\nname = \"second\"\ntype = \"revolute\""));
}

TEST(SystemEditor, ANameChangesWhereverItIsMeant) {
  auto text = edited_text;
  EXPECT_EQ(rename_item(text, find_item_of("body.1"), "core"), "");
  EXPECT_EQ(text, replace(replace(replace(edited_text, "name = \"hub\"", "name = \"core\""), "child = \"hub\"",
                                  "child = \"core\""),
                          "parent = \"hub\"", "parent = \"core\""));
  text = edited_text;
  EXPECT_EQ(rename_item(text, find_item_of("sensor.1"), "end"), "");
  EXPECT_EQ(text, replace(replace(replace(replace(edited_text, "name = \"tip\"", "name = \"end\""), "\"tip:", "\"end:"),
                                  "/sensors/tip:", "/sensors/end:"),
                          "sensors/tip\"", "sensors/end\""))
      << "u1 + tip is a formula of u1, u2, ..., and no name";
  text = edited_text;
  auto parameter = find_item_of("parameters");
  parameter.name = "k";
  EXPECT_EQ(rename_item(text, parameter, "spring"), "");
  EXPECT_EQ(text, replace(replace(edited_text, "k = 3.0", "spring = 3.0"), "$k", "$spring"));
  text = edited_text;
  EXPECT_THAT(rename_item(text, find_item_of("body.1"), "arm"), HasSubstr("already"));
  EXPECT_EQ(text, edited_text);
}

TEST(SystemEditor, UsesOfANameAreFound) {
  std::string found;
  for (const auto& use : find_uses(edited_text, "body", "arm")) found += use.path + " ";
  EXPECT_EQ(found, "hinge.2.child sensor.1.body ");
  EXPECT_EQ(find_uses(edited_text, "hinge", "root").size(), 1U);
}

TEST(SystemEditor, SchemasTellTheKeys) {
  const auto kinds = describe_kinds(false);
  const auto hinge = std::find_if(kinds.begin(), kinds.end(), [](const auto& k) { return k.kind == "hinge"; });
  ASSERT_NE(hinge, kinds.end());
  EXPECT_TRUE(hinge->is_list);
  ASSERT_NE(hinge->find("type"), nullptr);
  EXPECT_TRUE(hinge->find("type")->is_required);
  EXPECT_THAT(hinge->find("type")->choices, testing::Contains("revolute"));
  EXPECT_EQ(hinge->find("axis")->default_value, "[0,0,1]");
  EXPECT_THAT(format_help(*hinge->find("axis")), HasSubstr("array of 3"));
  EXPECT_FALSE(describe_kinds(true).empty());
}

}  // namespace
}  // namespace bough::toml_files
