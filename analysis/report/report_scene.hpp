#pragma once
/// \file The moving system of a run, out of the text that it was started with.
#include <string>

#include "analysis/report/report_files.hpp"
#include "formats/hdf5/files.hpp"
#include "report/history_chapter.hpp"

namespace bough::analysis {

/// Adds name, bodies, hinges, sensors and arrows; what cannot be drawn goes into history.missing. Time and channels of
/// the history are there.
void add_scene(const std::string& file, const hdf5::RunInputs& inputs, const ReportRequest& request,
               report::History& history);

}  // namespace bough::analysis
