#pragma once
/// \file Frequency response (SOL 108, 111) and transient response (SOL 109, 112) of a deck.
#include <optional>
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "analysis/frequency/notching.hpp"
#include "analysis/modes/eigen_choices.hpp"
#include "formats/records/deck_response.hpp"
#include "formats/records/listing.hpp"

namespace bough::analysis {

struct DeckResponseRequest {
  std::string deck;  ///< file
  ModelChoice model;
  EigenChoice eigen;
  bool is_transient = false;
  bool is_linear = false;                    ///< of decks of nonlinear transient response, whatever cards they have
  bool is_direct = false, is_modal = false;  ///< whatever SOL is; neither: by SOL
  bool no_residuals = false;                 ///< modes without residual vectors of the loads
  bool has_listing = false;                  ///< print file of the output requests
  std::vector<int> grids;                    ///< curves of these in addition to those of the case control
  NotchRequest notching;                     ///< of frequency responses
};

struct DeckResponseAnswer {
  records::DeckResponse response;
  SubcaseFailures failures;
  std::optional<records::Listing> listing;
  std::vector<Notch> notches;  ///< one per subcase if the request has notching; the response is that of notched inputs
};

/// Solves every subcase with a dynamic load, or the requested one, and the random responses of RANDPS. Collective.
/// \throws InputError and ComputationError of reading and of modal::response; those of all subcases if none has curves.
DeckResponseAnswer solve_deck_response(const DeckResponseRequest& request, Events& events);

}  // namespace bough::analysis
