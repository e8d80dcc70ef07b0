#pragma once
/// \file Test-analysis models from a finite element model: Guyan and IRS (docs/theory/test-analysis.md).
#include "fe/model/model.hpp"
#include "modal/compare/shapes.hpp"

namespace bough::modal {

/// Matrices at the measured dofs, in the order of `dofs`.
struct TestModel {
  std::vector<std::pair<int, int>> dofs;  ///< node id, component 1..6
  MatrixXd K, M;
  VectorXd frequency_hz;  ///< of (K, M), ascending [1/T]
};

/// K and M of a model whose a-set (fe::reduce_to_aset) is the measured dofs: u_o = G u_a, Guyan's reduction; with
/// `is_improved` u_o = (G + K_oo⁻¹ (M_oa + M_oo G) M_a⁻¹ K_a) u_a, the improved reduced system. Source: O'Callahan,
/// Proc. IMAC VII (1989) 17.
/// \throws ComputationError "modal.test-mass" if M_a is singular. \note Dense: num_gdofs x dofs.
TestModel calc_test_model(const fe::Model& model, bool is_improved);

}  // namespace bough::modal
