#pragma once
/// \file /recovery of a flexible-body file.
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"

namespace bough::hdf5 {

/// Nothing without recovery.
void write_recovery(FileWriter& file, const records::FlexBody& body);
/// After modes and locators.
void read_recovery(FileReader& file, records::FlexBody& body);

}  // namespace bough::hdf5
