#include "solver/forces/spring.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace bough::solver {

using records::SpringSense;

std::vector<ForceChannel> SpringElement::channels() const {
  return {{"length", 1, "distance of its two ends", "L"},
          {"rate", 1, "rate of the length", "L/T"},
          {"force", 1, "tension: positive pulls its ends together", "F"}};
}

template <class T>
std::array<T, 2> SpringElement::calc_tension(const std::array<T, 2>& at, double& stored) const {
  constexpr bool kHasEnergy = std::is_same_v<T, double>;
  const T length = at[0], rate = at[1], stretch = length - law_.free_length;
  T elastic = law_.preload + law_.stiffness * stretch;
  if constexpr (kHasEnergy) stored = (law_.preload + 0.5 * law_.stiffness * stretch) * stretch;
  if (law_.spring) {
    const auto table = law_.spring->calc(length);
    elastic += table.y;
    if constexpr (kHasEnergy) stored += table.integral;
  }
  T damper = law_.damping * rate;
  if (law_.damper) damper += law_.damper->calc(rate).y;

  const double sign = law_.sense == SpringSense::Compression ? -1 : 1;
  if (law_.sense != SpringSense::Both) {
    // One-sided springs are linear: their energy is zero at the slack length.
    elastic = sign * std::max(T(0.0), sign * elastic);
    if constexpr (kHasEnergy)
      stored = law_.stiffness > 0 ? 0.5 * elastic * elastic / law_.stiffness : elastic * stretch;
    damper = elastic == T(0) ? T(0) : sign * std::max(-sign * elastic, sign * damper);
  }
  return {elastic, damper};
}

ForceResult SpringElement::calc(const Tree& tree, const TreeData& data, Loads* loads) const {
  const MarkerInWorld a = calc_marker_in_world(data, tree, from_), b = calc_marker_in_world(data, tree, to_);
  const Vector3d d = b.place - a.place;
  double length = d.norm();
  if (!std::isfinite(length)) length = d.stableNorm();  // the squares of far ends have no number
  const Vector3d along = length > 0 ? Vector3d(d / length) : Vector3d::Zero();
  const double rate = along.dot(b.v - a.v);
  double stored = 0;
  const auto [elastic, damper] =
      evaluate_law<2, 2>(data.tangents, {this, "force", name()}, 0, {length, rate},
                         [&](const auto& at) { return calc_tension(at, stored); }, {calc_reach(a.place, b.place), 0});
  const double driven = law_.function ? data.functions[*law_.function].calc(data.t).f : 0;
  const double tension = elastic + damper + driven;
  if (loads != nullptr) {
    loads->add_wrench(from_, tension * along, Vector3d::Zero());
    loads->add_wrench(to_, -tension * along, Vector3d::Zero());
  }
  ForceResult result;
  result.strain = stored;
  result.power = -elastic * rate;
  result.dissipated = damper * rate;
  result.values = {length, rate, tension};
  return result;
}

}  // namespace bough::solver
