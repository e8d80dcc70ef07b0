#pragma once
/// \file Derivatives of eigenvalues with respect to design variables (docs/theory/modes.md#sensitivities).
#include <string>
#include <vector>

#include "fe/model/model.hpp"
#include "formats/records/deck_dynamics.hpp"

namespace bough::analysis {

/// Derivatives of the eigenvalues with respect to the design variables (DESVAR) of SOL 200.
struct ModeSensitivities {
  std::vector<records::DesignVariable> variables;
  Eigen::VectorXd frequency_hz;        ///< n, of the modes
  Eigen::MatrixXd eigenvalue;          ///< n x variables: dλ/dx; of a repeated eigenvalue its branches, ascending
  Eigen::MatrixXd frequency_slope_hz;  ///< n x variables: df/dx; no number for rigid-body modes
};

/// dλ/dx = φᵀ(∂K/∂x - λ ∂M/∂x)φ / φᵀMφ of each mode and DESVAR. ∂K/∂x and ∂M/∂x by central differences of the matrices
/// for two steps, extrapolated to zero step: exact for polynomials of x up to degree 4. No mode is solved again.
///
/// \param path    of the deck, which is read again with other values of the variables.
/// \param model   of the deck, without preload.
/// \param lambda  n, ascending. \param Phi its modes, num_gdofs x n, basic frame.
/// \throws InputError "modal.no-variables". \note Collective.
ModeSensitivities calc_sensitivities(const std::string& path, const fe::ModelOptions& options, const fe::Model& model,
                                     const Eigen::VectorXd& lambda, const Eigen::MatrixXd& Phi);

}  // namespace bough::analysis
