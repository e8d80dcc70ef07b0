#pragma once
/// \file Matrices of controllers out of MATLAB and HDF5 files.
#include "formats/records/system_spec.hpp"

namespace bough::cli {

/// A, B, C, D or gain of every state_space and gain with a `file`, unless the system file has them. Reports what
/// formats/matrices and formats/hdf5 do.
void read_controller_files(records::SystemSpec& spec, Diagnostics& diagnostics);
/// Every file that a controller names, once.
std::vector<std::string> list_controller_files(const records::SystemSpec& spec);

}  // namespace bough::cli
