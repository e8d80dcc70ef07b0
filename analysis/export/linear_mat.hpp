#pragma once
/// \file Arrays of a linear model for MATLAB.
#include <string>

#include "formats/matrices/mat_file.hpp"
#include "formats/records/linear_sweep.hpp"

namespace bough::analysis {

/// A, B, C, D and names.
matrices::MatFields make_linear_fields(const records::LinearModel& model);
/// mass, damping, stiffness, input_force, state_force of the same of second order; none if it has no mass matrix.
matrices::MatFields make_second_order_fields(const records::LinearModel& model);
/// Writes A, B, C, D, names and the fields of make_second_order_fields() to a MATLAB file.
void write_linear_mat(const records::LinearModel& model, const std::string& path);

/// Arrays of models for ss(): A is nx x nx x N1 x N2 ..., one index for each parameter, with names and values of these.
matrices::MatFields make_sweep_fields(const records::LinearSweep& sweep);
/// Writes make_sweep_fields() to a MATLAB file.
void write_sweep_mat(const records::LinearSweep& sweep, const std::string& path);

}  // namespace bough::analysis
