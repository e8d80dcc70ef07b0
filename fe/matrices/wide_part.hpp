#pragma once
/// \file Dense part of TᵀAT: constraints over many dofs, such as an RBE3 over a whole panel, and quadratic forms over
/// many dofs (docs/adr/0013-wide-constraints.md).
#include <functional>
#include <optional>

#include "fe/linear/symmetric_matrix.hpp"
#include "fe/model/model.hpp"

namespace bough::fe {

/// Adds one element's N x N matrix (basic) into zeroed storage.
using AddElementMatrix = std::function<void(const Element&, Eigen::Ref<MatrixXd>)>;

/// T as T_s + P G, so that T_sᵀ A T_s is sparse.
struct SplitTransform {
  SparseRows T;  ///< T_s, num_gdofs x num_fdofs
  SparseRows P;  ///< num_gdofs x r
  SparseRows G;  ///< r x num_fdofs, dense rows
};

/// A row of T with more entries than this is wide: below it the cost of its dense block is negligible. Tests lower it
/// by PETSc's option -bough_max_dense_terms.
inline constexpr int kMaxDenseTerms = 300;
/// Returns kMaxDenseTerms or the value of -bough_max_dense_terms; initializes PETSc.
int get_max_dense_terms();

/// Nothing where no row of T is wide. With `keeps_supports` T_s is such that T_sᵀ A T_s is definite where TᵀAT is: in
/// it the wide rows follow up to six dofs of each part of the structure that they join, as rigid motions of the part
/// do; else they are zero. O(elements + entries of T).
std::optional<SplitTransform> split_transform(const Model& model, bool keeps_supports);

/// TᵀAT - T_sᵀ A T_s for A the sum of element matrices and `forms`. O(elements).
linear::LowRankPart calc_wide_part(const Model& model, const SplitTransform& split, const AddElementMatrix& add,
                                   const std::vector<QuadraticForm>& forms);

/// Takes those of `forms` over many g-dofs out and returns Σ TᵀLᵀWLT of them.
linear::LowRankPart take_wide_forms(const Model& model, std::vector<QuadraticForm>& forms);

}  // namespace bough::fe
