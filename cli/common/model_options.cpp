#include "cli/common/model_options.hpp"

#include <CLI/CLI.hpp>

namespace bough::cli {

void add_model_options(CLI::App& verb, analysis::ModelChoice& choice) {
  verb.add_option("--subcase", choice.subcase, "Subcase whose SPC, MPC, LOAD and METHOD are used (default: the first)");
  verb.add_flag("--free", choice.free, "Leave the SPC sets out: the free-free structure");
  verb.add_option("--mass", choice.mass, "Mass matrix: deck (PARAM,COUPMASS decides), lumped or consistent")
      ->check(CLI::IsMember({"deck", "lumped", "consistent"}))
      ->capture_default_str();
  verb.add_option("--ignore", choice.ignore_cards,
                  "Leave out this card, command or parameter though it changes the answer; may be repeated")
      ->allow_extra_args(false);
}

void add_listing_options(CLI::App& verb, analysis::ListingFiles& files) {
  verb.add_option("--f06", files.f06, "Write a listing in Nastran's order, by the output requests of the deck");
  verb.add_option("--op2", files.op2, "Write the same as a Nastran OUTPUT2 file");
}

}  // namespace bough::cli
