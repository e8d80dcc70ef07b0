#include "options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "bough/formats/hdf5/files.hpp"
#include "bough/formats/nastran/reader.hpp"
#include "bough/formats/toml/specs.hpp"
#include "console.hpp"
#include "ranks.hpp"

namespace bough::cli {

namespace fs = std::filesystem;

void add_common_options(CLI::App& verb, CommonOptions& options, unsigned offers, const std::string& output_help) {
  if (offers & kOutput) {
    verb.add_option("-o,--output", options.output, output_help);
    auto* keep = verb.add_flag("--no-clobber", options.no_clobber, "Refuse to overwrite an existing output file");
    verb.add_flag("--force")->description("Overwrite an existing output file (the default)")->excludes(keep);
  }
  if (offers & kJson) verb.add_flag("--json", options.json, "Print JSON instead of tables");
  verb.add_flag("-q,--quiet", options.quiet, "Print errors only");
  verb.add_flag("-v,--verbose", options.verbosity, "Print more; may be repeated");
}

void check_output(const CommonOptions& options, const std::string& path) {
  if (options.no_clobber && fs::exists(path)) {
    throw InputError("cli.output-exists", {path}, "the output file exists",
                     "choose another name or leave out --no-clobber");
  }
}

bool has_suffix(const std::string& path, const std::string& suffix) {
  auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return path.size() >= suffix.size() && std::equal(suffix.rbegin(), suffix.rend(), path.rbegin(), same);
}

void demand_file(const std::string& path) {
  if (!fs::is_regular_file(path) || !std::ifstream(path)) {
    throw InputError("cli.no-file", {path},
                     fs::is_directory(path) ? "is a folder, not a file" : "no such file, or not readable",
                     "check the path");
  }
}

records::Deck read_deck_once(const std::string& path, const std::vector<std::string>& ignore_cards,
                             Diagnostics& diagnostics) {
  if (!is_one_of_many()) return nastran::read_deck(path, {ignore_cards}, diagnostics);
  return nastran::read_packed_deck(share([&] { return nastran::pack_deck(path); }), {ignore_cards}, diagnostics);
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
  do_once([&] { demand_file(path); });
  auto deck = read_deck_once(path, options.ignore_cards, diagnostics);
  // A deck with errors is still taken as far as it goes, so that one pass shows all of them.
  if (diagnostics.num_errors() > 0) fe::Model::build(deck, options, diagnostics);
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
