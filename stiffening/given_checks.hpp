#pragma once
/// \file Checks of given matrices and modes: symmetry, mass, and whether they are of one model.
#include <string>

#include "stiffening/given_elements.hpp"

namespace bough::stiffening {

/// "grid 7 component 3" of a row of the dof map (num_gdofs x 2).
std::string describe_dof(const Eigen::MatrixXi& dof_map, Eigen::Index gdof);

/// Reports "reduce.not-symmetric": entries apart by more than the digits of a file and roundoff.
void check_symmetry(const GivenMatrix& given, Diagnostics& diagnostics);

/// No negative entry on the diagonal, and one mass in all rigid-body motions: Φ_RᵀMΦ_R = [m 1, -m c̃; m c̃, J]. M: on
/// the g-set, from `given`. Reports "reduce.negative-mass", "reduce.not-rigid-mass".
void check_mass(const SparseRows& M, const GivenMatrix& given, const PointTable& points, Diagnostics& diagnostics);

/// λ of the file against the Rayleigh quotient of Phi (num_gdofs x modes) under K and M: units, dofs and axes that do
/// not belong together show. Reports "reduce.modes-differ".
void compare_eigenvalues(const fe::Model& model, const GivenModes& given, const MatrixXd& Phi,
                         Diagnostics& diagnostics);

}  // namespace bough::stiffening
