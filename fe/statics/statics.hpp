#pragma once
/// \file Static solutions: one factorization, many loads.
#include <vector>

#include "fe/linear/factor.hpp"
#include "fe/matrices/assembly.hpp"

namespace bough::fe {

class StaticSolver {
 public:
  /// Factors K on the f-set with `held_fdofs` fixed as well (a support for a free-free model; empty for a fixed one).
  /// A singular K throws ComputationError("fe.mechanism") naming the nodes and dofs of the mechanism.
  StaticSolver(const Model& model, const linear::SymmetricMatrix& K_f, std::vector<int> held_fdofs = {});
  /// Solver of a model whose every dof is prescribed: it has no factor, and solve() returns zeros.
  explicit StaticSolver(const Model& model);
  ~StaticSolver();

  /// u_g (num_gdofs x m) for loads F_g (num_gdofs x m) in basic on the g-set; both replicated on every rank. Throws
  /// ComputationError("fe.residual") where the forces of u do not balance the loads; its warning needs `diagnostics`.
  MatrixXd solve(const Eigen::Ref<const MatrixXd>& F_g, Diagnostics* diagnostics = nullptr) const;
  /// After a residual that failed: throws ComputationError("fe.mechanism") where a motion has negligible strain.
  /// `model`: the one this was made of.
  void demand_no_mechanism(const Model& model) const;
  /// LLᵀ of K on the whole f-set, as long as this lives; nullptr where dofs are held or K took pivoting.
  const linear::SymmetricFactor* find_definite_factor() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Six f-dofs that hold a free-free model in a statically determinate way: all six dofs of `node_id`, or, when 0, a
/// 3-2-1 support on three well-spread nodes. Throws InputError when there is none.
std::vector<int> choose_determinate_support(const Model& model, int node_id);

}  // namespace bough::fe
