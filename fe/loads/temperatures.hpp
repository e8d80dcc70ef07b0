#pragma once
/// \file Temperature sets as loads, and the internal forces of heated elements before they deform.
#include <unordered_map>

#include "fe/elements/thermal_loads.hpp"
#include "fe/model/model.hpp"

namespace bough::fe {

/// Effect of temperatures at u = 0 on every heated element; its load is part of the static load.
struct InitialForces {
  std::unordered_map<const Element*, ThermalState> of;  ///< all elements, on every rank

  /// Returns the state of a heated element; nullptr if it is not heated.
  const ThermalState* find(const Element& element) const {
    const auto found = of.find(&element);
    return found == of.end() ? nullptr : &found->second;
  }
};

/// Initial forces of temperature set `set` (TEMP, TEMPD, TEMPRB, TEMPP1); 0: none. Reports fe.missing-load if the set
/// has no card, fe.missing-temperature if an element that expands has no temperature.
InitialForces calc_thermal(const Model& model, const records::Deck& deck, int set, Diagnostics& diagnostics);

/// The loads on the g-set.
VectorXd sum_loads(const Model& model, const InitialForces& initial);

}  // namespace bough::fe
