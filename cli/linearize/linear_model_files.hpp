#pragma once
/// \file A linear model as a .mat file and as tables.
#include <nlohmann/json.hpp>
#include <string>

#include "formats/records/linear_model.hpp"

namespace bough::cli {

/// A B C D, state_name, input_name, output_name; nothing else.
void write_linear_mat(const records::LinearModel& model, const std::string& path);
/// Size, operating point, accuracy, poles and zeros.
std::string format_linear_model(const records::LinearModel& model);
nlohmann::json make_json(const records::LinearModel& model);

}  // namespace bough::cli
