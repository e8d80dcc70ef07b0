#pragma once
/// \file Notches as tables, JSON and comma-separated values.
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "analysis/frequency/notching.hpp"

namespace bough::cli {

/// A row per range of frequencies with a lowered input: its deepest factor, decibels, and the limit that is met there.
std::string format_notch(const analysis::Notch& notch);
/// Subcase, frequencies, factors and the limits that are met.
nlohmann::json to_json(const analysis::Notch& notch);
/// subcase, frequency_hz, factor, decibel.
std::string make_notch_csv(const std::vector<analysis::Notch>& notches);

}  // namespace bough::cli
