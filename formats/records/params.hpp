#pragma once
/// \file PARAM values and the one reader of real numbers as Nastran writes them.
#include <optional>
#include <string>
#include <string_view>

#include "formats/records/deck.hpp"

namespace bough::records {

/// A real: 1.0, .5, 1.0E-3, 1.0-3, 1.D2, and (as most decks need) an integer such as 7.
/// Infinity, NaN and numbers beyond double are not reals.
std::optional<double> parse_real(std::string_view text);

/// A PARAM as a real number in any Nastran spelling ("2.59-3", "1.D2"); `fallback` when absent. Reports fe.bad-param.
double get_real_param(const Deck& deck, const std::string& name, double fallback, Diagnostics& diagnostics);

}  // namespace bough::records
