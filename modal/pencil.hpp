#pragma once
/// \file K and M of a model on the f-set, their products with vectors, and the zero-energy motions.
#include <string>
#include <vector>

#include "fe/linear/blas.hpp"
#include "fe/linear/factor.hpp"
#include "fe/linear/row_kinds.hpp"
#include "fe/matrices/system.hpp"
#include "fe/matrices/vector_products.hpp"

namespace bough::modal::detail {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using fe::kColumnsAtOnce;

/// K and M of a system, shared with it until a copy takes the place of one. The matrices are distributed over ranks,
/// vectors are whole and alike on every rank; products are collective.
struct Pencil {
  using Block = Eigen::Ref<const MatrixXd>;
  explicit Pencil(const fe::System& system);

  const fe::Model& model;
  linear::SymmetricMatrix K, M;
  VectorXd K_diagonal, M_diagonal;  ///< |K_ii| and M_ii, num_fdofs
  linear::RowKinds kinds;           ///< of the f-dofs

  /// Number of f-dofs, the rows of K and M.
  int size() const { return model.num_fdofs(); }
  /// K X, num_fdofs x m.
  MatrixXd calc_K_times(const Block& X) const { return linear::multiply(K, X); }
  /// M X, num_fdofs x m.
  MatrixXd calc_M_times(const Block& X) const { return linear::multiply(M, X); }
  MatrixXd dot(const Block& X, const Block& Y) const { return linear::calc_inner_products(X, Y); }  ///< XᵀY
  MatrixXd calc_mass_gram(const MatrixXd& X) const;  ///< XᵀMX; M X of some columns at a time
  /// φᵀKφ / Σ K_ii φ_i²: about 1e-16 for a zero-energy motion, whatever the units and the mesh.
  double calc_relative_energy(const VectorXd& x, double energy) const;
};

/// The rigid-body motions of the model that its constraints and springs leave free.
struct RigidMotions {
  MatrixXd modes;     ///< num_fdofs x k, orthonormal under M, in order: translations of the cg, rotations, loose dofs
  MatrixXd massless;  ///< num_fdofs x l: no strain and no mass; K - σM is singular along them for every σ
  std::vector<int> held;      ///< l f-dofs whose holding removes the massless motions and changes nothing else
  std::vector<int> supports;  ///< k f-dofs whose holding holds `modes` too; only by find_null_motions
  bool is_complete = false;   ///< every other motion has strain
};

/// The combinations (s x m) of Y (n x s) whose forces K Y c are roundoff in every row, 1e-9 of the sum of their terms:
/// a stiff part that a soft one holds moves with a negligible part of its energy, but the rows of the soft one see a
/// force.
/// `floor`: share of the root of K_ii that counts as a term too, for Y of unit length under diag K with roundoff in it.
MatrixXd find_forceless(const Pencil& pencil, const MatrixXd& Y, double floor = 0);

/// Combinations c of Φ_R (about the cg) with (Φ_R c)ᵀ K (Φ_R c)
/// and every row of K Φ_R c zero in roundoff on the f-set, and the dofs with mass that nothing stiffens at all. A
/// motion that a support prevents shows as strain where it was cut off.
RigidMotions find_rigid_motions(const Pencil& pencil);
/// Orthonormalizes zero-energy motions (ascending) in M by products of the motions themselves. Products of the six
/// rigid-body motions would cancel if a rotation about an oblique axis has negligible inertia.
void orthonormalize(const Pencil& pencil, MatrixXd& modes);

/// An estimate from above of the lowest eigenvalue with strain: Rayleigh-Ritz on the polynomials of degree 0..2 (the
/// rotations are half the curl). A positive number always.
double estimate_first_eigenvalue(const Pencil& pencil);

/// "grid 12 component 4" for messages.
std::string describe(const fe::Model& model, int fdof);

/// The error of a singular K + shift M, naming where the parts without strain and mass move most.
[[noreturn]] void throw_singular(const Pencil& pencil, double shift);

}  // namespace bough::modal::detail
