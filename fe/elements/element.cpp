#include "fe/elements/element.hpp"

#include "fe/elements/stress_state.hpp"

namespace bough::fe {

const PrintedForces* Element::printed_forces() const { return stress_state(); }

void Element::add_structural_damping(double g, Eigen::Ref<MatrixXd> K) const {
  if (g + structural_damping_ != 0) add_stiffness(g + structural_damping_, K);
}

void ElementList::add(std::unique_ptr<const Element> element) {
  cards.insert(element->card());
  has_damping = has_damping || element->damping() != nullptr;
  elements.push_back(std::move(element));
}

}  // namespace bough::fe
