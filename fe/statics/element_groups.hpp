#pragma once
/// \file Elements of one card with the same components: the blocks of element results.
#include <functional>
#include <string>
#include <vector>

#include "fe/model/model.hpp"

namespace bough::fe {

struct ElementGroup {
  std::string name;  ///< "CQUAD4"; further groups of the card "CQUAD4-2", "CQUAD4-3" (records::get_card_of_group)
  std::vector<std::string> components;
  std::vector<int> elements;  ///< indices into Model::elements()
};

/// Groups the elements of a model by card, then by components, both in alphabetical order.
/// \param list_components  of an element with its index; no components: in no group.
std::vector<ElementGroup> group_elements(
    const Model& model, const std::function<std::vector<std::string>(const Element&, int)>& list_components);

/// Components of the forces that are printed for an element; none without.
std::vector<std::string> list_force_components(const Element& element);

}  // namespace bough::fe
