#pragma once
/// \file Triangular solutions with a supernodal factor, a few right-hand sides at once.
#include <Eigen/Dense>

namespace bough::fe {

/// L by supernodes, as CHOLMOD stores it: columns super[k] to super[k + 1] share the rows row[row_at[k]] and on, of
/// which the first are their own; their entries, by columns, begin at value[value_at[k]].
struct Supernodes {
  int num = 0;
  const int *super = nullptr, *row_at = nullptr, *value_at = nullptr, *row = nullptr;
  const double* value = nullptr;
};

/// Right-hand sides that are solved for together: L is read once for all of them, from memory, which is what a solution
/// waits for.
constexpr Eigen::Index kFewSides = 4, kManySides = 8;

/// Z becomes L⁻¹Z. Z: kFewSides or kManySides x n, a column for each row of L.
void solve_lower(const Supernodes& L, Eigen::MatrixXd& Z);
/// Z becomes L⁻ᵀZ.
void solve_lower_transposed(const Supernodes& L, Eigen::MatrixXd& Z);

}  // namespace bough::fe
