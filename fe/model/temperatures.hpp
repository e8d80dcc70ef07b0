#pragma once
/// \file Temperature sets as loads, and what heated elements carry before they deform.
#include <unordered_map>

#include "fe/model/model.hpp"

namespace bough::fe {

/// What temperatures do to elements at u = 0: Element::add_thermal of every heated one. Internal forces are
/// Element::calc_internal_forces(u) + force, the strain energy is ½ uᵀKu - uᵀ load + energy.
struct InitialForces {
  struct Part {
    VectorXd force;  ///< internal forces
    VectorXd load;   ///< at the nodes, among those of the static load
    double energy = 0;
    VectorXd stress;  ///< beside those of `force`: Element::calc_initial_stresses
    VectorXd strain, corner_strain;  ///< Element::calc_thermal_strains, calc_corner_thermal_strains
  };
  std::unordered_map<const Element*, Part> of;  ///< all elements, on every rank

  const Part* find(const Element& element) const {
    const auto found = of.find(&element);
    return found == of.end() ? nullptr : &found->second;
  }
};

/// Of temperature set `set` (TEMP, TEMPD, TEMPRB, TEMPP1); 0: none. Reports fe.missing-load where the set has no card,
/// fe.missing-temperature where an element that expands has no temperature.
InitialForces calc_thermal(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics);

/// The loads on the g-set.
VectorXd sum_loads(const Model& model, const InitialForces& initial);

}  // namespace bough::fe
