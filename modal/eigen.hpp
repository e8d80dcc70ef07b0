#pragma once
/// \file Normal modes and buckling factors by SLEPc; which of its eigensolvers says modal/extraction.hpp.
#include <functional>
#include <optional>

#include "fe/loads/loads.hpp"
#include "fe/loads/temperatures.hpp"
#include "fe/matrices/system.hpp"
#include "modal/solver_use.hpp"

namespace bough::modal {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct EigenOptions {
  int num_modes = 10;                    ///< wanted, rigid ones included; 0: all in the range below
  std::optional<double> min_hz, max_hz;  ///< a root on an end, to 1e-9, is in the range with its copies
  double tolerance = 1e-12;
  bool check_inertia = true;  ///< Sylvester count: no mode missed below the highest
  std::string solver = {};    ///< EPS type of SLEPc (find_eps_type); empty: the one that suits the model
  std::function<void(int converged, int requested)> progress;
  const linear::SymmetricFactor* factor = nullptr;  ///< LLᵀ of K of the system, where the caller has it: saves one
  int least_rows_to_release = 500000;  ///< from this number of f-dofs on K gives its memory back while Lanczos runs
};

/// K φ = λ M φ, φᵀMφ = 1, ascending λ. Sign rule: the component of largest magnitude (first by g-dof among those
/// within 1e-6 of it) is positive, so it does not depend on the rank count.
struct EigenPairs {
  VectorXd lambda;         ///< n; rigid modes are exactly 0
  MatrixXd Phi;            ///< num_gdofs x n in basic, constrained rows zero, dependent rows recovered
  VectorXd modal_mass;     ///< φᵀMφ, 1 but for roundoff; empty: not known
  VectorXd energy_share;   ///< |φᵀKφ| / Σ K_ii φ_i²: near 1e-16 K has no digit of a mode left; empty: not known
  VectorXd residual;       ///< |Kφ - λMφ| / |Kφ|; for rigid modes over the K-norm scale
  int num_rigid = 0;       ///< zero eigenvalues, first
  int inertia_count = -1;  ///< eigenvalues below the highest returned; -1 not checked
  int num_massless = 0;    ///< rigid motions without mass (a straight line of bars with lumped mass
                           ///< turns about itself freely): no eigenvalue belongs to them
  std::vector<SolverUse> solvers;  ///< of the eigenvectors with strain, as far as they belong to this answer
};

/// The first num_modes of the range, or all of it. A root repeated at the cut is completed before it is cut, so the
/// basis of what is returned does not depend on num_modes; inertia_count then counts the copies left out too.
/// Repeated roots get a basis fixed by the model alone (canonical.hpp). Warnings: modal.fewer-modes, modal.cut-root,
/// modal.massless-motion, modal.empty-range, modal.roundoff. Throws ComputationError modal.no-dofs, modal.no-mass,
/// modal.singular-shift, modal.missed-modes, modal.unsuited-solver.
EigenPairs calc_normal_modes(const fe::System& system, const EigenOptions& options, Diagnostics& diagnostics);
/// Normal modes with matrices that no other caller needs.
EigenPairs calc_normal_modes(const fe::Model& model, const EigenOptions& options, Diagnostics& diagnostics);

/// (K + λ K_G) φ = 0, K_G of a load and its static displacement u_g: load factors λ nearest zero, by magnitude; φᵀKφ
/// = 1. Solved as -K_G φ = θ K φ, λ = 1/θ, with K's factor as inner product. min_hz, max_hz bound the (signed) load
/// factor here; residual is |Kφ + λK_Gφ| / |Kφ|. `initial`: heated elements, whose forces λ multiplies too. Throws
/// ComputationError modal.buckling-free when K is singular in a rigid motion.
EigenPairs calc_buckling_modes(const fe::System& system, const fe::AppliedLoad& load, const VectorXd& u_g,
                               const EigenOptions& options, Diagnostics& diagnostics,
                               const fe::InitialForces* initial = nullptr);
/// Buckling modes with matrices that no other caller needs.
EigenPairs calc_buckling_modes(const fe::Model& model, const fe::AppliedLoad& load, const VectorXd& u_g,
                               const EigenOptions& options, Diagnostics& diagnostics,
                               const fe::InitialForces* initial = nullptr);

/// m_eff,j,r = (Φ_Rᵀ M φ_j)_r² / (φ_jᵀ M φ_j), n x 6, about Bo.
MatrixXd calc_effective_mass(const fe::Model& model, const MatrixXd& Phi);
/// Modal effective mass from a given M Φ on the g-set.
MatrixXd calc_effective_mass(const fe::Model& model, const MatrixXd& Phi, const MatrixXd& M_Phi);

}  // namespace bough::modal
