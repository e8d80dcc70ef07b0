#include "fe/model/model.hpp"

namespace bough::fe {

Model Model::build(const records::Deck& deck, const ModelOptions& options, Diagnostics& diagnostics) {
  return build(deck, options, make_elements, diagnostics);
}

}  // namespace bough::fe
