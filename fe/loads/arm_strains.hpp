#pragma once
/// \file Strains of the arms of attached masses: fields in which an arm s moves by E s beyond the rotation of its grid
/// (docs/theory/third-order.md).
#include "fe/matrices/assembly.hpp"

namespace bough::fe {

/// The inner products of fields E s, by components of E (column by column).
struct ArmStrainMass {
  MatrixXd on_dofs;                    ///< Σ H_rᵀ μ_rs (E s)_s of unit E: num_gdofs x 9
  Matrix3d moment = Matrix3d::Zero();  ///< Σ μ_rs s_r s_sᵀ over arms
};
/// Sums over the elements of all ranks, for mass of this kind; collective.
ArmStrainMass calc_arm_strain_mass(const Model& model, MassKind kind);

/// calc_carried_gram of fields that move arms by E s in addition; strain: 9 x n.
MatrixXd calc_strained_gram(const Model& model, MassKind kind, const MatrixXd& Phi, const MatrixXd& strain);

}  // namespace bough::fe
