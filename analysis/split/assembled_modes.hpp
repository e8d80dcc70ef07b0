#pragma once
/// \file Natural frequencies of reduced bodies that are joined at their nodes.
#include "analysis/split/assembly.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::analysis::splitting {

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

}  // namespace bough::analysis::splitting
