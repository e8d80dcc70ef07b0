#pragma once
/// \file F_I, K_G1, K_G2 and the whole reduction of a deck to a flexible body.
#include <functional>

#include "fe/loads/loads.hpp"
#include "fe/loads/second_order.hpp"
#include "formats/records/body_spec.hpp"
#include "modal/nodal_dofs.hpp"
#include "modal/response/residual_modes.hpp"
#include "stiffening/basis_check.hpp"

namespace bough::stiffening {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using fe::calc_inertial_loads;  ///< of a model
/// F_I for any mass matrix and dof map, as the report's fimake5 (eqs. 3-12): P = M Φ_R (num_dofs x 6). Spin takes every
/// nodal momentum as that of a mass at its node. Rows of generalized dofs carry the six accelerations only: the map
/// does not contain the direction in which a spin rotates them.
MatrixXd calc_inertial_loads(const modal::NodalDofs& dofs, const MatrixXd& P);

/// K_G of every load projected on Phi, U (num_gdofs x m) their static solutions: m matrices n x n, accumulated element
/// by element, O(elements (m s + m n)) with s the element size; summed over ranks.
std::vector<MatrixXd> calc_generalized_geometric_stiffness(const fe::Model& model, const fe::AppliedLoads& loads,
                                                           const MatrixXd& U, const MatrixXd& Phi);

struct ReduceOptions {
  std::function<void(const std::string& stage)> progress;
  std::string solver;  ///< EPS type of SLEPc for the modes (modal::find_eps_type)
  /// Loads (basic) that get residual vectors in addition to those of the spec; empty function: none.
  std::function<modal::response::ResidualLoads(const fe::Model&)> residual_loads;
};

struct ReducedBody {
  records::FlexBody body;
  BasisCheck check;  ///< of its modal matrices and normal modes
};

/// Reduces a deck to a flexible body: model, modes, mass integrals, F_I, K_G1, K_G2.
///
/// Every locator is in body axes. K_G is solved on the SPC set of a fixed body, on a determinate support of a free one.
///
/// \return the same complete record on every rank.
/// \throws InputError with all of reduce.no-modes, reduce.bad-select, reduce.bad-mass, reduce.bad-integrals,
///     reduce.bad-support, reduce.bad-damping, reduce.unknown-node, reduce.bad-direction; or reduce.grounded,
///     reduce.mechanism; and the errors of fe and modal.
/// \note Collective.
ReducedBody reduce(const records::Deck& deck, const records::BodySpec& spec, const ReduceOptions& options,
                   Diagnostics& diagnostics);

}  // namespace bough::stiffening
