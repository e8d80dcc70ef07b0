#pragma once
/// \file One HTML page of results, bodies, modes, responses and linear models.
#include <string>
#include <vector>

#include "analysis/common/events.hpp"

namespace bough::analysis {

struct ReportRequest {
  std::vector<std::string> files;     ///< a chapter each; bodies of a run are looked for among them
  std::vector<std::string> channels;  ///< of results, as for `plot`; empty: all
  std::string title;                  ///< empty: choose_report_name()
};

/// Name of the first file without folder and extension.
std::string choose_report_name(const ReportRequest& request);

/// Makes the page, which loads nothing from anywhere. Throws InputError "cli.no-report" and what the readers throw.
std::string make_report(const ReportRequest& request, Events& events);

}  // namespace bough::analysis
