#pragma once
/// \file A model held at its interface nodes: constraint modes, fixed-interface normal modes, static solutions
/// (Craig & Bampton, AIAA J. 6 (1968) 1313).
#include <memory>
#include <optional>

#include "modal/bases/partition.hpp"
#include "modal/eigen.hpp"

namespace bough::modal::bases {

/// Checks of the modes of a solution.
struct ModesCheck {
  int num_found = 0;       ///< up to the highest that is complete with its copies, rigid motions included
  int inertia_count = -1;  ///< of the factor (Sylvester), as many where none is missed; -1: none to be trusted
  double residual = 0;     ///< the largest
  std::vector<SolverUse> solvers;
};

/// Modes on the g-set with their eigenvalues; unit generalized mass.
struct ModeSet {
  VectorXd lambda;   ///< n, ascending
  MatrixXd Phi;      ///< num_gdofs x n
  ModesCheck check;  ///< of those the solver found
};

class FixedInterface {
 public:
  /// One factorization of K_ii; nothing is dense but num_fdofs x nb. Throws ComputationError
  /// "modal.interface-mechanism" where the model still moves without strain with the interface held.
  /// `system` and its model outlive this.
  FixedInterface(const fe::System& system, const std::vector<int>& nodes, Diagnostics& diagnostics);
  FixedInterface(fe::System&&, const std::vector<int>&, Diagnostics&) = delete;
  ~FixedInterface();
  FixedInterface(FixedInterface&&) noexcept;

  /// Returns the coordinates of interface and interior; the reference is valid as long as this object.
  const Partition& partition() const;
  /// Ψ, num_gdofs x nb: one interface dof moves by one, the others are held, u_i = -K_ii^-1 K_ib u_b.
  MatrixXd calc_constraint_modes() const;
  /// (K_ii - λ M_ii) φ = 0, φᵀMφ = 1: the first `number`, or with max_hz and number 0 all below it. No mode is missed
  /// (Sylvester count). Repeated roots and signs as calc_normal_modes. Throws modal.missed-modes.
  /// `solver`: the EPS type of SLEPc (find_eps_type); empty: the one that suits.
  ModeSet calc_modes(int number, std::optional<double> max_hz, Diagnostics& diagnostics,
                     const std::string& solver = {}) const;
  /// u_g (num_gdofs x m) for loads in basic on the g-set with the interface held.
  MatrixXd solve(const MatrixXd& F_g) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bough::modal::bases
