#pragma once
/// \file Transition of a small perturbation over one period of the samples (docs/theory/linear.md).
#include "formats/records/linear_model.hpp"
#include "solver/linear/sampled_system.hpp"

namespace bough::solver {

/// Eigenvalues of the map from one instant to the same instant a period later of x = [δ; δu; δz; δm], m the memory of
/// what is sampled: between samples ẋ = A x + E m with m held, by the matrix exponential; at each sample
/// m⁺ = S_x x + S_m m by differences, their errors in `uncertainty`. The period is the shortest that holds whole
/// numbers of every sample time and of every queue of delayed samples. `A`: of the linear model with the loops closed
/// and m held. Quantization and noise are left out. period 0 if nothing is sampled; warning
/// "linear.no-common-period" where none of 1000 samples is long enough.
records::Multipliers calc_multipliers(Plant& plant, const OperatingPoint& point, const MatrixXd& A,
                                      const SourceLocation& at, Diagnostics& diagnostics, Uncertainty& uncertainty);

}  // namespace bough::solver
