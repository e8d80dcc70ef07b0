#include "cli/common/model_options.hpp"

#include <CLI/CLI.hpp>

#include "fe/model/sets.hpp"
#include "fe/statics/preload.hpp"

namespace bough::cli {

void add_model_options(CLI::App& verb, DeckModelOptions& options) {
  verb.add_option("--subcase", options.subcase,
                  "Subcase whose SPC, MPC, LOAD and METHOD are used (default: the first)");
  verb.add_flag("--free", options.free, "Leave the SPC sets out: the free-free structure");
  verb.add_option("--mass", options.mass, "Mass matrix: deck (PARAM,COUPMASS decides), lumped or consistent")
      ->check(CLI::IsMember({"deck", "lumped", "consistent"}))
      ->capture_default_str();
  verb.add_option("--ignore", options.ignore_cards,
                  "Leave out this card, command or parameter though it changes the answer; may be repeated")
      ->allow_extra_args(false);
}

fe::ModelOptions make_model_options(const DeckModelOptions& options) {
  fe::ModelOptions model;
  model.subcase = options.subcase;
  model.ignore_spc = options.free;
  model.ignore_cards = options.ignore_cards;
  if (options.mass == "lumped") model.mass_kind = fe::MassKind::Lumped;
  if (options.mass == "consistent") model.mass_kind = fe::MassKind::Consistent;
  return model;
}

std::shared_ptr<const fe::Prestress> calc_prestress(const records::Deck& deck, const fe::ModelOptions& options,
                                                    Diagnostics& diagnostics) {
  Diagnostics unknown;  // build_model() reports a subcase that is not there
  return fe::calc_subcase_prestress(deck, options, fe::select_subcase(deck, options.subcase, unknown), diagnostics);
}

}  // namespace bough::cli
