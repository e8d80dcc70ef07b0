#include "cli/common/options.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "base/file_roles.hpp"
#include "base/part_file.hpp"
#include "cli/common/console.hpp"
#include "cli/common/old_commands.hpp"
#include "cli/common/ranks.hpp"
#include "cli/common/subcase_failures.hpp"
#include "cli/common/text_file.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/matrices/superelements.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/toml/specs.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

CLI::App* add_verb(CLI::App& app, const std::string& name, const std::string& what) {
  return app.add_subcommand(name, what);
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

namespace {

/// Where this process may write: a property of the process, as its working folder is.
std::string& get_output_folder() {
  static std::string folder;
  return folder;
}

fs::path find_real_path(const std::string& path) {
  std::error_code failed;
  const auto target = find_target(path, failed);
  const auto real = fs::weakly_canonical(fs::absolute(target, failed), failed);
  return real.empty() ? fs::path(target) : real;
}

}  // namespace

bool is_inside(const std::string& path, const std::string& folder) {
  const auto real = find_real_path(path).lexically_relative(find_real_path(folder.empty() ? "." : folder));
  return !real.empty() && *real.begin() != "..";
}

void confine_outputs(const std::string& folder) { get_output_folder() = folder; }

void check_outputs(const CommonOptions& options, const std::vector<std::string>& paths,
                   const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (paths[i].empty()) continue;
    check_output(options, paths[i], inputs);
    for (std::size_t k = 0; k < i; ++k)
      if (!paths[k].empty() && find_real_path(paths[k]) == find_real_path(paths[i]))
        throw InputError("cli.same-output", {paths[i]}, "two outputs of this call would be this one file",
                         "give each a name of its own");
  }
}

void check_place(const std::string& path) {
  if (get_output_folder().empty() || is_inside(path, get_output_folder())) return;
  throw InputError("cli.output-outside", {path}, "the file does not lie in " + get_output_folder(),
                   "let the steps of a campaign write into the case's own folder, or give --force-outside");
}

void check_output(const CommonOptions& options, const std::string& path, const std::vector<std::string>& inputs) {
  std::error_code ignored;
  check_place(path);
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

void write_report(const CommonOptions& options, const Console& console, const std::string& text) {
  if (options.output.empty()) {
    if (options.json || !options.quiet) console.print_data(text);
    return;
  }
  if (!console.is_root()) return;
  write_text_file(options.output, text);
  console.print("written: " + options.output + "\n");
}

int with_file(const std::string& file, const std::function<int()>& act, const std::string& excluded_file) {
  const auto is_of_reduce = [](const Diagnostic& item) { return item.id.starts_with("reduce."); };
  const auto place = [&](const Failure& failure) {
    auto items = failure.items();
    for (auto& item : items) {
      if (!excluded_file.empty() && item.where.file == excluded_file && item.where.line == 0 && !is_of_reduce(item))
        item.where.file.clear();
      item = locate(std::move(item), file);
    }
    return items;
  };
  try {
    return act();
  } catch (const InputError& failure) {
    throw InputError(place(failure));
  } catch (const ComputationError& failure) {
    throw ComputationError(place(failure));
  }
}

void with_prior_messages(const Diagnostics& prior, const std::function<void()>& act) {
  const auto join = [&prior](const Failure& failure) {
    Diagnostics own, all;
    for (const auto& item : failure.items()) own.add(item);
    add_new(prior, all);
    add_new(own, all);
    return all.items();
  };
  try {
    act();
  } catch (const InputError& failure) {
    throw InputError(join(failure));
  } catch (const ComputationError& failure) {
    throw ComputationError(join(failure));
  }
}

bool has_suffix(const std::string& path, const std::string& suffix) {
  auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return path.size() >= suffix.size() && std::equal(suffix.rbegin(), suffix.rend(), path.rbegin(), same);
}

void demand_file(const std::string& path) {
  std::error_code failed;
  const auto kind = fs::status(path, failed).type();
  const bool is_stream =
      kind == fs::file_type::fifo || kind == fs::file_type::character || kind == fs::file_type::socket;
  if (is_stream)
    throw InputError("cli.no-file", {path}, "is a pipe or a device, not a regular file, and input is read twice",
                     "write it to a file first");
  if (kind != fs::file_type::regular || !std::ifstream(path)) {
    throw InputError("cli.no-file", {path},
                     kind == fs::file_type::directory ? "is a folder, not a file" : "no such file, or not readable",
                     "check the path");
  }
  note_input(path);
}

void demand_kind(const std::string& path, const std::string& kind, const std::string& expected) {
  if (kind.empty() || kind == expected) return;
  const std::string verb = kind == "body" ? "reduce" : kind == "system" ? "run" : "batch";
  throw InputError("cli.wrong-file", {path}, "the file is a " + kind + " file, expected a " + expected + " file",
                   "bough " + verb + " takes it" + (kind == "campaign" ? ", with --dry-run to check it" : ""));
}

void demand_deck(const std::string& path) {
  demand_file(path);
  refuse_treetops_input(path);
  std::string begin(8, '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), 8);
  const bool is_hdf5 = begin == "\x89HDF\r\n\x1a\n";
  if (!is_hdf5 && !has_suffix(path, ".toml")) return;
  throw InputError("cli.wrong-file", {path},
                   std::string("the file is ") + (is_hdf5 ? "HDF5" : "TOML") + ", expected a Nastran deck",
                   is_hdf5 ? "bough info tells what it holds" : "bough check tells what it is");
}

records::Deck read_deck_once(const std::string& path, const std::vector<std::string>& ignore_cards,
                             Diagnostics& diagnostics) {
  auto deck = is_one_of_many() ? nastran::read_packed_deck(share([&] { return nastran::pack_deck(path); }),
                                                           {ignore_cards}, diagnostics)
                               : nastran::read_deck(path, {ignore_cards}, diagnostics);
  matrices::read_superelements(deck, diagnostics);
  return deck;
}

records::BodySpec read_body_spec_once(const std::string& path, Diagnostics& diagnostics) {
  if (!is_one_of_many()) return toml_files::read_body_spec(path, diagnostics);
  const auto text = share([&] {
    demand_file(path);
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  });
  return toml_files::read_body_spec_text(text, path, diagnostics);
}

records::Deck read_deck_or_throw(const std::string& path, const fe::ModelOptions& options, Diagnostics& diagnostics) {
  do_once([&] { demand_deck(path); });
  auto deck = read_deck_once(path, options.ignore_cards, diagnostics);
  // A deck with errors is still taken as far as it goes, so that one pass shows all of them.
  if (diagnostics.num_errors() > 0) fe::build_model(deck, options, diagnostics);
  diagnostics.throw_if_errors();
  return deck;
}

std::vector<std::pair<std::string, std::string>> calc_sources(const std::vector<std::string>& files) {
  std::vector<std::pair<std::string, std::string>> source;
  if (Console::get_launch_rank() != 0) return source;
  for (const auto& file : files) source.emplace_back(fs::path(file).filename().string(), hdf5::calc_sha256(file));
  return source;
}

}  // namespace bough::cli
