#pragma once
/// \file Static solutions (SOL 101) of the subcases of a deck.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "formats/records/listing.hpp"
#include "formats/records/static_result.hpp"

namespace bough::analysis {

struct StaticRequest {
  static constexpr int kDefaultIncrements = 10;
  std::string deck;  ///< file
  ModelChoice model;
  std::vector<std::string> grid_forces;  ///< ids of grids whose forces are listed, or "all"; empty: none
  bool is_linear = false;                ///< the linear solution of a nonlinear SOL
  /// Large displacements and rotations; also without it where a nonlinear SOL has PARAM,LGDISP,1 or 2.
  bool is_nonlinear = false;
  int num_increments = kDefaultIncrements;  ///< of each subcase of these
  bool has_increments = false;              ///< num_increments is given, even as the default
  bool has_strains = false;                 ///< strains of elements too
  bool has_listing = false;                 ///< print file of the output requests
  bool has_arc_length = false;              ///< nonlinear subcases pass limit points
};

/// Takes the subcases in the order of the deck, those of one model together, combinations last.
class StaticReceiver {
 public:
  virtual ~StaticReceiver() = default;
  /// Before the first subcase. `keeps`: get_kept() is called for combinations.
  virtual void begin(bool keeps) = 0;
  /// Before the first add(). The model may change afterwards.
  virtual void set_model(const fe::Model& model) = 0;
  /// Receives the results of further subcases.
  virtual void add(std::vector<records::StaticSubcase> subcases) = 0;
  /// Returns true if more subcases are of no use: a file cannot be written.
  virtual bool has_failed() { return false; }
  /// Returns the subcases received, for combinations; after begin(true).
  virtual const std::vector<records::StaticSubcase>& get_kept() = 0;
};

struct StaticAnswer {
  SubcaseFailures failures;  ///< of the subcases without a solution
  std::optional<records::Listing> listing;
  std::vector<std::pair<std::string, std::string>> source;  ///< file, SHA-256
};

/// Solves every subcase with a load, or the requested one, then SUBCOM, SYMCOM and REPCASE. Collective.
/// \throws InputError "cli.bad-grids", "cli.nonlinear-static", "cli.nonlinear-output",
/// "cli.nonlinear-ranks"; the failures of all subcases if none has a solution;
/// what reading and fe throw.
StaticAnswer solve_static(const StaticRequest& request, StaticReceiver& receiver, Events& events);

}  // namespace bough::analysis
