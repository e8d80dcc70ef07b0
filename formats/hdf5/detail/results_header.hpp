#pragma once
/// \file What a results file says of its run, beside the samples.
#include <string>

#include "formats/hdf5/detail/growing_file.hpp"
#include "formats/records/results.hpp"

namespace bough::hdf5 {

/// Of a new file: format, versions, the input files.
void write_provenance(GrowingFile& file, const records::ResultsHeader& header);
/// /system, which a resumed run leaves as it was, and /settings, over those of before.
void write_settings(GrowingFile& file, const records::ResultsHeader& header);
/// A row of /resumed: when, and with which system file.
void write_resumed(GrowingFile& file, const records::ResultsHeader& header, double time);
/// @energy_error of /energy.
void write_energy_error(GrowingFile& file, double worst);
/// Adds to the root's @wall_time, seconds that the run took; a resumed run goes on counting.
void add_wall_time(GrowingFile& file, double seconds);
/// Whether the run has come to its end, and why it ended.
void write_state(GrowingFile& file, bool completed, const std::string& reason);

}  // namespace bough::hdf5
