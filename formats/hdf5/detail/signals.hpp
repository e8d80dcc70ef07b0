#pragma once
/// \file Names and dimensions of states, inputs and outputs, as every file of linear models has them.
#include <string>

#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"
#include "formats/records/linear_model.hpp"

namespace bough::hdf5 {

/// Writes the datasets name and dims below `group`.
inline void write_signals(FileWriter& file, const std::string& group, const records::Signals& signals) {
  file.write_strings(group + "/name", signals.name);
  file.write_strings(group + "/dims", signals.dims);
}

/// Reads the datasets name and dims, of equal length, below `group`.
inline records::Signals read_signals(FileReader& file, const std::string& group) {
  records::Signals signals;
  signals.name = file.read_strings(group + "/name", -1);
  signals.dims = file.read_strings(group + "/dims", static_cast<long>(signals.name.size()));
  return signals;
}

}  // namespace bough::hdf5
