#pragma once
/// \file Input files: what they are, read once for all ranks, with their hashes.
#include <string>
#include <utility>
#include <vector>

#include "fe/model/model.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/records/body_spec.hpp"
#include "formats/records/deck.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::analysis {

/// Returns true if the text ends so, case aside: ".h5", ".toml".
bool has_suffix(const std::string& path, const std::string& suffix);

/// Reads a deck on the first rank and hands it to the others. Collective.
records::Deck read_deck_once(const std::string& path, const std::vector<std::string>& ignore_cards,
                             Diagnostics& diagnostics);
/// Reads a deck like read_deck_once, with the cards of responses and complex modes (nastran/dynamic_reader.hpp).
records::DynamicDeck read_dynamic_deck_once(const std::string& path, const nastran::ReadOptions& options,
                                            Diagnostics& diagnostics);
/// Reads a body file on the first rank and hands it to the others. Collective.
records::BodySpec read_body_spec_once(const std::string& path, Diagnostics& diagnostics);
/// Reads a deck, throws InputError with all its errors; warnings stay in `diagnostics`. Collective.
records::Deck read_deck_or_throw(const std::string& path, const fe::ModelOptions& options, Diagnostics& diagnostics);
/// (file name, SHA-256) of each; nothing on the ranks that write no file.
std::vector<std::pair<std::string, std::string>> calc_sources(const std::vector<std::string>& files);

/// Throws InputError("cli.no-file") when the path is no readable file.
void demand_file(const std::string& path);
/// Throws InputError("cli.wrong-file") when a TOML file is of another kind than the one expected ("body", "system"),
/// with the command that takes it; "" is unknown and passes: the reader reports missing parts.
void demand_kind(const std::string& path, const std::string& kind, const std::string& expected);
/// Throws InputError "cli.wrong-file" for a .INT file of TREETOPS: it is recognized by its name, and no deck.
void refuse_treetops_input(const std::string& path);
/// Throws InputError "cli.wrong-file" for a deck in place of a system file, by its name: .bdf, .nas.
void refuse_deck(const std::string& path);
/// Demands that the file is a deck; InputError("cli.wrong-file") if it is HDF5 or TOML.
void demand_deck(const std::string& path);

}  // namespace bough::analysis
