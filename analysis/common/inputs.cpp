#include "analysis/common/inputs.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "analysis/common/ranks.hpp"
#include "analysis/common/superelements.hpp"
#include "base/file_roles.hpp"
#include "base/input_bytes.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/nastran/dynamic_reader.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/toml/specs.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

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
  if (kind != fs::file_type::regular || ::access(path.c_str(), R_OK) != 0) {
    throw InputError("cli.no-file", {path},
                     kind == fs::file_type::directory ? "is a folder, not a file" : "no such file, or not readable",
                     "check the path");
  }
  note_input(path);
}

void demand_kind(const std::string& path, const std::string& kind, const std::string& expected) {
  if (kind.empty() || kind == expected) return;
  const std::string verb = kind == "body"     ? "reduce"
                           : kind == "system" ? "run"
                           : kind == "psd"    ? "response --psd"
                           : kind == "budget" ? "response --budget"
                                              : "batch";
  throw InputError("cli.wrong-file", {path}, "the file is a " + kind + " file, expected a " + expected + " file",
                   "bough " + verb + " takes it" + (kind == "campaign" ? ", with --dry-run to check it" : ""));
}

void refuse_treetops_input(const std::string& path) {
  if (!has_suffix(path, ".int")) return;
  const auto text = read_input(path);
  if (text && (text->find("GRID") != std::string::npos || text->find("BEGIN BULK") != std::string::npos)) return;
  throw InputError("cli.wrong-file", {path}, "the file is a .INT of TREETOPS, which Bough does not read",
                   "describe the system in TOML: bough init lists examples to start from, bough edit asks for each key "
                   "(docs/coming-from-treetops.md)");
}

void refuse_deck(const std::string& path) {
  if (!has_suffix(path, ".bdf") && !has_suffix(path, ".nas")) return;
  throw InputError("cli.wrong-file", {path}, "the file is a Nastran deck by its name, expected a system file",
                   "bough init " + path + " writes a body file and a system file for it");
}

void demand_deck(const std::string& path) {
  demand_file(path);
  refuse_treetops_input(path);
  const bool is_hdf5 = read_input_head(path, 8) == "\x89HDF\r\n\x1a\n";
  if (!is_hdf5 && !has_suffix(path, ".toml")) return;
  throw InputError("cli.wrong-file", {path},
                   std::string("the file is ") + (is_hdf5 ? "HDF5" : "TOML") + ", expected a Nastran deck",
                   is_hdf5 ? "bough info lists its contents" : "bough check identifies it");
}

records::Deck read_deck_once(const std::string& path, const std::vector<std::string>& ignore_cards,
                             Diagnostics& diagnostics) {
  auto deck = is_one_of_many() ? nastran::read_packed_deck(share([&] { return nastran::pack_deck(path); }),
                                                           {ignore_cards}, diagnostics)
                               : nastran::read_deck(path, {ignore_cards}, diagnostics);
  join_superelements(deck, diagnostics);
  return deck;
}

records::DynamicDeck read_dynamic_deck_once(const std::string& path, const nastran::ReadOptions& options,
                                            Diagnostics& diagnostics) {
  auto deck = is_one_of_many() ? nastran::read_packed_dynamic_deck(share([&] { return nastran::pack_deck(path); }),
                                                                   options, diagnostics)
                               : nastran::read_dynamic_deck(path, options, diagnostics);
  join_superelements(deck, diagnostics);
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
  if (get_launch_rank() != 0) return source;
  for (const auto& file : files) source.emplace_back(fs::path(file).filename().string(), hdf5::calc_sha256(file));
  return source;
}

}  // namespace bough::analysis
