#include "fe/model/builder.hpp"

namespace bough::fe {

void ModelBuilder::add_drawn_lines() {
  for (const auto& card : deck_.plotel) {
    const std::string who = "PLOTEL " + std::to_string(card.id);
    ElementShape line{"line2", {}};
    for (const int grid : {card.ga, card.gb}) {
      const int index = model_.find_node(grid);
      if (index >= 0 && model_.nodes_[index].num_dofs == 6) {
        line.nodes.push_back(index);
        continue;
      }
      if (index < 0 && model_.is_refused(grid)) continue;
      diagnostics_.error("fe.missing-grid", deck_.locate(card.at),
                         who + " refers to grid " + std::to_string(grid) +
                             (index < 0 ? ", which the deck does not define" : ", which is a scalar point"),
                         "refer to a GRID");
    }
    if (line.nodes.size() == 2) model_.drawn_lines_.emplace_back(card.id, std::move(line));
  }
}

}  // namespace bough::fe
