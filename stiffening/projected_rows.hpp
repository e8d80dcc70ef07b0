#pragma once
/// \file Sums Φᵀ K Φ of many loads by rows of K: cheaper than by products of modes where there are many of these.
#include <vector>

#include <Eigen/Dense>

namespace bough::stiffening {

using Eigen::Index;
using Eigen::MatrixXd;

/// Σ_e Φ_eᵀ K_ec Φ_e for m loads c, K = L + Lᵀ with the half of K's diagonal in L. The rows of a group (the dofs of a
/// grid) are complete when its last element is added; then L Φ has them from the few columns that they couple, and
/// Φᵀ (L Φ) takes them many at a time: 2 n m flops an entry of L and 2 n² m a row, as matrix products of the BLAS.
class ProjectedRows {
 public:
  /// elements: the dofs (rows of Φ) of each that will be added, once; group_of: of every dof, groups in the order of
  /// their dofs.
  ProjectedRows(const MatrixXd& Phi, Index num_loads, std::vector<const std::vector<int>*> elements,
                std::vector<int> group_of);

  /// Element `e` of the list. entries: which of the upper triangle of K_e, column after column, are not zero for every
  /// load; values: these, entries x m.
  void add(std::size_t e, const std::vector<int>& entries, const MatrixXd& values);

  /// For every load, n x n.
  std::vector<MatrixXd> finish();

 private:
  struct Group {
    std::vector<int> rows, columns;  ///< dofs, ascending; a row couples to columns up to itself
    std::vector<double> L;           ///< columns x rows x m; empty: nothing in it
  };
  Group& open(int group);
  void close(Group& group);
  void flush();

  const MatrixXd& Phi_;
  Index n_, m_;
  std::vector<const std::vector<int>*> elements_;
  std::vector<int> group_of_;
  std::vector<std::vector<int>> elements_of_;  ///< by group
  std::vector<int> left_;                      ///< elements of a group that are still to come
  std::vector<Group> groups_;
  std::vector<int> open_;
  std::size_t open_size_ = 0;  ///< numbers in the open groups
  Index used_ = 0;
  MatrixXd L_Phi_, Phi_rows_;  ///< m n x rows, a row's loads side by side for each mode; rows x n
  MatrixXd sums_;              ///< m n x n
  std::vector<int> rows_;      ///< of L_Phi_
};

}  // namespace bough::stiffening
