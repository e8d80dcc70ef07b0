#include "tests/fuzz/targets.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/diagnostic.hpp"
#include "formats/flat/detail/seal.hpp"
#include "formats/flat/flex_body.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/flx/layout.hpp"
#include "formats/flx/model_input.hpp"
#include "formats/hdf5/comparison_file.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/grids_file.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/hdf5/response_file.hpp"
#include "formats/hdf5/sparse_file.hpp"
#include "formats/hdf5/sweep_file.hpp"
#include "formats/hdf5/table_file.hpp"
#include "formats/matrices/matrix_reader.hpp"
#include "formats/matrices/mode_table.hpp"
#include "formats/matrices/op4.hpp"
#include "formats/nastran/field_editor.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/nastran/writer.hpp"
#include "formats/sid/sid.hpp"
#include "formats/toml/campaign.hpp"
#include "formats/toml/detail/text_columns.hpp"
#include "formats/toml/key_editor.hpp"
#include "formats/toml/specs.hpp"

namespace bough::fuzz {

namespace {

/// Returns true if it was read.
template <class Read>
bool survive(const Read& read) {
  try {
    read();
    return true;
  } catch (const Failure&) {
    return false;
  }
}

template <class Read>
void survive_messages(const Read& read) {
  Diagnostics found;
  survive([&] { read(found); });
}

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void read_deck(const std::string& path) {
  survive([&] {
    Diagnostics diagnostics;
    nastran::read_deck(path, {}, diagnostics);
  });
}

// Bytes packed for other ranks unpack to the same deck.
void read_packed(const std::string& path) {
  survive([&] {
    Diagnostics plain, packed;
    const auto deck = nastran::read_deck(path, {}, plain);
    const auto again = nastran::read_packed_deck(nastran::pack_deck(path), {}, packed);
    BOUGH_DEMAND(deck.grids.size() == again.grids.size() && deck.card_counts == again.card_counts);
  });
}

void edit_deck(const std::string& path) {
  survive([&] {
    Diagnostics diagnostics;
    const nastran::DeckEditor editor(path, diagnostics);
    std::vector<nastran::FieldEdit> edits;
    for (const auto& [card, number] : {std::pair("GRID", 4), std::pair("MAT1", 3), std::pair("SPC1", 12)})
      for (const char* id : {"1", "2"}) {
        nastran::FieldAddress address;
        address.card = card;
        address.id = id;
        address.occurrence = 1;
        address.number = number;
        if (const auto place = editor.find(address, {path}, diagnostics))
          edits.push_back({*place, "1.2345678901234+10"});
      }
    editor.write(path, edits);
  });
}

void edit_keys(const std::string& path) {
  survive([&] {
    std::string text = read_text(path);
    for (const char* key :
         {"body.name", "body.modes.number", "hinge.1.rate.1", "simulation.duration", "body.1.nodes.1"})
      toml_files::set_key(text, key, "7");
    toml_files::change_file_keys(text, [](const std::string& file) { return "x/" + file; });
    Diagnostics diagnostics;
    toml_files::check_text(text, path, diagnostics);
  });
}

// Two columns of a text file.
void read_table(const std::string& path) {
  for (const toml_files::ColumnChoice& choice : {toml_files::ColumnChoice{}, toml_files::ColumnChoice{"time", "3"}})
    survive([&] {
      Diagnostics diagnostics;
      std::vector<double> x, y;
      toml_files::read_columns(path, {path}, choice, x, y, diagnostics);
      BOUGH_DEMAND(x.size() == y.size());
    });
}

void read_body(const std::string& path) {
  survive([&] {
    Diagnostics diagnostics;
    toml_files::read_body_spec(path, diagnostics);
  });
}

void read_system(const std::string& path) {
  survive([&] {
    Diagnostics diagnostics;
    toml_files::read_system_spec(path, diagnostics);
  });
}

void read_campaign(const std::string& path) {
  survive([&] {
    Diagnostics diagnostics;
    toml_files::detect_kind(path);
    toml_files::read_campaign(path, diagnostics);
  });
}

using ReadHdf5 = void (*)(const std::string& path);
struct Hdf5Reader {
  const char* format;
  ReadHdf5 read;
};
const Hdf5Reader kHdf5Readers[] = {
    {"bough-flexbody", [](const std::string& path) { hdf5::read_flex_body(path); }},
    {"bough-flexbody", [](const std::string& path) { hdf5::read_modes(path); }},
    {"bough-flexbody", [](const std::string& path) { hdf5::read_grids(path); }},
    {"bough-modes", [](const std::string& path) { hdf5::read_modes(path); }},
    {"bough-modes", [](const std::string& path) { hdf5::read_grids(path); }},
    {"bough-results", [](const std::string& path) { hdf5::read_results(path); }},
    {"bough-results", [](const std::string& path) { hdf5::read_run_inputs(path); }},
    {"bough-results", [](const std::string& path) { hdf5::read_run_state(path); }},
    {"bough-results", [](const std::string& path) { hdf5::read_checkpoint(path); }},
    {"bough-linear", [](const std::string& path) { hdf5::read_linear_model(path); }},
    {"bough-outcomes", [](const std::string& path) { hdf5::read_outcomes(path); }},
    {"bough-matrices", [](const std::string& path) { hdf5::read_sparse_file(path); }},
    {"bough-matrices", [](const std::string& path) { hdf5::read_grids(path); }},
    {"bough-comparison", [](const std::string& path) { hdf5::read_comparison(path); }},
    {"bough-static", [](const std::string& path) { hdf5::read_static(path); }},
    {"bough-sweep", [](const std::string& path) { hdf5::read_sweep(path); }},
    {"bough-budget", [](const std::string& path) { hdf5::read_budget(path); }},
    {"bough-response", [](const std::string& path) { hdf5::read_model_response(path); }},
    {"bough-frequency", [](const std::string& path) { hdf5::read_response(path); }},
    {"bough-transient", [](const std::string& path) { hdf5::read_response(path); }},
};

// One look at the file serves every reader, and a file that does not stand it reaches none of them. Readers of another
// format look at its name and go: one of them, another each time.
void read_hdf5(const std::string& path) {
  if (!survive([&] { hdf5::read_info(path); })) return;
  std::string format;
  survive([&] { format = hdf5::read_format(path); });
  static std::size_t turn = 0;
  const std::size_t stranger = turn++ % std::size(kHdf5Readers);
  for (std::size_t i = 0; i < std::size(kHdf5Readers); ++i)
    if (i == stranger || format == kHdf5Readers[i].format) survive([&] { kHdf5Readers[i].read(path); });
}

// Millions of empty rows are legal, and slow under the sanitizers: they are left out.
bool claims_much(const std::string& path) {
  const std::string head = read_text(path).substr(0, 12);
  for (std::size_t at = 4; at + 4 <= head.size(); at += 4) {
    std::uint32_t words[2] = {};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto byte = static_cast<std::uint32_t>(static_cast<unsigned char>(head[at + i]));
      words[0] |= byte << (8 * i);
      words[1] |= byte << (24 - 8 * i);
    }
    constexpr std::uint32_t kMost = 100'000;
    if (std::all_of(words, words + 2, [](auto word) { return std::min(word, 0U - word) > kMost; })) return true;
  }
  return false;
}

void read_op4_binary(const std::string& path) {
  if (claims_much(path)) return;
  survive([&] { matrices::read_op4_binary(path); });
}

// With the right checksum: the arrays before it are what is of interest.
void read_flat(const std::string& path) {
  survive([&] { flat::read_flex_body(path); });
  std::string bytes = read_text(path);
  bytes.resize(bytes.size() - std::min(bytes.size(), flat::detail::kSealSize));
  bytes += flat::detail::make_seal(bytes);
  survive([&] { flat::parse_flex_body(bytes, path); });
}

// The matrices of a model of two dofs and one mode.
void read_model_matrices(const std::string& path) {
  survive([&] {
    flx::ModelInput model;
    model.num_nodes = 1;
    model.num_dofs = 2;
    model.num_modes_given = 1;
    model.damping_option = 1;
    Diagnostics diagnostics;
    flx::read_model_matrices(path, model, diagnostics);
  });
}

}  // namespace

const std::vector<Target>& get_targets() {
  static const std::vector<Target> targets = {
      {"nastran", read_deck},
      {"packed-deck", read_packed},
      {"deck-editor", edit_deck},
      {"key-editor", edit_keys},
      {"table", read_table},
      {"body", read_body},
      {"system", read_system},
      {"campaign", read_campaign},
      {"hdf5", read_hdf5},
      {"op4-text", [](const std::string& path) { survive([&] { matrices::read_op4_text(path); }); }},
      {"op4-binary", read_op4_binary},
      // Every other format of matrices is found by its content.
      {"matrices",
       [](const std::string& path) { survive_messages([&](auto& found) { matrices::read_matrices(path, found); }); }},
      // OP2 and punch.
      {"mode-tables", [](const std::string& path) { survive([&] { matrices::read_mode_tables(path); }); }},
      {"flat", read_flat},
      {"flx", [](const std::string& path) { survive([&] { flx::read_flx(path); }); }},
      {"layout", [](const std::string& path) { survive([&] { flx::parse_layout(read_text(path), path); }); }},
      {"sid", [](const std::string& path) { survive([&] { sid::read_sid(path); }); }},
      {"model-input",
       [](const std::string& path) { survive_messages([&](auto& found) { flx::read_model_input(path, found); }); }},
      {"model-matrices", read_model_matrices},
  };
  return targets;
}

const Target* find_target(const std::string& name) {
  for (const auto& target : get_targets()) {
    if (name == target.name) return &target;
  }
  return nullptr;
}

}  // namespace bough::fuzz
