#include "cli/common/options.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/common/output_folder.hpp"
#include "analysis/common/ranks.hpp"
#include "analysis/common/text_file.hpp"
#include "base/file_roles.hpp"
#include "base/part_file.hpp"
#include "cli/common/command_help.hpp"
#include "cli/common/console.hpp"
#include "fe/linear/petsc.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

CLI::App* add_verb(CLI::App& app, const std::string& name) {
  const auto& help = get_command_help(name);
  auto* verb = app.add_subcommand(name, help.summary);
  verb->footer(help.footer);
  return verb;
}

CLI::App* add_verb(CLI::App& app, Action& action, const Action& run, const std::string& name,
                   const std::string* subject) {
  auto* verb = add_verb(app, name);
  verb->callback([&action, run, subject] {
    action = run;
    if (subject != nullptr) action = [run, subject] { return analysis::with_file(*subject, run); };
  });
  return verb;
}

void add_common_options(CLI::App& verb, CommonOptions& options, unsigned offers, const std::string& output_help) {
  if (offers & kOutput) {
    verb.add_option("-o,--output", options.output, output_help)->check([](const std::string& name) {
      return name.empty() ? std::string("the name is empty") : std::string();
    });
    auto* keep = verb.add_flag("--no-clobber", options.no_clobber, "Refuse to overwrite an existing output file");
    verb.add_flag("--force")->description("Overwrite an existing output file (the default)")->excludes(keep);
  }
  if (offers & kJson) verb.add_flag("--json", options.json, "Print JSON instead of tables");
  verb.add_flag("-q,--quiet", options.quiet, "Print errors only");
  verb.add_flag("-v,--verbose", options.verbosity, "Print more; may be repeated");
}

void add_set_option(CLI::App& verb, std::vector<std::string>& set) {
  verb.add_option("--set", set, "NAME=VALUE: another number for a parameter of [parameters]; may be repeated")
      ->allow_extra_args(false);
}

void check_outputs(const CommonOptions& options, const std::vector<std::string>& paths,
                   const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (paths[i].empty()) continue;
    check_output(options, paths[i], inputs);
    for (std::size_t k = 0; k < i; ++k)
      if (!paths[k].empty() && analysis::is_same_output(paths[k], paths[i]))
        throw InputError("cli.same-output", {paths[i]}, "two outputs of this call would be this one file",
                         "give each a different name");
  }
}

void check_output(const CommonOptions& options, const std::string& path, const std::vector<std::string>& inputs) {
  std::error_code ignored;
  analysis::check_place(path);
  for (const auto& input : inputs) {
    if (fs::equivalent(path, input, ignored))
      throw InputError("cli.output-is-input", {path}, "the output would overwrite the input file " + input,
                       "choose another file with -o");
  }
  note_output(path);
  if (options.no_clobber && fs::exists(path, ignored)) {
    throw InputError("cli.output-exists", {path}, "the output file exists",
                     "choose another name or leave out --no-clobber");
  }
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    throw ComputationError("cli.write", {path}, fs::is_directory(path, ignored) ? "is a folder" : "is no regular file",
                           "choose a file with -o");
  }
  if (is_file_locked(path))
    throw InputError("hdf5.busy", {path}, "another process writes this file", "wait until it ends, or choose another");
  std::error_code failed;
  const auto target = find_target(path, failed);
  if (failed) throw ComputationError("cli.write", {path}, failed.message(), "choose a file with -o");
  if (fs::exists(target, ignored) && access(target.c_str(), W_OK) != 0)
    throw ComputationError("cli.write", {path}, "the file is write-protected", "choose another with -o");
  const auto parent = fs::path(target).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  if (!fs::is_directory(folder, ignored))
    throw ComputationError("cli.write", {path}, "there is no folder " + folder, "make it, or choose another with -o");
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw ComputationError("cli.write", {path},
                           "the folder " + folder + " cannot be written: " + std::generic_category().message(errno),
                           "choose another with -o, or change its permissions");
  }
}

int print_written_files(const CommonOptions& options, const Console& console, const std::vector<std::string>& files) {
  for (const auto& file : files)
    if (!file.empty() && !options.json) console.print("written: " + file + "\n");
  return kSuccess;
}

void open_deck(Console& console, const CommonOptions& options, const std::string& deck,
               const std::vector<std::string>& outputs, std::vector<std::string> inputs) {
  console.set_subject(deck);
  inputs.insert(inputs.begin(), deck);
  analysis::do_once([&] {
    analysis::demand_deck(deck);
    check_outputs(options, outputs, inputs);
  });
  console.set_rank(linear::initialize_petsc().rank);
}

void write_report(const CommonOptions& options, const Console& console, const std::string& text) {
  if (options.output.empty()) {
    if (options.json || !options.quiet) console.print_data(text);
    return;
  }
  if (!console.is_root()) return;
  analysis::write_text_file(options.output, text);
  console.print("written: " + options.output + "\n");
}

}  // namespace bough::cli
