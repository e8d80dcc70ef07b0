#include <utility>

#include "fe/cards/element_properties.hpp"
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/statics/element_groups.hpp"
#include "fe/statics/element_recovery.hpp"

namespace bough::fe {
namespace {

using Eigen::Index;
using Groups = std::vector<RecoveryGroup>;
using Place = RecoveryLayout::Place;

std::vector<Place> list_places(const Groups& groups, std::size_t num_elements) {
  std::vector<Place> places(num_elements);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (std::size_t r = 0; r < groups[g].elements.size(); ++r)
      places[static_cast<std::size_t>(groups[g].elements[r])] = {static_cast<int>(g), static_cast<Index>(r)};
  return places;
}

void fill_ids(const Model& model, const std::unordered_map<int, int>& properties, RecoveryGroup& group) {
  for (const int e : group.elements) {
    const Element& element = *model.elements()[static_cast<std::size_t>(e)];
    const auto property = properties.find(element.id());
    group.id.push_back(element.id());
    group.property.push_back(property == properties.end() ? 0 : property->second);
  }
}

std::vector<StressPoint> list_points(const Element& element, bool of_strain) {
  const StressRecovery* recovery = element.stress_recovery();
  if (!recovery) return {};
  return of_strain ? recovery->strain_points() : recovery->stress_points();
}

Groups lay_out_groups(std::vector<ElementGroup> found) {
  Groups groups;
  for (auto& group : found)
    groups.push_back({std::move(group.name), std::move(group.components), std::move(group.elements), {}, {}});
  return groups;
}

Groups group_by_points(const Model& model, bool of_strain) {
  return lay_out_groups(group_elements(model, [of_strain](const Element& element, int) {
    const auto points = list_points(element, of_strain);
    if (points.empty()) return std::vector<std::string>{};
    return of_strain ? list_strain_result_names(points) : list_result_names(points);
  }));
}

}  // namespace

RecoveryLayout::RecoveryLayout(const Model& model, const records::Deck& deck, const RecoveredFields& fields) {
  const auto properties = list_element_properties(deck);
  const auto lay_out = [&](Groups groups) {
    for (auto& group : groups) fill_ids(model, properties, group);
    auto places = list_places(groups, model.elements().size());
    return Table{true, std::move(groups), std::move(places)};
  };
  if (fields.forces)
    forces = lay_out(lay_out_groups(
        group_elements(model, [](const Element& element, int) { return list_force_components(element); })));
  if (fields.stresses) stresses = lay_out(group_by_points(model, false));
  if (fields.strains) strains = lay_out(group_by_points(model, true));
}

}  // namespace bough::fe
