#pragma once
/// \file Temperatures of the elements of a deck, by the cards of one set.
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "fe/elements/thermal_loads.hpp"
#include "formats/records/deck_temperatures.hpp"

namespace bough::fe {

/// Cards that heat an element in addition to those of its grids: TEMPRB of lines, TEMPP1 of plates.
enum class TemperatureKind { Line, Plate, Grids };
/// Returns the kind of a shape, such as "line2" or "quad4".
TemperatureKind find_temperature_kind(std::string_view shape);

/// Represents the cards of one set by what they heat: TEMP, TEMPD, TEMPRB, TEMPP1. `cards` must outlive this.
class TemperatureSet {
 public:
  TemperatureSet(const records::TemperatureCards& cards, int set);

  /// Returns true if the set has no card.
  bool is_empty() const { return grids_.empty() && bars_.empty() && plates_.empty() && !default_; }
  /// Temperatures of the card of the element, else of its grids.
  /// \param grids  ids; a line has two.
  /// \param[out] missing  the first grid without a temperature, where the result is empty.
  std::optional<ElementTemperature> find(int element, TemperatureKind kind, const std::vector<int>& grids,
                                         int& missing) const;

 private:
  std::unordered_map<int, const records::GridTemperature*> grids_;
  std::unordered_map<int, const records::BarTemperature*> bars_;
  std::unordered_map<int, const records::PlateTemperature*> plates_;
  std::optional<double> default_;
};

}  // namespace bough::fe
