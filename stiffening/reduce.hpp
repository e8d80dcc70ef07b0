#pragma once
/// \file F_I, K_G1, K_G2 and the whole reduction of a deck to a flexible body.
#include <functional>

#include "fe/loads/loads.hpp"
#include "fe/loads/second_order.hpp"
#include "fe/statics/statics.hpp"
#include "formats/records/body_spec.hpp"
#include "modal/eigen.hpp"
#include "modal/nodal_dofs.hpp"

namespace bough::stiffening {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using fe::calc_inertial_loads;  ///< of a model
/// F_I for any mass matrix and dof map, as the report's fimake5 (eqs. 3-12): P = M Φ_R (num_dofs x 6). Spin takes every
/// nodal momentum as that of a mass at its node. Rows of generalized dofs carry the six accelerations only: the map
/// does not tell which way a spin turns them.
MatrixXd calc_inertial_loads(const modal::NodalDofs& dofs, const MatrixXd& P);

/// K_G of every load projected on Phi, U (num_gdofs x m) their static solutions: m matrices n x n, accumulated element
/// by element, O(elements (m s + m n)) with s the element size; summed over ranks.
std::vector<MatrixXd> calc_generalized_geometric_stiffness(const fe::Model& model, const fe::AppliedLoads& loads,
                                                           const MatrixXd& U, const MatrixXd& Phi);

struct BasisCheck;

struct ReduceOptions {
  std::function<void(const std::string& stage)> progress;
  fe::ElementFactory elements;                       ///< instead of the deck's own: matrices that are given
  std::function<MatrixXd(const fe::System&)> modes;  ///< num_gdofs x n in basic, instead of solving for them
  std::string solver;                                ///< EPS type of SLEPc for the modes (modal::find_eps_type)
  BasisCheck* check = nullptr;                       ///< gets what check_basis() finds (basis_check.hpp)
  /// Loads (num_gdofs x m, basic) that get residual vectors beside those of the spec; adds their names.
  std::function<MatrixXd(const fe::Model&, std::vector<std::string>& names)> residual_loads;
};

/// The whole preprocessing: model, modes, integrals, F_I, K_G1, K_G2 -> FlexBody. Runs on every rank; the record is
/// complete on each. Every locator is in body axes; K_G is solved on the SPC set of a fixed body, on a determinate
/// support of a free one. Throws InputError with all of reduce.no-modes, reduce.bad-select, reduce.bad-mass,
/// reduce.bad-integrals, reduce.bad-support, reduce.bad-damping, reduce.unknown-node, reduce.bad-direction; or
/// reduce.grounded, reduce.mechanism; and what fe and modal throw.
records::FlexBody reduce(const records::Deck& deck, const records::BodySpec& spec, const ReduceOptions& options,
                         Diagnostics& diagnostics);

}  // namespace bough::stiffening
