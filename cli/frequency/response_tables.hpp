#pragma once
/// \file Tables and JSON of `frequency` and `transient`.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "formats/records/deck_response.hpp"

namespace bough::cli {

/// Frequencies or times, coordinates, and the largest values of each quantity: at most `max_curves` of each, the
/// largest first.
std::string format_response(const records::ResponseSubcase& subcase, bool is_over_time, std::size_t max_curves);
/// Peaks of every curve; with `full` their samples too.
nlohmann::json to_json(const records::ResponseSubcase& subcase, bool is_over_time, bool full);

}  // namespace bough::cli
