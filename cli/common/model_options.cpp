#include "cli/common/model_options.hpp"

#include <CLI/CLI.hpp>

#include "analysis/common/text_file.hpp"
#include "formats/listing/f06.hpp"
#include "formats/listing/op2.hpp"

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

void add_listing_options(CLI::App& verb, ListingOptions& options) {
  verb.add_option("--f06", options.f06, "Write a listing in Nastran's order, as the output requests of the deck say");
  verb.add_option("--op2", options.op2, "Write the same as a Nastran OUTPUT2 file");
}

void write_listings(const ListingOptions& options, const records::Listing& listing) {
  const auto op2 = options.op2.empty() ? std::string() : listing::make_op2(listing);
  if (!options.f06.empty()) analysis::write_text_file(options.f06, listing::make_f06(listing));
  if (!options.op2.empty()) analysis::write_text_file(options.op2, op2);
}

}  // namespace bough::cli
