#pragma once
/// \file Edits the tables of a body or system file in its text: what is not edited keeps every byte, comments too.
///
/// `path` is as of set_key: "hinge.2.axis". An edit that cannot be made returns why and leaves the text as it was;
/// empty is success. Whether the result is a sound file is check_text's affair.
#include <string>
#include <utility>
#include <vector>

namespace bough::toml_files {

/// A table of the file: an entry of a list ([[hinge]]) or a single table ([simulation]).
struct TableItem {
  std::string kind;               ///< "hinge", "simulation", "body.load"
  int number = 0;                 ///< from 1 in its list; 0 for a single table
  std::string name;               ///< may be empty
  std::string type;               ///< may be empty
  std::vector<std::string> keys;  ///< its own, in alphabetical order
  int line = 0;

  /// "hinge.2", "simulation"
  std::string path() const { return number > 0 ? kind + "." + std::to_string(number) : kind; }
};

/// A text value that names an item: its position in the text and the name.
struct NameUse {
  std::string path;  ///< "hinge.2.child"
  std::string text;
  int line = 0;
};

using KeyValues = std::vector<std::pair<std::string, std::string>>;

/// In the order of the file; empty when the text is not TOML.
std::vector<TableItem> list_items(const std::string& text);
/// The lines of an item, with the comment above it.
std::string get_item_text(const std::string& text, const std::string& item_path);
/// The value at a path as the text has it; empty when there is none.
std::string get_value_text(const std::string& text, const std::string& path);

/// Sets one value; a key that is absent comes last in its table.
std::string set_value(std::string& text, const std::string& path, const std::string& value);
/// Removes the key with its line, or the table with its lines.
std::string remove_path(std::string& text, const std::string& path);
/// A new entry of a list, after the last one, or a single table; values are TOML text.
std::string add_item(std::string& text, const std::string& kind, bool is_list, const KeyValues& values);
/// A second entry like this one under another name.
std::string copy_item(std::string& text, const TableItem& item, const std::string& name);

/// Every use of the name of an item: keys that refer to its kind, signals "name:component", channels
/// "/sensors/name", "$name" of parameters (kind "parameters").
std::vector<NameUse> find_uses(const std::string& text, const std::string& kind, const std::string& name);
/// Gives the item another name, everywhere.
std::string rename_item(std::string& text, const TableItem& item, const std::string& name);

/// Returns true if this is the text of a TOML value.
bool is_value(const std::string& text);

}  // namespace bough::toml_files
