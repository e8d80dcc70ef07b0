#pragma once
/// \file What a results file says of its run, beside the samples.
#include <string>

#include "formats/hdf5/detail/growing_file.hpp"
#include "formats/records/results.hpp"

namespace bough::hdf5 {

/// Of a new file: format, versions, the input files.
void write_provenance(GrowingFile& file, const records::ResultsHeader& header);
/// /system and /settings; a resumed run writes its own over those of before.
void write_settings(GrowingFile& file, const records::ResultsHeader& header);
/// Whether the run has come to its end, and why it ended.
void write_state(GrowingFile& file, bool completed, const std::string& reason);

}  // namespace bough::hdf5
