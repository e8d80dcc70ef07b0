#pragma once
/// \file Elements of uncoupled springs and dampers.
#include <Eigen/Dense>

namespace bough::fe {

/// K_e = Σ k_c s_cᵀ s_c and B_e = Σ b_c s_cᵀ s_c with one row s_c for each spring or damper c.
class SpringRows {
 public:
  /// Elongations and angles per unit of the element's DOFs, springs x num_dofs; k_c times row c times u is the printed
  /// force of spring c.
  virtual Eigen::MatrixXd calc_spring_rows() const = 0;

 protected:
  ~SpringRows() = default;
};

}  // namespace bough::fe
