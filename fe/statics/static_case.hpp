#pragma once
/// \file One static subcase: displacements, reactions, balance, element forces (SOL 101).
#include "fe/loads/loads.hpp"
#include "fe/loads/temperatures.hpp"
#include "fe/statics/inertia_relief.hpp"
#include "fe/statics/statics.hpp"
#include "formats/records/static_result.hpp"

namespace bough::fe {

/// Loads of a subcase: F on the g-set in basic, d of the fixed dofs in their CD axes (calc_enforced). F holds
/// the loads of `initial`, the heated elements.
struct StaticLoad : AppliedLoad {
  VectorXd d;
  InitialForces initial;
};
/// Loads of LOAD and TEMPERATURE(LOAD) of a subcase; without them its enforced displacements alone.
StaticLoad calc_static_load(const Model& model, const records::Deck& deck, const records::Subcase& subcase,
                            Diagnostics& diagnostics);
/// Loads of set `load` alone, or of the subcase of the model if it is negative.
StaticLoad calc_static_load(const Model& model, const records::Deck& deck, int load, Diagnostics& diagnostics);

/// Forces and moments of F (num_gdofs) on dofs that AUTOSPC fixes: they have no effect. The largest first, as
/// "component 6 of grid 20 (5)"; empty when there is none above 1e-9 of the largest load.
std::vector<std::string> list_lost_loads(const Model& model, const VectorXd& F);

/// u = T q + T_fixed d with Tᵀ(K u - F) = 0. With R = K u - F: reactions of the fixed dofs T_fixedᵀ R; the rest of R is
/// the force of MPC and rigid elements. epsilon = |qᵀTᵀR| / |qᵀTᵀ(F - K T_fixed d)| (Nastran's residual work).
/// `suport`: dofs that the solver fixes in addition to the SPCs; their forces count as reactions; with inertia relief
/// the load is F - M Φ a (calc_acceleration), and with INREL -2 ΦᵀM u = 0.
records::StaticSubcase solve_static_case(const Model& model, const StaticSolver& solver, const StaticLoad& load,
                                         const Suport& suport = {}, Diagnostics* diagnostics = nullptr);

/// Solutions of several loads: one factor read and every element formed once for all of them. `energy`, if
/// given: as of calc_stiffness_times.
std::vector<records::StaticSubcase> solve_static_cases(const Model& model, const StaticSolver& solver,
                                                       const std::vector<const StaticLoad*>& loads,
                                                       const Suport& suport = {}, Diagnostics* diagnostics = nullptr,
                                                       MatrixXd* energy = nullptr);

/// Forces and strain energy of every element, by card in alphabetical order. Replicated. `deck`, `load`: loads along
/// beams, which act between the ends that u knows; `initial`: of heated elements.
std::vector<records::ElementForces> calc_element_forces(const Model& model, const VectorXd& u_g,
                                                        const records::Deck& deck, int load, Diagnostics& diagnostics,
                                                        const InitialForces& initial = {});

/// Forces and moments about `point` of a load on the g-set.
Eigen::Matrix<double, 6, 1> calc_resultant(const Model& model, const VectorXd& F_g,
                                           const Vector3d& point = Vector3d::Zero());

/// A distributed matrix as a whole on every rank, without zero entries.
records::SparseMatrix gather_sparse(const linear::SymmetricMatrix& A);

}  // namespace bough::fe
