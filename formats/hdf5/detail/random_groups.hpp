#pragma once
/// \file Random responses in the HDF5 file of a frequency response (docs/formats/response.md).
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"
#include "formats/records/random_response.hpp"

namespace bough::hdf5 {

/// Into /random/SET.
void write_random(FileWriter& file, const records::RandomResponse& response);
records::RandomResponse read_random(FileReader& file, const std::string& path);

}  // namespace bough::hdf5
