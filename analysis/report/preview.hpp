#pragma once
/// \file The start of a system file's text as the chapter of a run: the first sample, drawn as the page draws a run.
#include <string>

#include "base/diagnostic.hpp"
#include "report/page.hpp"

namespace bough::analysis {

/// Builds the system of `text` and takes the first sample of its run. Paths are relative to the folder of `file`.
/// \throws what loading and simulate throw.
report::Chapter make_preview(const std::string& file, const std::string& text, Diagnostics& diagnostics);

}  // namespace bough::analysis
