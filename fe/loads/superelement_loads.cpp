#include "fe/elements/superelement.hpp"
#include "fe/loads/load_sets.hpp"

namespace bough::fe {

bool add_superelement_loads(const LoadTarget& t) {
  bool is_found = false;
  for (const auto& card : t.deck.super.seload) {
    if (card.set != t.set) continue;
    is_found = true;
    VectorXd load;
    for (const auto& element : t.model.elements()) {
      const auto* superelement = dynamic_cast<const Superelement*>(element.get());
      if (!superelement || superelement->id() != card.superelement) continue;
      load = superelement->get_load(card.load);
      for (Eigen::Index i = 0; i < load.size(); ++i)
        t.F[superelement->gdofs()[static_cast<std::size_t>(i)]] += t.scale * load[i];
    }
    if (load.size() == 0)
      t.diagnostics.error("fe.superelement-load", t.deck.locate(card.at),
                          "SELOAD names load " + std::to_string(card.load) + " of superelement " +
                              std::to_string(card.superelement) + ", whose section and matrices have no such load",
                          "correct LIDSE: DTI SELOAD of the .pch file lists the loads");
  }
  return is_found;
}

}  // namespace bough::fe
