#include "cli/verbs.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "analysis/edit/edit_session.hpp"
#include "cli/common/console.hpp"
#include "cli/common/options.hpp"
#include "cli/edit/line_source.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

namespace {

struct EditOptions : CommonOptions {
  std::string file;
};

/// Prints on the console; runs commands of the program.
class ConsoleHost final : public analysis::EditHost {
 public:
  explicit ConsoleHost(const Console& console) : console_(console) {}
  void print_data(const std::string& text) override { console_.print_data(text); }
  void print(const std::string& text) override { console_.print(text); }
  void print(const Diagnostics& diagnostics) override { console_.print(diagnostics); }
  void check_output(const std::string& path) override { cli::check_output({}, path); }
  int run_command(const std::vector<std::string>& words) override { return cli::run_command(words); }

 private:
  const Console& console_;
};

int run_edit(const EditOptions& o) {
  const Console console(o.quiet, o.verbosity);
  if (!console.is_root()) return kSuccess;
  const bool is_interactive = is_at_terminal();
  ConsoleHost host(console);
  analysis::EditSession::Ask ask;
  if (is_interactive)
    ask = [](const std::string& prompt) {
      auto line = read_line(prompt);
      if (was_left()) throw InputError("cli.edit-command", {}, "the command was left", "it changed nothing");
      return line;
    };
  if (!o.output.empty()) check_output(o, o.output);
  analysis::EditSession session(analysis::read_edit_text(o.file, host), host, ask, o.output);
  const auto prompt = fs::path(o.file).filename().string() + "> ";
  if (is_interactive) console.print("'help' lists the commands\n");
  const Complete complete = [&](const std::string& line) { return session.complete(line); };
  for (int number = 1;; ++number) {
    const auto line = read_line(prompt, complete);
    if (!line) break;
    if (!is_interactive) {
      if (!session.execute(*line, "stdin", number)) break;
    } else {
      try {
        if (!session.execute(*line)) break;
      } catch (const Failure& failure) {
        console.print(failure.items());
      }
    }
    flush_data();
  }
  session.finish();
  return kSuccess;
}

}  // namespace

void add_edit(CLI::App& app, Action& action) {
  auto [verb, o] = add_verb(app, action, run_edit, "edit");
  verb->add_option("file", o->file, "system.toml or body.toml; a new system file where there is none")->required();
  add_common_options(*verb, *o, kOutput, "Where save writes (default: the file itself)");
}

}  // namespace bough::cli
