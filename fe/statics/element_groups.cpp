#include "fe/statics/element_groups.hpp"

#include <map>
#include <utility>

#include "fe/elements/stress_state.hpp"

namespace bough::fe {

std::vector<ElementGroup> group_elements(
    const Model& model, const std::function<std::vector<std::string>(const Element&, int)>& list_components) {
  std::map<std::pair<std::string, std::vector<std::string>>, std::vector<int>> found;
  const auto& elements = model.elements();
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (auto components = list_components(*elements[e], static_cast<int>(e)); !components.empty())
      found[{elements[e]->card(), std::move(components)}].push_back(static_cast<int>(e));
  std::vector<ElementGroup> groups;
  std::string card;
  int number = 0;
  for (auto& [key, members] : found) {
    number = key.first == card ? number + 1 : 1;
    card = key.first;
    groups.push_back({number == 1 ? card : card + "-" + std::to_string(number), key.second, std::move(members)});
  }
  return groups;
}

std::vector<std::string> list_force_components(const Element& element) {
  const auto* forces = element.printed_forces();
  return forces ? forces->printed_force_names() : std::vector<std::string>{};
}

}  // namespace bough::fe
