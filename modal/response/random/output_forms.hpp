#pragma once
/// \file Outputs of a random response as quadratic forms of the outputs of its subcases.
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::modal::response {

/// The square of an output is |F y|², y the components of one element (or one dof).
struct OutputForm {
  std::string component;
  Eigen::MatrixXd F;  ///< rows x components
};

/// One form per component, and after the components of each point of a stress its von Mises stress.
///
/// The mean square of the von Mises stress is trace(A Σ), Σ the covariance of the components and A = FᵀF the matrix of
/// the criterion. Source: Segalman et al., J. Vib. Acoust. 120 (1998) 42.
std::vector<OutputForm> list_output_forms(const std::vector<std::string>& components, bool of_stress);

}  // namespace bough::modal::response
