#pragma once
/// \file The coordinates of a driven model over frequency and over time.
#include <functional>
#include <utility>
#include <vector>

#include "modal/response/frequency_list.hpp"
#include "modal/response/response_model.hpp"

namespace bough::modal::response {

using Eigen::MatrixXcd;

/// A column per frequency; e^{iωt}.
struct Spectrum {
  VectorXd hz;
  MatrixXcd q;  ///< n x nf
  MatrixXcd d;  ///< k x nf: motion of the supports
  MatrixXcd a;  ///< (m + 3k) x nf: amplitudes of the loads
};
/// Amplitudes of the loads ((m + 3k): of F, M Ψ, B Ψ, K_s Ψ) and of the motions d of the supports (k).
Eigen::VectorXcd calc_amplitudes(const Excitation& excitation, double hz, Eigen::VectorXcd& d);
/// Throws ComputationError "modal.unbounded-response" with the frequency.
[[noreturn]] void throw_unbounded(double hz, const std::string& why);

/// Keeps the frequencies at which the response has a bound: of a list over an undamped mode the others count.
class BoundedFrequencies {
 public:
  /// Calls solve(); returns false if it throws modal.unbounded-response, which is stored. Other exceptions pass
  /// through.
  bool take(const std::function<void()>& solve);
  /// Issues a warning for each omitted frequency; throws the first one as an error if no frequency is left.
  void report(Diagnostics& diagnostics) const;

 private:
  int num_kept_ = 0;
  std::vector<Diagnostic> left_out_;
};

/// Additions Φᵀ Z Φ (n x n) and Φᵀ Z Ψ (n x k) to the matrices of q and of d at a frequency; empty: none.
using AddedCoordinates = std::function<std::pair<MatrixXcd, MatrixXcd>(double hz)>;

/// (Λ - ω² + iωD + iS + Φᵀ Z Φ) q = P a - Φᵀ Z Ψ d. Leaves frequencies of undamped modes out, and 0 Hz where the model
/// is free or its supports move by a velocity or an acceleration (BoundedFrequencies): Spectrum::hz are those that are
/// left.
Spectrum calc_spectrum(const ResponseModel& model, const Excitation& excitation, const VectorXd& hz,
                       Diagnostics& diagnostics, const AddedCoordinates& added = {});

/// A column per time that is shown.
struct History {
  VectorXd time;
  MatrixXd q, q_dot, q_ddot;  ///< n x nt
  MatrixXd d, d_dot, d_ddot;  ///< k x nt
  MatrixXd a;                 ///< (m + 3k) x nt
  double step_error = 0;      ///< difference of one step and two half steps, relative to the change in a step
};
/// Exact for loads that are parabolas and motions that are lines between the steps, of order 4 in the step for others:
/// x' = A x + b f by the exponential of A and of the three integrals with it (Van Loan, IEEE Trans. Autom. Control 23
/// (1978) 395), each coordinate for itself where damping does not couple them. Jumps at steps are jumps. Displacements
/// and velocities of the supports are splines, corners of displacements impulses of their inertia (sampled_curve.hpp).
History calc_history(const ResponseModel& model, const Excitation& excitation, const TimeGrid& grid);

}  // namespace bough::modal::response
