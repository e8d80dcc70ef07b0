#include <map>
#include <utility>

#include "fe/cards/element_properties.hpp"
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"
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

/// Elements of one card may differ in their number of points: "CTETRA" and "CTETRA-24".
Groups group_by_forces(const Model& model) {
  std::map<std::pair<std::string, int>, std::vector<int>> found;
  const auto& elements = model.elements();
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (const PrintedForces* forces = elements[e]->printed_forces())
      found[{elements[e]->card(), static_cast<int>(forces->printed_force_names().size())}].push_back(
          static_cast<int>(e));
  Groups groups;
  for (auto& [key, members] : found) {
    const bool is_more = !groups.empty() && groups.back().card == key.first;
    auto names = elements[static_cast<std::size_t>(members.front())]->printed_forces()->printed_force_names();
    groups.push_back({is_more ? key.first + "-" + std::to_string(key.second) : key.first,
                      std::move(names),
                      std::move(members),
                      {},
                      {}});
  }
  return groups;
}

std::vector<StressPoint> list_points(const Element& element, bool of_strain) {
  const StressRecovery* recovery = element.stress_recovery();
  if (!recovery) return {};
  return of_strain ? recovery->strain_points() : recovery->stress_points();
}

Groups group_by_points(const Model& model, bool of_strain) {
  std::map<std::pair<std::string, std::vector<std::string>>, std::vector<int>> found;
  const auto& elements = model.elements();
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (const auto points = list_points(*elements[e], of_strain); !points.empty())
      found[{elements[e]->card(), of_strain ? list_strain_result_names(points) : list_result_names(points)}].push_back(
          static_cast<int>(e));
  Groups groups;
  std::map<std::string, int> count;
  for (auto& [key, members] : found) {
    const int number = ++count[key.first];
    groups.push_back(
        {number == 1 ? key.first : key.first + "-" + std::to_string(number), key.second, std::move(members), {}, {}});
  }
  return groups;
}

}  // namespace

RecoveryLayout::RecoveryLayout(const Model& model, const records::Deck& deck, const RecoveredFields& fields) {
  const auto properties = list_element_properties(deck);
  const auto lay_out = [&](Groups groups) {
    for (auto& group : groups) fill_ids(model, properties, group);
    auto places = list_places(groups, model.elements().size());
    return Table{true, std::move(groups), std::move(places)};
  };
  if (fields.forces) forces = lay_out(group_by_forces(model));
  if (fields.stresses) stresses = lay_out(group_by_points(model, false));
  if (fields.strains) strains = lay_out(group_by_points(model, true));
}

}  // namespace bough::fe
