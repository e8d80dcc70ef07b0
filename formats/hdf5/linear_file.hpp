#pragma once
/// \file Linear models (docs/formats/linear.md).
#include <string>

#include "formats/records/linear_model.hpp"

namespace bough::hdf5 {

inline constexpr const char* kLinearFormatVersion = "1.1";

/// Throw as the functions of formats/hdf5/files.hpp.
void write_linear_model(const records::LinearModel& model, const std::string& path);
records::LinearModel read_linear_model(const std::string& path);

}  // namespace bough::hdf5
