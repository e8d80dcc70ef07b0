/// Prestress as a step of ModelBuilder.
#include <algorithm>

#include "fe/elements/stress_state.hpp"
#include "fe/model/builder.hpp"

namespace bough::fe {

void ModelBuilder::set_prestress() {
  model_.prestress_ = options_.prestress;
  if (!model_.prestress_) return;
  // Elements after those of the cards, made of masses and matrices of a subcase, have no internal forces.
  const auto& force = model_.prestress_->force;
  const auto num = std::min(force.size(), model_.elements_.size());
  for (std::size_t e = 0; e < num; ++e) {
    if (force[e].size() == 0) continue;
    const StressState* state = model_.elements_[e]->stress_state();
    BOUGH_DEMAND(state && force[e].size() == state->num_internal_forces());
    model_.prestressed_.emplace(model_.elements_[e].get(), &force[e]);
  }
}

}  // namespace bough::fe
