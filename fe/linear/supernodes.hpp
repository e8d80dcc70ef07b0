#pragma once
/// \file Triangular solutions with a supernodal factor, a few right-hand sides at once.
#include <Eigen/Dense>
#include <cstddef>

namespace bough::linear {

/// L by supernodes: columns super[k] to super[k + 1] share the rows row[row_at[k]] and on, of which the first are their
/// own. `num` supernodes have some of the first `size` columns of L; a solution uses those columns alone.
/// Their entries follow each other in `value` as a solution reads them, without the upper triangles (pack_supernodes):
/// groups of four columns, the last of a supernode of fewer; of each its triangle by rows, the inverse in the place of
/// a diagonal entry, then the rows below, the entries of a row side by side.
struct Supernodes {
  int num = 0, size = 0;
  const int *super = nullptr, *row_at = nullptr, *row = nullptr;
  const double* value = nullptr;
  std::ptrdiff_t num_values = 0;
};

/// From CHOLMOD's layout, by columns of whole supernodes, the k-th at value[value_at[k]], to that of Supernodes, in its
/// place. \return how many values are left.
std::ptrdiff_t pack_supernodes(const Supernodes& L, const int* value_at, double* value);

/// Right-hand sides that are solved for together: L is read once for all of them, from memory, which is what a solution
/// waits for.
constexpr Eigen::Index kNarrowRhs = 4, kWideRhs = 8;

/// Z (kNarrowRhs or kWideRhs x n, a column for each row of L): the first `size` columns become L⁻¹Z; the others lose
/// what L carries into them, L_s L⁻¹Z.
void solve_lower(const Supernodes& L, Eigen::MatrixXd& Z);
/// The first `size` columns of Z become those of L⁻ᵀZ, the others being the solution already.
void solve_lower_transposed(const Supernodes& L, Eigen::MatrixXd& Z);

}  // namespace bough::linear
