#pragma once
/// \file What holds a response: its coordinates against the model, its solution against the equation.
#include "base/diagnostic.hpp"
#include "modal/response/coordinates.hpp"

namespace bough::modal::response {

/// Above it a number is told as a warning; a solution error above the other ends the solution.
inline constexpr double kAccuracyWarning = 1e-6, kAccuracyError = 1e-3;

/// Of ΦᵀMΦ = 1 and ΦᵀKΦ = Λ, which the equation of the coordinates takes for granted: largest |φᵢᵀMφⱼ - δᵢⱼ| of those
/// with mass, and |φᵢᵀKφⱼ - λᵢ δᵢⱼ| / √|λᵢ λⱼ| of those with strain; both sides assembled from the elements anew.
double calc_basis_error(const fe::Model& model, const ResponseModel& response);

/// |(Λ - ω² m + iωD + iS) q - P a| / |P a| of the worst frequency, each row over √max(|λ|, ω² m).
double calc_solution_error(const ResponseModel& response, const Spectrum& spectrum);

/// Warning, or ComputationError, modal.response-accuracy.
void report_accuracy(double basis_error, double solution_error, const SourceLocation& at, Diagnostics& diagnostics);

}  // namespace bough::modal::response
