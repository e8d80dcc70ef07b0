#pragma once
/// \file Checks of a response: its coordinates against the model, its solution against the equation.
#include "base/diagnostic.hpp"
#include "modal/response/coordinates.hpp"

namespace bough::modal::response {

/// Errors above the first are a warning; above the second they end the solution.
inline constexpr double kAccuracyWarning = 1e-6, kAccuracyError = 1e-3;

/// Error of ΦᵀMΦ = 1 and ΦᵀKΦ = Λ, on which the equation of the coordinates depends.
struct BasisError {
  double worst = 0;
  /// The worst entry that round-off does not explain: up to kAccuracyError, or above 1e-13 of √(pᵢ pⱼ), pⱼ = Σ K_ii
  /// φ_ij². Next to parts 1e12 times as stiff the product with K has no digits, and the modes may be right
  /// nevertheless.
  double beyond_roundoff = 0;
};

/// Largest |φᵢᵀMφⱼ - δᵢⱼ| of coordinates with mass, and |φᵢᵀKφⱼ - λᵢ δᵢⱼ| / √|λᵢ λⱼ| of those with strain; both
/// products element by element.
BasisError calc_basis_error(const fe::Model& model, const ResponseModel& response);

/// |(Λ - ω² m + iωD + iS) q - P a| / |P a| of the worst frequency, each row over √max(|λ|, ω² m).
double calc_solution_error(const ResponseModel& response, const Spectrum& spectrum, const AddedCoordinates& added = {});

/// The worst residual of the equations A x = b that a direct solution solves: |D⁻¹ᐟ²(A x - b)| over |D⁻¹ᐟ²A x| and what
/// the entries of A alone could bring about, as linear::calc_residuals has it. Over frequency of each, over time of the
/// largest forces that were there: what is at rest has no separate residual.
class ResidualRecord {
 public:
  explicit ResidualRecord(bool is_over_time) : is_over_time_(is_over_time) {}
  /// D > 0: diagonal of A; real and imaginary parts count alike.
  void add(const VectorXd& D, const Eigen::VectorXcd& x, const Eigen::VectorXcd& A_x, const Eigen::VectorXcd& b);
  /// The largest relative residual so far; 0 without any.
  double worst() const;

 private:
  bool is_over_time_;
  double rest_ = 0, size_ = 0;
};

/// Reports the residual of a direct solution: warning, or ComputationError, modal.response-accuracy.
void report_residual(double residual, const SourceLocation& at, Diagnostics& diagnostics);

/// Warning, or ComputationError, modal.response-accuracy.
void report_accuracy(const BasisError& basis_error, double solution_error, const SourceLocation& at,
                     Diagnostics& diagnostics);

}  // namespace bough::modal::response
