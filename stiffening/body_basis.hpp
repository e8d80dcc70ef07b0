#pragma once
/// \file What a body file says of basis, frame and damping, in the terms of modal/bases.
#include "bough/fe/model/temperatures.hpp"
#include "bough/formats/records/body_spec.hpp"
#include "bough/formats/records/deck.hpp"
#include "bough/modal/bases/basis.hpp"
#include "bough/modal/bases/damping.hpp"

namespace bough::stiffening {

using Eigen::MatrixXd;

/// One load of a body: a unit at a node and direction, or a load set; `F` num_gdofs in basic.
struct BodyLoad {
  std::string group;  ///< the name in the body file; "" for the translations of the interface nodes
  records::Locator locator;
  fe::AppliedLoad load;
  fe::InitialForces initial;  ///< of a temperature set
};

/// Reports reduce.no-modes, reduce.bad-basis, reduce.unknown-load.
/// `needs_modes`: no modes are given.
void check_basis(const records::BodySpec& spec, bool needs_modes, const SourceLocation& where,
                 Diagnostics& diagnostics);

/// Reports reduce.bad-damping.
void check_damping(const records::BodySpec& spec, const SourceLocation& where, Diagnostics& diagnostics);

/// Columns of F for the residual vectors that the spec names, in its order; `names` one per column.
MatrixXd collect_residual_loads(const fe::Model& model, const records::BodySpec& spec,
                                const std::vector<BodyLoad>& loads, std::vector<std::string>& names);

modal::bases::BasisOptions make_basis_options(const records::BodySpec& spec);
/// The frame of a body that is neither Fixed nor Free.
modal::bases::FrameSpec make_frame_spec(const records::BodySpec& spec);
modal::bases::DampingSpec make_damping_spec(const records::BodySpec& spec);

/// Σ g_e K_e times Φ, projected: n x n. g_e: GE of MAT1, PELAS, CELAS2 and PBUSH, and PARAM,G for every element. The
/// deck with each modulus times its GE is assembled as any other. Warns reduce.no-ge where other materials are used.
MatrixXd calc_material_damping(const records::Deck& deck, const MatrixXd& Phi, const SourceLocation& where,
                               Diagnostics& diagnostics);

}  // namespace bough::stiffening
