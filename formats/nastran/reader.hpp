#pragma once
/// \file Nastran decks: bytes to records::Deck.
#include <map>
#include <string>
#include <string_view>

#include "formats/records/deck.hpp"

namespace bough::nastran {

struct ReadOptions {
  std::vector<std::string> ignore_cards;  ///< --ignore CARD: not an error though it carries stiffness, mass, constraint
  /// read_dynamic_deck: what acts in responses alone counts (K2PP, TFL, EPOINT, ...); false: the loads are for residual
  /// vectors of normal modes.
  bool is_response = true;
  /// read_dynamic_deck: for complex modes. CMETHOD, TFL, K2PP, M2PP, B2PP and EIGC, TF, EPOINT count; the direct input
  /// does not join the matrices of the model. With is_response = false.
  bool is_complex = false;
  std::map<int, double> design_values = {};  ///< of DESVAR by id, in place of XINIT
};

/// Reads a deck or fragment with its INCLUDE files. Every error of the deck is added to `diagnostics` (none is thrown);
/// the record holds what could be read.
records::Deck read_deck(const std::string& path, const ReadOptions& options, Diagnostics& diagnostics);
/// Deck from memory; `name` is the file name in messages, INCLUDE is relative to the working directory.
records::Deck read_deck_text(std::string_view text, const std::string& name, const ReadOptions& options,
                             Diagnostics& diagnostics);

/// Contents of the files of a deck, and the errors of opening them, as bytes for the other processes of one run.
std::string pack_deck(const std::string& path);
/// The deck that read_deck would have made of those files, with the same diagnostics; no file is opened.
records::Deck read_packed_deck(std::string bytes, const ReadOptions& options, Diagnostics& diagnostics);

}  // namespace bough::nastran
