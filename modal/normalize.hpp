#pragma once
/// \file Lengths of mode shapes as NORM of EIGRL and EIGR asks for them.
#include <string>

#include "fe/model/model.hpp"

namespace bough::modal {

using Eigen::MatrixXd;

struct Norm {
  std::string kind = "MASS";    ///< MASS: unit generalized mass; MAX: the largest component is 1; POINT: one dof is 1
  int grid = 0, component = 0;  ///< POINT; component 0: a scalar point
};

/// Scales the columns of Phi (num_gdofs x n, basic). MAX and POINT look at the components of the f-set in the
/// displacement axes of their grids, rotations too, as Nastran does. A mode that does not move the point of POINT is
/// scaled as for MAX, warning "modal.norm-point"; so is every mode where the deck has no such dof.
void normalize(const fe::Model& model, const Norm& norm, MatrixXd& Phi, Diagnostics& diagnostics);

}  // namespace bough::modal
