#include "fe/statics/build_model.hpp"

#include "fe/model/suport.hpp"
#include "fe/statics/guyan.hpp"
#include "fe/statics/preload_check.hpp"

namespace bough::fe {

Model build_model(const records::Deck& deck, const ModelOptions& options, const ElementFactory& elements,
                  Diagnostics& diagnostics) {
  Model model = Model::build(deck, options, elements, diagnostics);  // nodes, constraints, elements, AUTOSPC
  auto stiffness = check_preload(model, options.ignore_spc, diagnostics);
  model = std::move(model).with_stiffness(std::move(stiffness));
  model = reduce_to_aset(std::move(model), deck, diagnostics);
  report_suport(model, deck, diagnostics);
  return model;
}

Model build_model(const records::Deck& deck, const ModelOptions& options, Diagnostics& diagnostics) {
  return build_model(deck, options, make_elements, diagnostics);
}

}  // namespace bough::fe
