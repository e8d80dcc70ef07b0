#pragma once
/// \file Table and JSON of complex modes.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "formats/records/complex_modes.hpp"

namespace bough::cli {

std::string format_complex_modes(const records::ComplexModesResult& result);
nlohmann::json make_json(const records::ComplexModesResult& result);

}  // namespace bough::cli
