#pragma once
/// \file The commands of `bough edit`.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/common/console.hpp"
#include "cli/edit/edit_text.hpp"

namespace bough::cli {

class EditSession {
 public:
  /// Asks the person at the terminal; nothing at the end of the input. Empty function: no user, as in a script.
  using Ask = std::function<std::optional<std::string>(const std::string& prompt)>;

  /// `output`: where `save` writes; empty: the file itself.
  EditSession(EditText text, const Console& console, Ask ask, std::string output);

  /// Returns the text with all changes, saved or not.
  const std::string& get_text() const { return text_.get_text(); }

  /// Does one line; false when the session is to end. Throws InputError and ComputationError.
  bool execute(const std::string& line);
  /// Reports unsaved changes at the end of the input.
  void finish() const;
  /// Completions of the last word of the line.
  std::vector<std::string> complete(const std::string& line) const;

  /// The commands in the order of `help`.
  static std::vector<std::string> list_commands();

 private:
  using Words = std::vector<std::string>;

  void list(const Words& words);
  void show(const Words& words);
  void add(const Words& words);
  void set(const Words& words);
  void unset(const Words& words);
  void remove(const Words& words);
  void rename(const Words& words);
  void copy(const Words& words);
  void check() const;
  void run_verb(const std::string& verb, const Words& words) const;
  void save(const Words& words);
  void help(const Words& words) const;
  bool quit();

  void ask_for_key(const toml_files::KindHelp& kind, const toml_files::KeyHelp& key,
                   toml_files::KeyValues& given) const;
  toml_files::KeyValues ask_for_keys(const toml_files::KindHelp& kind, toml_files::KeyValues given) const;
  /// Asks for keys that the type or a referenced table requires: they are in the reader, not in the schema.
  toml_files::KeyValues ask_for_missing(const toml_files::KindHelp& kind, toml_files::KeyValues given) const;
  /// The errors of a text, as `check` has them.
  std::vector<Diagnostic> list_errors(const std::string& text) const;
  EditTarget find_item(const Words& words, std::size_t first, std::size_t num_after) const;
  std::vector<toml_files::NameUse> find_uses_of(const EditTarget& target, const std::string& text) const;

  EditText text_;
  const Console& console_;
  Ask ask_;
  std::string target_;
  bool is_saved_ = false;
};

}  // namespace bough::cli
