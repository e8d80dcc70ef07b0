#pragma once
/// \file A linear model as tables and as JSON.
#include <nlohmann/json.hpp>
#include <string>

#include "formats/records/linear_model.hpp"

namespace bough::cli {

/// Size, operating point, accuracy, poles and zeros, multipliers, Hankel values.
std::string format_linear_model(const records::LinearModel& model);
/// The largest Hankel singular values and the sum of the others; "" if there are none.
std::string format_hankel(const records::Hankel& hankel);
/// Matrices, names, operating point and poles as JSON.
nlohmann::json make_json(const records::LinearModel& model);

}  // namespace bough::cli
