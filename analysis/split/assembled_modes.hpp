#pragma once
/// \file Natural frequencies and static deflections of reduced bodies that are joined at their nodes.
#include "analysis/split/assembly.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::analysis::splitting {

using Eigen::MatrixXd;

/// Eigenvalues λ = ω², ascending, of the bodies at rest without gravity and damping, by component mode synthesis: the
/// rigid-body motion of each body follows from the node of its parent; the stiffness matrix of the assembly is that of
/// the bodies' modes. Closed loops and grounds restrict the coordinates. Source: R. R. Craig and A. J. Kurdila,
/// Fundamentals of Structural Dynamics, 2nd ed., ch. 17.
///
/// \param bodies  in the order of the parts
/// \param shift   [1/T²] positive, of the size of the lowest eigenvalues: they are largest eigenvalues of the inverse
///     problem, so that stiff modes take no digits from them
Eigen::VectorXd calc_assembled_eigenvalues(const std::vector<const records::FlexBody*>& bodies,
                                           const Structure& structure, const Assembly& assembly, double shift);

/// Static displacements of the grids of the deck, num_gdofs x m, by the assembled bodies; loads of a free structure are
/// in equilibrium, its rigid-body motion is arbitrary.
///
/// \param model      of the deck
/// \param partition  the part that gets the load of each grid
/// \param F          [F, F L] num_gdofs x m loads in basic
MatrixXd calc_assembled_deflections(const std::vector<const records::FlexBody*>& bodies, const Structure& structure,
                                    const Assembly& assembly, double shift, const fe::Model& model,
                                    const Partition& partition, const MatrixXd& F);

}  // namespace bough::analysis::splitting
