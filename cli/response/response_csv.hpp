#pragma once
/// \file The frequency response of a linear model as a table.
#include <string>

#include "formats/records/frequency_response.hpp"

namespace bough::cli {

/// frequency_hz, OUTPUT/INPUT:real and :imag of each pair, singular values sigma1, sigma2, ...
std::string make_response_csv(const records::FrequencyResponse& response);

}  // namespace bough::cli
