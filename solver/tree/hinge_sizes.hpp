#pragma once
/// \file Steps of the sweeps over the tree that factorization and solution share.
#include <type_traits>

#include "solver/tree/data.hpp"

namespace bough::solver {

/// Calls use(std::integral_constant<int, N>) with N = num_free, 0 to 6: matrices of a rigid body have fixed sizes.
template <int N = 0, class Use>
void with_size(int num_free, const Use& use) {
  if constexpr (N < 6) {
    if (num_free != N) return with_size<N + 1>(num_free, use);
  }
  use(std::integral_constant<int, N>{});
}

/// [a; α] in B of the hinge's parent side on a node that moves with the modes of the parent: X [A_P; η̈_P].
/// \param A_P    of the parent
/// \param u_dot  of the tree, the parent's row done
inline Vector6d carry_by_modes(const Tree& tree, const TreeBody& tb, const BodyData& d, const Vector6d& A_P,
                               const VectorXd& u_dot) {
  const TreeBody& parent = tree[tb.parent];
  Vector6d A;
  A.noalias() = d.X.leftCols<6>() * A_P;
  A.noalias() += d.X.rightCols(parent.num_modes()) * u_dot.segment(parent.eta_dot_offset(), parent.num_modes());
  return A;
}

}  // namespace bough::solver
