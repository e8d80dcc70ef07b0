#pragma once
/// \file Tables and JSON of random responses.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "formats/records/random_response.hpp"

namespace bough::cli {

/// RMS and N0 of each quantity, at most `max_outputs` of each, the largest RMS first.
std::string format_random(const records::RandomResponse& response, std::size_t max_outputs);
/// RMS and N0 of every output; with `full` spectral densities and autocorrelations too.
nlohmann::json to_json(const records::RandomResponse& response, bool full);

}  // namespace bough::cli
