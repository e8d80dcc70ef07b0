#pragma once
/// \file Constraints as equations among the l-set, and their elimination.
///
/// l-set: the dofs of all nodes in their displacement (CD) axes, numbered as the g-set.
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Sparse>

#include "base/diagnostic.hpp"

namespace bough::fe {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// u_dependent = Σ coefficient · u_ldof.
struct ConstraintEquation {
  int dependent = 0;                          ///< l-dof
  std::vector<std::pair<int, double>> terms;  ///< (l-dof, coefficient)
  std::string card;                           ///< "RBE2 12", for messages
  SourceLocation at;
};

/// u_l = C u_f.
struct Elimination {
  SparseRows C;                ///< num_ldofs x num_fdofs
  std::vector<int> fdof_ldof;  ///< the l-dof of each f-dof, ascending
};

/// Substitutes chains of equations until every dependent dof is expressed in independent ones; equations whose
/// dependent dofs name each other are solved together (R_mm of Nastran). Reports fe.dependent-twice (two equations for
/// one dof) and fe.cyclic-constraints (such a system is singular). The result has one row of independent terms per
/// equation, in the equations' order; empty when an error was reported. O(terms of the result), and cubic in the
/// number of equations that name each other.
std::vector<ConstraintEquation> resolve_chains(int num_ldofs, std::vector<ConstraintEquation> equations,
                                               const std::function<std::string(int)>& name_dof,
                                               Diagnostics& diagnostics);

/// Free dofs are those neither fixed nor dependent; fixed independents are substituted as zero.
Elimination eliminate(int num_ldofs, const std::vector<ConstraintEquation>& resolved,
                      const std::vector<char>& is_fixed);

/// Displacements by those of the fixed dofs: u_l = C u_f + C_fixed d.
struct FixedPart {
  SparseRows C;            ///< num_ldofs x ldofs.size()
  std::vector<int> ldofs;  ///< fixed and not dependent, ascending
};
/// Collects the terms of fixed dofs in the resolved equations; `is_fixed` has num_ldofs entries.
FixedPart collect_fixed_part(int num_ldofs, const std::vector<ConstraintEquation>& resolved,
                             const std::vector<char>& is_fixed);

}  // namespace bough::fe
