#pragma once
/// \file Contents of a file of Bough: HDF5 of any kind, a .FLX or a flat body file.
#include <string>
#include <vector>

#include "formats/hdf5/files.hpp"
#include "formats/records/results.hpp"

namespace bough::analysis {

struct InfoAnswer {
  hdf5::FileInfo info;                       ///< attributes of the file; each array with shape and dimensions
  std::vector<records::EventRecord> events;  ///< of a results file
  std::vector<std::string> faults;           ///< arrays that are missing or have another shape than their layout
};

/// `file`: may name one body of a .FLX, "panels.FLX:2". Throws what demand_body_file() and the readers throw.
InfoAnswer list_contents(const std::string& file);

}  // namespace bough::analysis
