#pragma once
/// \file A linear model as a .mat file and as tables.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/matrices/mat_file.hpp"
#include "formats/records/linear_model.hpp"

namespace bough::cli {

/// A, B, C, D and names.
matrices::MatFields make_linear_fields(const records::LinearModel& model);
/// mass, damping, stiffness, input_force, state_force of the same of second order; none where it has no mass matrix.
matrices::MatFields make_second_order_fields(const records::LinearModel& model);
void write_linear_mat(const records::LinearModel& model, const std::string& path);
/// Size, operating point, accuracy, poles and zeros, multipliers, Hankel values.
std::string format_linear_model(const records::LinearModel& model);
/// The largest Hankel singular values and the sum of the others; "" if there are none.
std::string format_hankel(const records::Hankel& hankel);
/// [A B; C D] as one table: a row for each state's rate, then for each output; the first column names it.
std::string make_linear_csv(const records::LinearModel& model);
nlohmann::json make_json(const records::LinearModel& model);

}  // namespace bough::cli
