#pragma once
/// \file Shapes of a test against those of an analysis: measured dofs, test-analysis models, orthogonality, COMAC, and
/// sensor places (docs/theory/test-analysis.md).
#include "modal/compare/shapes.hpp"

namespace bough::modal {

/// One measured dof: places of its node in both lists, component 0..5 along the axes of the models.
struct MeasuredDof {
  int a = 0, b = 0, component = 0;
};

/// Dofs of matched nodes that are not zero in every shape of the test, node after node.
std::vector<MeasuredDof> list_measured_dofs(const ModalModel& test, const NodeMatch& match);

/// Shapes at the measured dofs, dofs x modes. `of_test`: of the second model.
MatrixXd take_dofs(const ModalModel& model, const std::vector<MeasuredDof>& dofs, bool of_test);

/// The model with shapes that are zero but for the measured dofs.
ModalModel keep_measured(const ModalModel& a, const std::vector<MeasuredDof>& dofs);

/// Mass matrix of the SEREP model at the dofs: M = Pᵀ diag(m) P, P the pseudoinverse of the shapes Φ (dofs x modes), so
/// that ΦᵀMΦ = diag(m). Source: O'Callahan, Avitabile & Riemer, Proc. IMAC VII (1989) 29.
/// \return an empty matrix if the columns of Φ are dependent (smallest singular value below 1e-8 of the largest).
MatrixXd calc_serep_mass(const MatrixXd& Phi, const VectorXd& modal_mass);

/// Columns with xᵀMx = 1.
MatrixXd normalize(const MatrixXd& X, const MatrixXd& M);

/// Coordinate MAC of each dof over the pairs: (Σ|φψ|)² / (Σφ² Σψ²), columns of X and Y paired; 0 where one does not
/// move. Source: Lieven & Ewins, Proc. IMAC VI (1988) 690.
VectorXd calc_comac(const MatrixXd& X, const MatrixXd& Y);

/// Modal phase collinearity of each column: 1 where all dofs move in one phase or in opposite phase. Source: Pappa,
/// Elliott & Schenk, J. Guidance 16 (1993) 886.
VectorXd calc_phase_collinearity(const Eigen::MatrixXcd& X);

/// The real shape of each column: its phase turned to the largest real part.
MatrixXd make_real(const Eigen::MatrixXcd& X);

/// Rows that effective independence keeps: of A = Φ(ΦᵀΦ)⁻¹Φᵀ the row of the smallest diagonal is dropped until `number`
/// are left. Source: Kammer, J. Guidance 14 (1991) 251.
/// \param number at least the columns of Φ, whose rank is full.
/// \return ascending; \param[out] independence their last diagonals.
std::vector<int> place_sensors(const MatrixXd& Phi, int number, VectorXd& independence);

}  // namespace bough::modal
