#include "cli/verbs.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "analysis/common/inputs.hpp"
#include "base/file_roles.hpp"
#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/edit/edit_session.hpp"
#include "cli/edit/line_source.hpp"
#include "formats/toml/specs.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct EditOptions : CommonOptions {
  std::string file;
};

/// Gives a failure of a command the location of its line of the script.
std::vector<Diagnostic> place(const Failure& failure, int line) {
  auto items = failure.items();
  for (auto& item : items)
    if (item.where.file.empty()) item.where = {"stdin", line, 0};
  return items;
}

EditText read_edit_text(const std::string& file) {
  if (!analysis::has_suffix(file, ".toml"))
    throw InputError("cli.wrong-file", {file}, "edit takes body and system files in TOML", "name a .toml file");
  std::error_code failed;
  if (!fs::exists(file, failed)) {
    check_output({}, file);
    return {file, "", false};
  }
  FileRoles::allow_both(file);
  analysis::demand_file(file);
  const auto kind = toml_files::detect_kind(file);
  if (kind != "body") analysis::demand_kind(file, kind, "system");
  std::ifstream in(file, std::ios::binary);
  return {file, std::string(std::istreambuf_iterator<char>(in), {}), kind == "body"};
}

int run_edit(const EditOptions& o) {
  const Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  const bool is_interactive = is_at_terminal();
  EditSession::Ask ask;
  if (is_interactive)
    ask = [](const std::string& prompt) {
      auto line = read_line(prompt);
      if (was_left()) throw InputError("cli.edit-command", {}, "the command was left", "it changed nothing");
      return line;
    };
  if (!o.output.empty()) check_output(o, o.output);
  EditSession session(read_edit_text(o.file), console, ask, o.output);
  const auto prompt = fs::path(o.file).filename().string() + "> ";
  if (is_interactive) console.print("'help' lists the commands\n");
  const Complete complete = [&](const std::string& line) { return session.complete(line); };
  for (int number = 1;; ++number) {
    const auto line = read_line(prompt, complete);
    if (!line) break;
    try {
      if (!session.execute(*line)) break;
    } catch (const Failure& failure) {
      if (!is_interactive && dynamic_cast<const ComputationError*>(&failure) != nullptr)
        throw ComputationError(place(failure, number));
      if (!is_interactive) throw InputError(place(failure, number));
      console.print(failure.items());
    }
    flush_data();
  }
  session.finish();
  return kSuccess;
}

}  // namespace

void add_edit(CLI::App& app, Action& action) {
  auto o = std::make_shared<EditOptions>();
  auto* verb = add_verb(app, "edit", "Change a system or body file by commands, at a terminal or from a script");
  verb->add_option("file", o->file, "system.toml or body.toml; a new system file where there is none")->required();
  add_common_options(*verb, *o, kOutput, "Where save writes (default: the file itself)");
  verb->footer(
      "Commands: list, show, add, set, unset, delete, rename, copy, undo, redo, check, run, reduce, plot, diff, save, "
      "quit; 'help' in the session explains them, and every key. A script comes on standard input and ends at its "
      "first "
      "wrong line.\n"
      "Example:\n  bough edit spinup.toml\n  echo 'set simulation.duration=5\n  save' | bough edit spinup.toml");
  verb->callback([&action, o] { action = [o] { return run_edit(*o); }; });
}

}  // namespace bough::cli
