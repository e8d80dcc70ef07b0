#pragma once
/// \file Roundoff of the eigenvalues of a pencil: zeros, possible copies, values without digits.
#include "modal/pencil.hpp"
#include "modal/roots.hpp"

namespace bough::modal::detail {

/// Largest relative distance of copies of one eigenvalue: the roundoff of K seen by its vector x.
double calc_cluster_tolerance(const Pencil& pencil, const VectorXd& x, double lambda);

/// Relative error of an eigenvalue by roundoff: the strain energy of a soft mode on a fine mesh is a small difference
/// of large numbers. Measured on beams of 100 to 2000 elements it is about 0.02 ε over the share of the energy that is
/// left.
double calc_roundoff(const Pencil& pencil, const VectorXd& x, double lambda);
/// Relative error from a result of calc_relative_energy().
double calc_roundoff(double energy_share);

/// Warns "modal.roundoff" of the first of the modes (lambda, X), from `num_rigid` on, where that is above 1e-4.
void warn_of_roundoff(const Pencil& pencil, const VectorXd& lambda, const MatrixXd& X, int num_rigid,
                      Diagnostics& diagnostics);

/// Number of the ascending roots that are mechanisms beyond Φ_R (a pinned link, a free scalar point): eigenvalues at
/// the level of roundoff and far below the next one.
int count_zeros(const Pencil& pencil, const Roots& found);

}  // namespace bough::modal::detail
