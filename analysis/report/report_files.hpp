#pragma once
/// \file Chapters of the report page, one from each file.
#include <string>
#include <vector>

#include "analysis/report/report.hpp"
#include "base/diagnostic.hpp"
#include "report/page.hpp"

namespace bough::analysis {

/// Chapter of an HDF5 file of Bough or of the JSON of `select`. Throws InputError "cli.no-report" for other files.
report::Chapter make_chapter(const std::string& file, const ReportRequest& request, Diagnostics& diagnostics);

/// Names and values of the attributes of a file: format, version of Bough, sources with their SHA-256.
std::vector<std::pair<std::string, std::string>> list_facts(const std::string& file);
/// The settings of a run.
std::vector<std::pair<std::string, std::string>> list_settings(const std::string& file);

/// Chapter of a flexible body: mass properties about Bo in frame B, modes, MAC, mass integrals, frequencies against
/// spin rate.
report::Chapter make_body_chapter(const std::string& file, Diagnostics& diagnostics);
/// Chapter of a modes or buckling file: mass properties in the basic system with the inertia about the origin, modes,
/// MAC.
report::Chapter make_modes_chapter(const std::string& file);
/// Chapter of `frequency` or `transient`: the largest curves of each quantity, their peaks, the modes.
report::Chapter make_response_chapter(const std::string& file);
/// Poles, Bode diagrams, singular values, margins of what `linearize` wrote; all but the poles of what `response` did.
report::Chapter make_linear_chapter(const std::string& file);
/// Chapter of what `response` wrote: Bode diagrams, singular values, peak gain, margins.
report::Chapter make_model_response_chapter(const std::string& file);
/// Chapter of the complex modes of a deck, with the Campbell diagram of its rotors.
report::Chapter make_complex_chapter(const std::string& file);
/// Chapter of `linearize --sweep` or `--each`: Campbell diagram, root locus, instabilities.
report::Chapter make_sweep_chapter(const std::string& file);
/// Chapter of a run: histories of the requested channels, energy, events, the moving system. Throws InputError for an
/// unknown channel.
report::Chapter make_results_chapter(const std::string& file, const ReportRequest& request, Diagnostics& diagnostics);

}  // namespace bough::analysis
