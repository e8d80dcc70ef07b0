#pragma once
/// \file One element's part of u_g = T q_f, for element-wise TᵀKT.
#include <span>
#include <vector>

#include <Eigen/Sparse>

#include "fe/elements/element.hpp"

namespace bough::fe {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Sorted unique columns of the rows `gdofs` of T, into `columns`.
void calc_element_columns(const SparseRows& T, const std::vector<int>& gdofs, std::vector<int>& columns);

/// Reusable storage of one element's projection.
class ElementTransform {
 public:
  /// Reads the rows of T of an element.
  void set(const SparseRows& T, const std::vector<int>& gdofs);
  /// Reads the rows of T of an element with the `columns` of calc_element_columns().
  void set(const SparseRows& T, const std::vector<int>& gdofs, std::span<const int> columns);
  /// The f-dofs the element touches, ascending.
  const std::vector<int>& columns() const { return columns_; }
  /// T_eᵀ K_e T_e, columns().size() square; valid until the next call.
  const MatrixXd& project(const Eigen::Ref<const MatrixXd>& K_e);
  /// Entries of T_eᵀ K_e T_e one by one, for what needs few of them: entry(i, j) after hold(K_e).
  void hold(const Eigen::Ref<const MatrixXd>& K_e);
  double entry(int i, int j) const { return is_selection_ ? K_f_(i, j) : T_e_.col(i).dot(K_T_.col(j)); }
  /// The diagonal of T_eᵀ diag(d) T_e, columns().size(): Σ_i T_if² d_i; valid until the next call.
  const VectorXd& project_diagonal(const Eigen::Ref<const VectorXd>& d);

 private:
  /// With the columns known.
  void read(const SparseRows& T, const std::vector<int>& gdofs);

  std::vector<int> columns_;
  std::vector<int> selected_;  ///< per element dof: position in columns_, -1 for a zero row
  bool is_selection_ = false;  ///< every row of T_e is zero or one unit entry
  MatrixXd T_e_, K_T_, K_f_;
  VectorXd d_f_;
};

}  // namespace bough::fe
