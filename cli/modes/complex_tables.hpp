#pragma once
/// \file Table and JSON of complex modes.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "formats/records/complex_modes.hpp"

namespace bough::cli {

/// Table of eigenvalues, frequencies [Hz], damping g and damping ratios, then the number of unstable modes and the
/// eigensolver.
std::string format_complex_modes(const records::ComplexModesResult& result);
/// The numbers of the table as JSON, with method, norm and shift.
nlohmann::json make_json(const records::ComplexModesResult& result);

}  // namespace bough::cli
