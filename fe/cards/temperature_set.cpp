#include "fe/cards/temperature_set.hpp"

namespace bough::fe {

TemperatureKind find_temperature_kind(std::string_view shape) {
  if (shape == "line2") return TemperatureKind::Line;
  return shape.rfind("tri", 0) == 0 || shape.rfind("quad", 0) == 0 ? TemperatureKind::Plate : TemperatureKind::Grids;
}

TemperatureSet::TemperatureSet(const records::TemperatureCards& cards, int set) {
  const auto fill = [set](const auto& list, auto& map, auto key) {
    for (const auto& card : list)
      if (card.sid == set) map[key(card)] = &card;
  };
  const auto by_element = [](const auto& card) { return card.element; };
  fill(cards.grids, grids_, [](const auto& card) { return card.g; });
  fill(cards.bars, bars_, by_element);
  fill(cards.plates, plates_, by_element);
  for (const auto& card : cards.defaults)
    if (card.sid == set) default_ = card.t;
}

std::optional<ElementTemperature> TemperatureSet::find(int element, TemperatureKind kind, const std::vector<int>& grids,
                                                       int& missing) const {
  ElementTemperature T;
  T.node.resize(static_cast<Eigen::Index>(grids.size()));
  if (const auto bar = bars_.find(element); kind == TemperatureKind::Line && bar != bars_.end()) {
    T.node << bar->second->t_a, bar->second->t_b;
    T.gradient_a = bar->second->gradient_a;
    T.gradient_b = bar->second->gradient_b;
    return T;
  }
  if (const auto plate = plates_.find(element); kind == TemperatureKind::Plate && plate != plates_.end()) {
    T.node.setConstant(plate->second->t);
    T.gradient_z = plate->second->gradient;
    return T;
  }
  for (Eigen::Index i = 0; i < T.node.size(); ++i) {
    const int id = grids[static_cast<std::size_t>(i)];
    const auto grid = grids_.find(id);
    if (grid == grids_.end() && !default_) {
      missing = id;
      return std::nullopt;
    }
    T.node[i] = grid != grids_.end() ? grid->second->t : *default_;
  }
  return T;
}

}  // namespace bough::fe
