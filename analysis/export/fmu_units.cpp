#include "analysis/export/fmu_units.hpp"

#include <algorithm>
#include <cmath>

#include "formats/records/dims.hpp"

namespace bough::analysis {

FmuUnits::FmuUnits(const std::string& text) {
  if (text.empty()) return;
  names_ = name_units(text);
  factors_ = parse_units(text);
}

std::string FmuUnits::add(const std::string& dims, bool is_angle) {
  const auto powers = dims.empty() ? std::nullopt : records::parse_dims(dims);
  if (!powers) return "";
  for (const double power : *powers)
    if (power != std::round(power)) return "";
  const auto [mass, length, time] = *powers;
  const bool is_number = mass == 0 && length == 0 && time == 0;
  if (is_number ? !is_angle : !names_) return "";
  // M L/T^2 is a force: "N.m" rather than "kg.m2/s2".
  std::vector<std::pair<std::string, int>> parts{{"rad", is_angle ? 1 : 0}};
  const auto append = [&](const std::string& name, double power) { parts.emplace_back(name, static_cast<int>(power)); };
  if (names_ && mass != 0 && time == -2 * mass && !names_->force.empty()) {
    append(names_->force, mass);
    append(names_->length, length - mass);
  } else if (names_) {
    append(names_->mass, mass);
    append(names_->length, length);
    append(names_->time, time);
  }
  std::string above, below;
  int num_below = 0;
  for (const auto& [name, power] : parts) {
    if (power == 0) continue;
    if (name.empty()) return "";
    std::string& to = power > 0 ? above : below;
    num_below += power < 0 ? 1 : 0;
    to += (to.empty() ? "" : ".") + name + (std::abs(power) > 1 ? std::to_string(std::abs(power)) : "");
  }
  const std::string divisor = num_below > 1 ? "(" + below + ")" : below;
  fmu::Unit unit{(above.empty() ? "1" : above) + (below.empty() ? "" : "/" + divisor),
                 static_cast<int>(mass),
                 static_cast<int>(length),
                 static_cast<int>(time),
                 is_angle ? 1 : 0,
                 std::pow(factors_.mass, mass) * std::pow(factors_.length, length) * std::pow(factors_.time, time)};
  if (std::abs(unit.factor - 1) < 1e-12) unit.factor = 1;
  const auto is_same = [&](const fmu::Unit& known) { return known.name == unit.name; };
  if (std::none_of(list_.begin(), list_.end(), is_same)) list_.push_back(unit);
  return unit.name;
}

}  // namespace bough::analysis
