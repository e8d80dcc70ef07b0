#pragma once
/// \file Options that several verbs share, declared once.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/verbs.hpp"

namespace bough::cli {

class Console;

struct CommonOptions {
  std::string output;
  bool quiet = false;
  int verbosity = 0;
  bool json = false;
  bool no_clobber = false;
};

/// Options of a command that are those of its request.
template <class Request>
struct RequestOptions : CommonOptions {
  Request request;
};

/// Adds a command with its texts (command_help.hpp). One unit makes them all: half of CLI11 comes with it, 100 kB of
/// code a unit.
CLI::App* add_verb(CLI::App& app, const std::string& name);
/// Adds a command as above. \return it, and its options, which the callback that the caller sets keeps.
template <class Options>
std::pair<CLI::App*, std::shared_ptr<Options>> add_verb(CLI::App& app, const std::string& name) {
  return {add_verb(app, name), std::make_shared<Options>()};
}
/// Adds a command that sets `action` to `run` when the command line names it. \param subject  the file that failures
/// without a file concern, read when the command runs; nullptr: none.
CLI::App* add_verb(CLI::App& app, Action& action, const Action& run, const std::string& name,
                   const std::string* subject);
/// Adds a command that runs run(options). \return the command, and its options, which live as long as it does.
template <class Options>
std::pair<CLI::App*, std::shared_ptr<Options>> add_verb(CLI::App& app, Action& action, int (*run)(const Options&),
                                                        const std::string& name) {
  auto options = std::make_shared<Options>();
  return {add_verb(
              app, action, [options, run] { return run(*options); }, name, nullptr),
          options};
}
/// Adds a command as above. \param subject  the entry of the request with the file that failures without a file
/// concern.
template <class Options, class Request>
std::pair<CLI::App*, std::shared_ptr<Options>> add_verb(CLI::App& app, Action& action, int (*run)(const Options&),
                                                        const std::string& name, std::string Request::*subject) {
  auto options = std::make_shared<Options>();
  const auto run_options = [options, run] { return run(*options); };
  return {add_verb(app, action, run_options, name, &(options->request.*subject)), options};
}

enum Offers : unsigned { kOutput = 1, kJson = 2 };

/// Adds -q, -v and, as `offers` says, -o/--output with --no-clobber and --force, and --json.
void add_common_options(CLI::App& verb, CommonOptions& options, unsigned offers, const std::string& output_help = {});

/// --set name=value, as often as wanted.
void add_set_option(CLI::App& verb, std::vector<std::string>& set);

/// Before the work: throws when the output cannot be meant or written. InputError("cli.output-exists") when the file is
/// there and --no-clobber was given, InputError("cli.output-is-input") when it is one of the inputs,
/// ComputationError("cli.write") when its folder is missing or closed, or when it is no regular file.
void check_output(const CommonOptions& options, const std::string& path, const std::vector<std::string>& inputs = {});

/// Checks several outputs of one call, of which empty ones are left out; InputError("cli.same-output") if two of them
/// are one file.
void check_outputs(const CommonOptions& options, const std::vector<std::string>& paths,
                   const std::vector<std::string>& inputs = {});

/// Names the files that were written, unless JSON is printed. \param files  empty names are passed over. \return
/// kSuccess
int print_written_files(const CommonOptions& options, const Console& console, const std::vector<std::string>& files);

/// Names the deck in messages, checks it and the outputs on the first rank, and lets that rank print alone. Collective.
/// \param inputs  other files that no output may replace.
void open_deck(Console& console, const CommonOptions& options, const std::string& deck,
               const std::vector<std::string>& outputs, std::vector<std::string> inputs = {});

/// A report, to the output file when one is given, else to stdout: JSON always, text unless quiet.
void write_report(const CommonOptions& options, const Console& console, const std::string& text);

}  // namespace bough::cli
