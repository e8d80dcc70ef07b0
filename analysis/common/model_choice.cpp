#include "analysis/common/model_choice.hpp"

#include "fe/model/sets.hpp"
#include "fe/statics/preload.hpp"

namespace bough::analysis {

fe::ModelOptions make_model_options(const ModelChoice& choice) {
  fe::ModelOptions model;
  model.subcase = choice.subcase;
  model.ignore_spc = choice.free;
  model.ignore_cards = choice.ignore_cards;
  if (choice.mass == "lumped") model.mass_kind = fe::MassKind::Lumped;
  if (choice.mass == "consistent") model.mass_kind = fe::MassKind::Consistent;
  return model;
}

std::shared_ptr<const fe::Prestress> calc_prestress(const records::Deck& deck, const fe::ModelOptions& options,
                                                    Diagnostics& diagnostics) {
  Diagnostics unknown;  // build_model() reports a subcase that is not there
  return fe::calc_subcase_prestress(deck, options, fe::select_subcase(deck, options.subcase, unknown), diagnostics);
}

}  // namespace bough::analysis
