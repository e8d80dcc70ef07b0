#include "formats/records/flex_body.hpp"

#include <algorithm>

namespace bough::records {

int FlexBody::find_node(int id) const {
  const auto it = std::find(node_id.begin(), node_id.end(), id);
  return it == node_id.end() ? -1 : static_cast<int>(it - node_id.begin());
}

int FlexBody::find_locator(int node, int direction) const {
  const auto it = std::find_if(locators.begin(), locators.end(),
                               [&](const Locator& l) { return l.node == node && l.direction == direction; });
  return it == locators.end() ? -1 : static_cast<int>(it - locators.begin());
}

const MassIntegrals& FlexBody::integrals() const {
  if (integrals_method == "lumped") return lumped;
  if (integrals_method == "consistent") return consistent;
  return exact;
}

}  // namespace bough::records
