#pragma once
/// \file The null space of a stiffness matrix: motions to which it gives no resistance, by inverse iteration.
#include "fe/linear/factor.hpp"
#include "fe/linear/row_kinds.hpp"

namespace bough::linear {

/// Share of the diagonal's energy xᵀDx below which xᵀKx counts as none: a solution along x would be round-off.
inline constexpr double kMechanismEnergy = 4e-15;
/// Bound on the energy after a solution has failed by its residual: round-off of the elements may leave a mechanism
/// more.
inline constexpr double kSoftMotionEnergy = 100 * kMechanismEnergy;

/// More of them are not looked for.
inline constexpr int kMaxMechanisms = 24;

/// Share of D = diag K that makes a singular K definite. Above: digits of K are lost. Below: there is no factor.
inline constexpr double kNullShift = 1e-13;

/// The softest motions of K: n x m, orthonormal under D, and |xᵀKx| of each, by ascending energy.
struct SoftSpace {
  Eigen::MatrixXd X;
  Eigen::VectorXd energy;
};

/// Takes six inverse iterations on a subspace of m motions from a fixed start, the same in any units. `factor`: of
/// K + kNullShift D. D: num_rows, positive.
SoftSpace calc_soft_space(const SymmetricMatrix& K, const Eigen::VectorXd& D, const SymmetricFactor& factor,
                          Eigen::Index m);

/// xᵀKx / xᵀDx of the softest motion x that one solution for a random load (fixed seed) shows, D = diag K. The rows
/// are of `kinds`: the same for K in any units.
double calc_softest_energy(const SymmetricMatrix& K, const RowKinds& kinds, const SymmetricFactor& factor);

/// A basis (num_rows x k) of the motions with xᵀKx < `energy` xᵀDx, by inverse iteration of K + kNullShift D on at
/// least `expected` vectors; k = 0 when there are none, k ≤ kMaxMechanisms. Columns are reduced: each has a unit entry
/// (largest by complete pivoting) where the others are zero, so separate mechanisms stay separate.
Eigen::MatrixXd find_mechanisms(const SymmetricMatrix& K, const RowKinds& kinds, int expected,
                                double energy = kMechanismEnergy);

}  // namespace bough::linear
