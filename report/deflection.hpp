#pragma once
/// \file Largest displacement of a flexible body in a run.
#include <vector>

#include <Eigen/Dense>

namespace bough::report {

/// The largest displacement of any point, and the sample in which it occurs.
struct Deflection {
  double size = 0;  ///< [L]
  Eigen::Index sample = 0;
};

/// Finds max over samples i and points k of |Σ_j eta(i, j) shapes[j].row(k)|, of all samples and all points.
///
/// Samples and points whose bound Σ_j |eta_j| |shape_j| is below the largest value so far are left out, the others are
/// computed in the order of their bounds by matrix products.
///
/// \param shapes  [mode] points x 3, in the frame of the body.
/// \param eta     [samples x modes] modal coordinates; rows that are not finite are skipped.
Deflection find_largest_deflection(const std::vector<Eigen::MatrixXd>& shapes, const Eigen::MatrixXd& eta);

}  // namespace bough::report
