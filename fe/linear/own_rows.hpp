#pragma once
/// \file Vectors of which each rank has some rows, products of them.
#include "fe/linear/petsc.hpp"

namespace bough::fe {

/// Rows of vectors that a rank keeps: [first, first + num) of a matrix whose rows are by parts (ordering.hpp), else all
/// of them on every rank, for which the functions below do the plain thing.
struct OwnRows {
  PetscInt first = 0, num = 0, size = 0;
  bool is_cut = false;

  Eigen::MatrixXd take(const Eigen::Ref<const Eigen::MatrixXd>& whole) const { return whole.middleRows(first, num); }
  /// Whole on every rank; collective, as all that follows.
  Eigen::MatrixXd replicate(const Eigen::Ref<const Eigen::MatrixXd>& own) const;
  /// XᵀY of all rows, alike to the last bit on every rank.
  Eigen::MatrixXd dot(const Eigen::Ref<const Eigen::MatrixXd>& X, const Eigen::Ref<const Eigen::MatrixXd>& Y) const;
  /// Its diagonal.
  Eigen::VectorXd dot_columns(const Eigen::Ref<const Eigen::MatrixXd>& X,
                              const Eigen::Ref<const Eigen::MatrixXd>& Y) const;
  /// Own rows of A X, A with the same rows.
  Eigen::MatrixXd multiply(Mat A, const Eigen::Ref<const Eigen::MatrixXd>& X) const;
};

OwnRows find_own_rows(Mat A);
/// All of them, whatever A says.
OwnRows make_whole_rows(Mat A);

}  // namespace bough::fe
