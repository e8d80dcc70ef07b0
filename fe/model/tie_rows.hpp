#pragma once
/// \file Rows of the constraint equations u_g = T u_f of a model, three motions of a grid at a time.
#include <map>

#include "fe/model/model.hpp"

namespace bough::fe {

/// Coefficients of three motions by the f-dofs that they depend on.
using TieRows = std::map<int, Eigen::Vector3d>;

/// Rows of g-dofs [first_gdof, first_gdof + 3).
TieRows get_tie_rows(const Model& model, int first_gdof);

/// Returns true if `rows` are those of translations u + θ × arm, or of rotations (arm = 0, u = 0), to 1e-9.
bool are_rigid(const TieRows& rows, const TieRows& u, const TieRows& theta, const Eigen::Vector3d& arm);

}  // namespace bough::fe
