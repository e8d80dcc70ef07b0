#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <string_view>

#include "analysis/edit/old_commands.hpp"
#include "base/diagnostic.hpp"
#include "base/file_roles.hpp"
#include "cli/common/console.hpp"
#include "cli/common/help_files.hpp"
#include "cli/common/memory_limit.hpp"
#include "cli/common/usage_text.hpp"
#include "cli/common/versions.hpp"
#include "cli/verbs.hpp"

namespace {

using namespace bough;

struct Verb {
  std::string_view name;
  void (*add)(CLI::App& app, cli::Action& action);
};

#define BOUGH_LIST_COMMAND(name) {#name, cli::add_##name},
constexpr Verb kVerbs[] = {BOUGH_COMMANDS(BOUGH_LIST_COMMAND)};
#undef BOUGH_LIST_COMMAND

/// Headings of `bough --help`, each above the command that begins it and those up to the next.
struct Heading {
  std::string_view first;
  const char* text;
};
constexpr Heading kHeadings[] = {{"check", "Decks"},
                                 {"split", "Flexible bodies"},
                                 {"run", "Multibody systems"},
                                 {"export", "Results, pictures, files of other programs"},
                                 {"init", "Projects"}};

/// Adds one command, or all: setting up the options of all takes longer than solving a small deck.
void add_verbs(CLI::App& app, cli::Action& action, std::string_view only = {}) {
  const bool is_verb =
      std::any_of(std::begin(kVerbs), std::end(kVerbs), [&](const Verb& verb) { return verb.name == only; });
  const char* heading = kHeadings[0].text;
  for (const auto& verb : kVerbs) {
    for (const auto& each : kHeadings)
      if (each.first == verb.name) heading = each.text;
    if (is_verb && verb.name != only) continue;
    verb.add(app, action);
    app.get_subcommand(std::string(verb.name))->group(heading);
  }
}

std::vector<std::string> get_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* verb : app.get_subcommands(nullptr)) names.push_back(verb->get_name());
  return names;
}

/// Rejects a first argument that is neither an option nor a command; the message names the nearest command.
bool check_verb(const CLI::App& app, int argc, const char* const* argv, const cli::Console& console) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (!word.empty() && word[0] == '-') continue;
    const auto verbs = get_names(app);
    if (std::find(verbs.begin(), verbs.end(), word) != verbs.end()) return true;
    const auto successor = analysis::find_successor(word), nearest = find_nearest(word, verbs);
    console.print_error("cli.unknown-verb", "unknown command \"" + word + "\"",
                        !successor.empty() ? successor
                        : nearest.empty()  ? "bough --help lists the commands"
                                           : "did you mean \"" + nearest + "\"");
    return false;
  }
  return true;
}

/// Prints and gives the exit code: what was asked for is printed whole, or it is a failure.
int print_checked(const cli::Console& console, const std::function<void()>& print) {
  try {
    print();
    cli::flush_data();
    return cli::kSuccess;
  } catch (const Failure& failure) {
    return cli::report_failure(failure, console);
  }
}

int run(int argc, const char* const* argv) {
  CLI::App app("Bough: from a finite-element model to a flexible multibody simulation", "bough");
  app.formatter(cli::make_formatter());
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.footer(
      "bough COMMAND --help, or bough help COMMAND, explains a command. Exit codes: 0 success, 1 the input is wrong, 2 "
      "usage, 3 the computation failed.\n"
      "Example:\n  bough init spinup && cd spinup && bough reduce boom.toml && bough run spinup.toml -o spinup.h5");
  bool show_version = false;
  std::string man_page, shell;
  app.add_flag("--version", show_version, "Print the versions of Bough and of its libraries");
  auto* const show_man_page = app.add_option("--man-page", man_page,
                                             "Print the manual page, as installed: bough --man-page | man -l -; "
                                             "--man-page=COMMAND: that of a command")
                                  ->expected(0, 1)
                                  ->type_name("[=COMMAND]");
  app.add_flag_callback(
      "--bash-completion", [&] { shell = "bash"; }, "Print the completion for bash: . <(bough --bash-completion)");
  app.add_flag_callback(
      "--zsh-completion", [&] { shell = "zsh"; }, "Print the completion for zsh, a file _bough on its fpath");
  app.add_flag_callback(
      "--fish-completion", [&] { shell = "fish"; }, "Print the completion for fish: bough --fish-completion | source");
  app.require_subcommand(0, 1);

  cli::Action action;
  add_verbs(app, action, argc > 1 ? argv[1] : "");

  const cli::Console console(false, 0);
  if (!check_verb(app, argc, argv, console)) return cli::kUsageError;
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    if (!console.is_root()) return cli::kSuccess;
    return print_checked(console, [&] { app.exit(help); });
  } catch (const CLI::ParseError& error) {
    const auto [what, advice] = cli::describe_parse_error(app, error);
    console.print_error("cli.usage", what, advice);
    return cli::kUsageError;
  }
  if (!man_page.empty() && cli::make_verb_man_page(app, man_page).empty()) {
    console.print_error("cli.usage", "no command '" + man_page + "' has a manual page",
                        "see bough --help for the commands");
    return cli::kUsageError;
  }
  if (show_version || show_man_page->count() > 0 || !shell.empty()) {
    return print_checked(console, [&] {
      console.print_data(show_version                 ? cli::describe_versions()
                         : !man_page.empty()          ? cli::make_verb_man_page(app, man_page)
                         : show_man_page->count() > 0 ? cli::make_man_page(app)
                         : shell == "bash"            ? cli::make_bash_completion(app)
                         : shell == "zsh"             ? cli::make_zsh_completion(app)
                                                      : cli::make_fish_completion(app));
    });
  }
  const auto count_given = [&](const char* name) {
    std::size_t count = 0;
    for (const auto* verb : app.get_subcommands())
      if (const auto* option = verb->get_option_no_throw(name)) count += option->count();
    return static_cast<int>(count);
  };
  if (!action) {
    console.print_error("cli.usage", "no command given", "see bough --help");
    return cli::kUsageError;
  }
  try {
    cli::set_work_space_aside();
    if (const char* const folder = std::getenv("BOUGH_FOLDER")) confine_files(folder);
    const FileRoles roles;
    const int code = action();
    cli::flush_data();
    return code;
  } catch (const Failure& failure) {
    return cli::report_failure(failure, cli::Console(count_given("--quiet") > 0, count_given("--verbose")));
  } catch (const std::bad_alloc&) {
    console.print_error({}, "not enough memory", "use a smaller model or fewer modes");
    return cli::kComputationFailed;
  } catch (const std::exception& error) {
    console.print_error({}, error.what(), "this is a fault in Bough; please report it");
    return cli::kComputationFailed;
  }
}

}  // namespace

namespace bough::cli {

int run_command(const std::vector<std::string>& given) {
  std::vector<std::string> words = given;
  for (auto& word : words)  // -.5, as decks have it, would be an option
    if (word.size() > 2 && word.compare(0, 2, "-.") == 0 && word[2] >= '0' && word[2] <= '9') word.insert(1, "0");
  if (!words.empty() && words[0] == "version") words[0] = "--version";
  if (!words.empty() && words[0] == "help") {  // bough help [COMMAND]
    words.erase(words.begin());
    words.insert(words.begin() + (words.empty() ? 0 : 1), "--help");
  }
  std::vector<const char*> arguments{"bough"};
  for (const auto& word : words) arguments.push_back(word.c_str());
  return run(static_cast<int>(arguments.size()), arguments.data());
}

std::vector<std::string> list_verbs() {
  std::vector<std::string> names;
  for (const auto& verb : kVerbs) names.emplace_back(verb.name);
  return names;
}

}  // namespace bough::cli
