#pragma once
/// \file Chapters of a system file's text without a results file: its start, and the shape of a pole in motion.
#include <string>

#include "analysis/linearize/linearize.hpp"
#include "base/diagnostic.hpp"
#include "report/page.hpp"

namespace bough::analysis {

/// Builds the system of `text` and takes the first sample of its run. Paths are relative to the folder of `file`.
/// \throws what loading and simulate throw.
report::Chapter make_preview(const std::string& file, const std::string& text, Diagnostics& diagnostics);

/// Linear model of a system file's text, as `bough linearize` makes it; request.file names its folder.
records::LinearModel linearize_text(const LinearizeRequest& request, const std::string& text, Diagnostics& diagnostics);

/// The system as it moves in one pole of that model: one period of Re(v exp(iθ)) about the operating point, v the
/// eigenvector, in 64 samples; positions, quaternions and modal coordinates as in the results of a run. The largest
/// coordinate moves by what is visible (5 % of the size of the bodies, 0.1 rad). Time goes from 0 to the period of the
/// pole, or 1/|λ| of a real one, or 1.
/// \param pole  counted from 0, as in records::Poles
/// \throws InputError "linear.no-pole" for a pole that is not there or moves no body
report::Chapter make_pole_motion(const LinearizeRequest& request, const std::string& text, int pole,
                                 Diagnostics& diagnostics);

}  // namespace bough::analysis
