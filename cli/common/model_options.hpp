#pragma once
/// \file Options of the commands that make a finite-element model of a deck, and of those that list its results.
#include "analysis/common/model_choice.hpp"
#include "analysis/listing/listing_files.hpp"

namespace CLI {
class App;
}

namespace bough::cli {

/// Adds --subcase, --free, --mass and --ignore to a command.
void add_model_options(CLI::App& verb, analysis::ModelChoice& choice);

/// Adds --f06 and --op2 to a command.
void add_listing_options(CLI::App& verb, analysis::ListingFiles& files);

}  // namespace bough::cli
