#pragma once
/// \file Rigid elements RBE2 and RBAR as constraint equations.
#include "bough/fe/elements/element.hpp"
#include "bough/fe/model/constraints.hpp"

namespace bough::fe {

/// Rows: the six dofs of `node` in its CD axes for a rigid motion [v; w] (basic) of the point `reference`:
/// u = v + w × (x - reference), θ = w. 6 x 6.
Eigen::Matrix<double, 6, 6> calc_rigid_map(const Node& node, const Vector3d& reference);

/// The dependent components of every grid GM follow the rigid motion of GN; components are in each grid's CD axes.
void add_rbe2(const records::Rbe2& card, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations);

/// Six independent components on the two grids span the rigid motion: u_m = D P⁻¹ u_n with P, D the rows of the rigid
/// map of the independent and dependent components. Blank CMA and CMB: everything that is not independent is dependent.
/// Reports fe.rigid-independent when there are not six or P is singular.
void add_rbar(const records::Rbar& card, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations);

}  // namespace bough::fe
