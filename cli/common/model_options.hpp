#pragma once
/// \file Options of the verbs that make a finite-element model of a deck, and of those that list its results.
#include <string>

#include "analysis/common/model_choice.hpp"
#include "formats/records/listing.hpp"

namespace CLI {
class App;
}

namespace bough::cli {

/// Adds --subcase, --free, --mass and --ignore to a command.
void add_model_options(CLI::App& verb, analysis::ModelChoice& choice);

struct ListingOptions {
  std::string f06, op2;
  /// Returns true if neither a listing nor an OUTPUT2 file is requested.
  bool empty() const { return f06.empty() && op2.empty(); }
};

/// Adds --f06 and --op2 to a command.
void add_listing_options(CLI::App& verb, ListingOptions& options);

/// On the first rank.
void write_listings(const ListingOptions& options, const records::Listing& listing);

}  // namespace bough::cli
