#pragma once
/// \file Parts of a results file, for its reader and for the writer that continues it.
#include <vector>

#include "formats/hdf5/detail/reader.hpp"
#include "formats/records/results.hpp"

namespace bough::hdf5 {

/// Events of the file; older files name no sources.
std::vector<records::EventRecord> read_events(FileReader& file);
/// A number; `otherwise` where it is absent or of another shape.
double read_real_attribute(hid_t object, const char* name, double otherwise);
/// NaN if it is absent.
double read_energy_error(FileReader& file);

}  // namespace bough::hdf5
