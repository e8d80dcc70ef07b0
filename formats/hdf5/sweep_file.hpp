#pragma once
/// \file Linear models along a parameter, frequency responses and pointing budgets (docs/formats/linear.md).
#include <string>

#include "formats/records/frequency_response.hpp"
#include "formats/records/linear_sweep.hpp"
#include "formats/records/pointing_budget.hpp"
#include "formats/records/random_outputs.hpp"

namespace bough::hdf5 {

/// Throw as the functions of formats/hdf5/files.hpp.
void write_sweep(const records::LinearSweep& sweep, const std::string& path);
/// All but the models' Hankel values and multipliers.
records::LinearSweep read_sweep(const std::string& path);

/// Contents of a file of `bough response`.
struct ResponseOfModel {
  records::FrequencyResponse response;
  records::PeakGain peak;  ///< is_certified is not in the file
  records::Margins margins;
  bool has_margins = false;
  records::RandomOutputs random;
  bool has_random = false;
};
/// Reads the frequency response of a linear model, its peak gain and its margins.
ResponseOfModel read_model_response(const std::string& path);

/// `margins`: of a loop, or nullptr. `random`: of --psd, or nullptr.
void write_response(const records::FrequencyResponse& response, const records::PeakGain& peak,
                    const records::Margins* margins, const records::RandomOutputs* random, const std::string& path);

/// Writes the tables and curves of a pointing budget.
void write_budget(const records::PointingBudget& budget, const std::string& path);
/// Reads the tables and curves of a pointing budget.
records::PointingBudget read_budget(const std::string& path);

}  // namespace bough::hdf5
