#pragma once
/// \file Executive and case control: which solution, which sets.
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "formats/nastran/detail/lines.hpp"
#include "formats/nastran/detail/matrix_selection.hpp"
#include "formats/nastran/reader.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::nastran::detail {

struct ControlOptions {
  /// Receives the commands of responses; null: these commands are reported as not used.
  records::DynamicDeck* dynamics = nullptr;
  /// Receives SUBCOM, SYMCOM and REPCASE, and their errors (deck.combination). Both or none; with dynamics.
  std::vector<records::CaseCombination>* combinations = nullptr;
  Diagnostics* combination_diagnostics = nullptr;
  /// Receives SURFACE, VOLUME and SET of OUTPUT(POST), and their errors; null: unused.
  records::CaseRequests* post = nullptr;
  Diagnostics* post_diagnostics = nullptr;
  /// Receives the options of output requests in brackets, by file and line; null: unused.
  std::map<std::pair<int, int>, std::string>* request_options = nullptr;
  bool notes_combinations = true;       ///< without `combinations`: they are named as not used
  LoadColumns* load_columns = nullptr;  ///< where P2G goes
  bool is_response = true;              ///< with `dynamics`: use the commands of responses
  bool is_complex = false;              ///< with `dynamics`: those of complex modes count (ReadOptions)
  bool is_whole = false;                ///< with is_complex: the deck is written again, all that it selects is kept
  /// Commands that are only warned of (deck.unsupported-command); of ReadOptions.
  std::vector<std::string> ignore_cards = {};
  std::set<int> superelements = {};  ///< that have a section: subcases of SUPER = n are not the model's
  /// Receives SPC, MPC and METHOD of these subcases, by superelement; null: unused.
  std::map<int, std::vector<records::Subcase>>* component_cases = nullptr;
};

/// Reads the sections before the bulk data into deck.sol, deck.subcases and (PARAM in case control) deck.params.
/// Returns the index of the first bulk data line. A text without CEND and BEGIN BULK is bulk data from its first line.
/// Adds deck.no-begin-bulk, deck.unsupported-section, deck.case-control-value, deck.case-control-ignored,
/// deck.unsupported-command.
std::size_t read_control(const Source& source, records::Deck& deck, Diagnostics& diagnostics,
                         const ControlOptions& options = {});

}  // namespace bough::nastran::detail
