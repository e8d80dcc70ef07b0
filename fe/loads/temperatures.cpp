#include "fe/loads/temperatures.hpp"

#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "fe/cards/temperature_set.hpp"
#include "formats/records/selection.hpp"

namespace bough::fe {
namespace {

/// Cards that heat what is not there, and two of them that differ for one grid or element.
void report_slips(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics) {
  std::unordered_set<int> lines, plates;
  for (const auto& element : model.elements()) {
    if (!element->thermal_loads()) continue;
    const std::string type = element->shape().type;
    if (type == "line2") lines.insert(element->id());
    if (type.rfind("tri", 0) == 0 || type.rfind("quad", 0) == 0) plates.insert(element->id());
  }
  const std::string of_set = " of temperature set " + std::to_string(set);
  const auto look = [&](const auto& cards, const std::string& card, const char* what, auto&& get_id, auto&& is_there,
                        auto&& is_same) {
    std::unordered_map<int, std::size_t> first;
    for (std::size_t i = 0; i < cards.size(); ++i) {
      if (cards[i].sid != set) continue;
      const int id = get_id(cards[i]);
      const auto [known, is_new] = first.emplace(id, i);
      if (!is_new && !is_same(cards[known->second], cards[i]))
        diagnostics.error("fe.duplicate-temperature", deck.locate(cards[i].at),
                          card + of_set + " gives " + what + " " + std::to_string(id) + " another temperature",
                          "remove one of the two cards");
      if (is_new && !is_there(id))
        diagnostics.warning("fe.unused-temperature", deck.locate(cards[i].at),
                            card + of_set + " names " + what + " " + std::to_string(id) +
                                ", which is not there or takes none by this card",
                            "correct the id or remove it");
    }
  };
  const auto get_element = [](const auto& c) { return c.element; };
  const auto& cards = deck.temperatures;
  look(
      cards.grids, "TEMP", "grid", [](const auto& c) { return c.g; },
      [&](int id) { return model.find_node(id) >= 0 || model.is_refused(id); },
      [](const auto& a, const auto& b) { return a.t == b.t; });
  look(
      cards.bars, "TEMPRB", "element", get_element, [&](int id) { return lines.count(id) > 0; },
      [](const auto& a, const auto& b) {
        return a.t_a == b.t_a && a.t_b == b.t_b && a.gradient_a == b.gradient_a && a.gradient_b == b.gradient_b;
      });
  look(
      cards.plates, "TEMPP1", "element", get_element, [&](int id) { return plates.count(id) > 0; },
      [](const auto& a, const auto& b) { return a.t == b.t && a.gradient == b.gradient; });
}

/// Temperatures of the card of the element, else of its grids; `missing`: the first grid without a temperature.
std::optional<ElementTemperature> find_temperature(const Model& model, const TemperatureSet& set,
                                                   const Element& element, int& missing) {
  std::vector<int> grids;
  for (const int node : element.nodes()) grids.push_back(model.node(node).id);
  return set.find(element.id(), find_temperature_kind(element.shape().type), grids, missing);
}

}  // namespace

InitialForces calc_thermal(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics) {
  InitialForces result;
  if (set == 0) return result;
  const TemperatureSet temperatures(deck.temperatures, set);
  if (temperatures.is_empty()) {
    diagnostics.error("fe.missing-load", deck.locate(records::find_selection(deck, "TEMPERATURE", set)),
                      "temperature set " + std::to_string(set) + " has no TEMP, TEMPD, TEMPRB or TEMPP1 card",
                      "correct TEMPERATURE(LOAD) or add its cards");
    return result;
  }
  report_slips(model, deck, set, diagnostics);
  const int from = model.subcase().initial_temperature;
  const TemperatureSet initial(deck.temperatures, from);
  if (from != 0 && initial.is_empty()) {
    diagnostics.error("fe.missing-load", deck.locate(records::find_selection(deck, "TEMPERATURE(INITIAL)", from)),
                      "temperature set " + std::to_string(from) + " has no TEMP, TEMPD, TEMPRB or TEMPP1 card",
                      "correct TEMPERATURE(INITIAL) or add its cards");
    return result;
  }
  if (from != 0 && from != set) report_slips(model, deck, from, diagnostics);
  int num_missing = 0, first_grid = 0, first_set = set;
  const Element* first_missing = nullptr;
  for (const auto& element : model.elements()) {
    const ThermalLoads* thermal = element->thermal_loads();
    if (!thermal) continue;
    int grid = 0;
    auto T = find_temperature(model, temperatures, *element, grid);
    const auto T_0 = T && from != 0 ? find_temperature(model, initial, *element, grid) : std::nullopt;
    if (!T || (from != 0 && !T_0)) {
      if (num_missing++ == 0) first_missing = element.get(), first_grid = grid, first_set = T ? from : set;
      continue;
    }
    if (T_0) T->initial = &*T_0;
    result.of.emplace(element.get(), thermal->calc_thermal(*T));
  }
  if (first_missing)
    diagnostics.error("fe.missing-temperature",
                      deck.locate(first_set == set ? records::find_selection(deck, "TEMPERATURE", set)
                                                   : records::find_selection(deck, "TEMPERATURE(INITIAL)", from)),
                      first_missing->card() + " " + std::to_string(first_missing->id()) +
                          " has no temperature in set " + std::to_string(first_set) + ": none is given for grid " +
                          std::to_string(first_grid) +
                          (num_missing > 1 ? " (and " + std::to_string(num_missing - 1) + " elements more)" : ""),
                      "add TEMP for the grid, or TEMPD for all grids that have none");
  return result;
}

VectorXd sum_loads(const Model& model, const InitialForces& initial) {
  VectorXd F = VectorXd::Zero(model.num_gdofs());
  // In the order of the model: the sum must not depend on that of the map.
  for (const auto& element : model.elements())
    if (const auto* part = initial.find(*element))
      for (int i = 0; i < element->num_dofs(); ++i) F[element->gdofs()[static_cast<std::size_t>(i)]] += part->load[i];
  return F;
}

}  // namespace bough::fe
