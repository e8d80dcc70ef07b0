#pragma once
/// \file Dimensions as texts: "M L^2/T^2", "F L", "1/T", "1".
#include <array>
#include <optional>
#include <string>

namespace bough::records {

/// Exponents of mass, length and time; nothing for other texts.
std::optional<std::array<double, 3>> parse_dims(const std::string& text);

}  // namespace bough::records
