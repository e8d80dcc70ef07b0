#pragma once
/// \file Help texts of tables and keys in the schemas of data/schema, for editors.
#include <string>
#include <vector>

namespace bough::toml_files {

struct KeyHelp {
  std::string name;
  std::string type;                  ///< "number or array"
  std::vector<std::string> choices;  ///< of an enum
  std::string range;                 ///< "more than 0"; may be empty
  std::string default_value;         ///< JSON; may be empty
  std::string dims;                  ///< "F/L", or by type "contact T/L; else F T/L"; empty without a dimension
  std::string description;
  bool is_required = false;
  bool takes_text = false, takes_other = false;  ///< accepts a string; accepts other values
};

struct KindHelp {
  std::string kind;  ///< "hinge", "simulation", "body.modes"
  std::string description;
  bool is_list = false;  ///< [[kind]]
  bool is_open = false;  ///< takes keys of any name (parameters)
  std::vector<KeyHelp> keys;
  /// "one of file, mass": conditions of the schema in addition to the required keys.
  std::vector<std::string> expected;

  /// Returns the help of a key; nullptr if the table has no such key.
  const KeyHelp* find(const std::string& key) const;
};

/// The tables of a body or system file, in alphabetical order.
std::vector<KindHelp> describe_kinds(bool is_body_file);

/// All of it as text, with a line for each key.
std::string format_help(const KindHelp& kind);
std::string format_help(const KeyHelp& key);

}  // namespace bough::toml_files
