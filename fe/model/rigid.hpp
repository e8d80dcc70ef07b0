#pragma once
/// \file Rigid elements RBE1, RBE2, RBE3, RBAR, RROD and RSPLINE as constraint equations, and, RSPLINE apart, as links
/// with a second order.
#include "fe/elements/element.hpp"
#include "fe/model/constraints.hpp"
#include "fe/model/links.hpp"

namespace bough::fe {

/// The grid `id` that `card` names; nullptr after fe.missing-grid when it is missing or a scalar point.
const Node* find_rigid_grid(int id, const std::string& card, const NodeTable& nodes, const SourceLocation& at,
                            Diagnostics& diagnostics);

/// Rows: the six dofs of `node` in its CD axes for a rigid-body motion [v; w] (basic) of the point `reference`:
/// u = v + w × (x - reference), θ = w. 6 x 6.
Eigen::Matrix<double, 6, 6> calc_rigid_map(const Node& node, const Vector3d& reference);

/// The dependent components of every grid GM follow the rigid-body motion of GN; components are in each grid's CD axes.
void add_rbe2(const records::Rbe2& card, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations, std::vector<Link>& links);

/// Six independent components on the two grids span the rigid-body motion: u_m = D P⁻¹ u_n with P, D the rows of the
/// rigid map of the independent and dependent components. Blank CNA and CNB: all six of GA; fewer than six on one grid
/// alone: all six of that, with fe.rbar-completed. Blank CMA and CMB: everything that is not independent is dependent.
/// Reports fe.rigid-independent when there are not six or P is singular.
void add_rbar(const records::Rbar& card, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations, std::vector<Link>& links);

/// RBE1, an RBAR of any number of grids: six independent components on up to six grids determine the rigid-body
/// motion, and the components after UM follow it.
void add_rbe1(const records::Rbe1& card, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations, std::vector<Link>& links);

/// The reference grid's components follow the rigid-body motion that fits the connected components best in the least
/// squares of their weights (rotations scaled by the square of the mean arm, as MSC Nastran does): u_ref = R Σ A⁻¹ S_iᵀ
/// W_i u_i, A = Σ S_iᵀ W_i S_i. UM turns the equations to other dependent components. Reports fe.rbe3-mechanism when
/// the connected components do not hold a rigid body, fe.rigid-independent when UM cannot be solved for.
void add_rbe3(const records::Rbe3& card, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations, std::vector<Link>& links);

/// Grids between two independent ones follow the elastic line of a tube through all of them, bent by its ends alone; on
/// a straight line that is the cubic. Source: Nastran Quick Reference Guide, RSPLINE.
void add_rspline(const records::Rspline& record, const NodeTable& nodes, const SourceLocation& at,
                 Diagnostics& diagnostics, std::vector<ConstraintEquation>& equations);

/// e·(u_b - u_a) = 0 along the rod. Reports fe.rigid-independent when the dependent component is across the rod.
void add_rrod(const records::Rrod& card, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations, std::vector<Link>& links);

}  // namespace bough::fe
