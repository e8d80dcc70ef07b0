#pragma once
/// \file The commands of `bough edit`, at a terminal, from a script or from Python.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/edit/edit_text.hpp"
#include "base/diagnostic.hpp"

namespace bough::analysis {

/// Receives the output of the commands of a session, and does the work that is the caller's.
class EditHost {
 public:
  virtual ~EditHost() = default;
  /// Takes a requested result: of list, show, diff and help.
  virtual void print_data(const std::string& text) = 0;
  /// Takes a remark for a reader.
  virtual void print(const std::string& text) = 0;
  /// Takes warnings and notes.
  virtual void print(const Diagnostics& diagnostics) = 0;
  /// Throws if `path` cannot be an output; the folder of a new file may be read-only, for example.
  virtual void check_output(const std::string& path) = 0;
  /// Runs `run`, `reduce` or `plot` with its words and returns the exit code.
  virtual int run_command(const std::vector<std::string>& words) = 0;
};

class EditSession {
 public:
  /// Asks the person at the terminal; nothing at the end of the input. Empty function: no user, as in a script.
  using Ask = std::function<std::optional<std::string>(const std::string& prompt)>;

  /// `output`: where `save` writes; empty: the file itself.
  EditSession(EditText text, EditHost& host, Ask ask, std::string output);

  /// Returns the text with all changes, saved or not.
  const std::string& get_text() const { return text_.get_text(); }

  /// Does one line; false when the session is to end. Throws InputError and ComputationError.
  bool execute(const std::string& line);
  /// Does line `number` of a script; failures without a file get the location `script`:`number`.
  bool execute(const std::string& line, const std::string& script, int number);
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
  EditHost& host_;
  Ask ask_;
  std::string target_;
  bool is_saved_ = false;
};

/// Text of a body or system file for a session; empty for a system file that does not exist yet. A session may write
/// the file that it reads. Throws InputError "cli.wrong-file", what the readers throw and what host.check_output()
/// throws.
EditText read_edit_text(const std::string& file, EditHost& host);

}  // namespace bough::analysis
