#pragma once
/// \file Matrices of controllers and tables of functions out of MATLAB and HDF5 files.
#include "formats/records/system_spec.hpp"

namespace bough::analysis {

/// A, B, C, D or gain of every state_space and gain with a `file`, unless the system file has them. Reports what
/// formats/matrices and formats/hdf5 do.
void read_controller_files(records::SystemSpec& spec, Diagnostics& diagnostics);
/// The points of tables that have a file and none yet: time_column and column name variables of a MATLAB file or
/// datasets of an HDF5 file, one column of several as "thrust:2". Reports "function.bad-column" and what the readers
/// do.
void read_function_files(records::SystemSpec& spec, Diagnostics& diagnostics);
/// Every file that a controller names, once.
std::vector<std::string> list_controller_files(const records::SystemSpec& spec);

}  // namespace bough::analysis
