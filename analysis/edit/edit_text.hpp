#pragma once
/// \file The text of `bough edit`, its earlier versions (undo) and its errors by the schema.
#include <string>
#include <vector>

#include "formats/toml/schema_help.hpp"
#include "formats/toml/system_editor.hpp"

namespace bough::analysis {

/// An item and the text after its name in a path: "boom.modes.2" is the body boom and modes.2.
struct EditTarget {
  toml_files::TableItem item;
  std::string rest;
  /// Path in the form of set_value.
  std::string path() const {
    if (item.kind.empty()) return rest;
    return rest.empty() ? item.path() : item.path() + "." + rest;
  }
};

class EditText {
 public:
  /// Starts without changes: `text` counts as saved. \param is_body_file  selects the schema: body file or system file.
  EditText(std::string file, std::string text, bool is_body_file);

  /// Returns the path of the file, for messages.
  const std::string& get_file() const { return file_; }
  /// Returns the text with all changes.
  const std::string& get_text() const { return text_; }
  /// Returns the text as last saved.
  const std::string& get_saved() const { return saved_; }
  /// Returns the tables that the schema of this file permits.
  const std::vector<toml_files::KindHelp>& get_kinds() const { return kinds_; }
  /// Returns true for a body file, false for a system file.
  bool is_body_file() const { return is_body_file_; }
  /// Returns true if the text differs from the saved text.
  bool is_changed() const { return text_ != saved_; }
  /// Marks the present text as saved; the undo history stays.
  void set_saved() { saved_ = text_; }

  /// Takes the new text unless it has toml.* errors that the old one has not; these are thrown. `allows_missing`: keys
  /// that are missing are no errors yet.
  void change(const std::string& text, bool allows_missing = false);
  /// Throws InputError "cli.edit-command" when there is nothing to take back, or to do again.
  void undo();
  void redo();

  /// The table kind by its name; throws "cli.edit-name" with the nearest.
  const toml_files::KindHelp& find_kind(const std::string& name) const;
  /// "boom", "hinge.root", "hinge.2", "simulation", with a key after it when `wants_key`; throws "cli.edit-name" where
  /// there is none or more than one.
  EditTarget find_target(const std::string& words, bool wants_key) const;
  /// The text of a value as TOML takes it: quoted where the schema wants a string.
  std::string make_value(const toml_files::KindHelp* kind, const std::string& key, const std::string& text) const;

 private:
  const toml_files::KindHelp* find_kind_or_null(const std::string& name) const;

  std::string file_, text_, saved_;
  bool is_body_file_;
  std::vector<toml_files::KindHelp> kinds_;
  std::vector<std::string> before_, after_;
};

}  // namespace bough::analysis
