#pragma once
/// \file What a body file says of basis, frame and damping, in the terms of modal/bases.
#include "fe/loads/loads.hpp"
#include "fe/loads/temperatures.hpp"
#include "formats/records/body_spec.hpp"
#include "formats/records/deck.hpp"
#include "modal/bases/basis.hpp"
#include "modal/bases/damping.hpp"

namespace bough::stiffening {

using Eigen::MatrixXd;

/// One load of a body: a unit at a node and direction, or a load set; `F` num_gdofs in basic.
struct BodyLoad {
  std::string group;  ///< the name in the body file; "" for the translations of the interface nodes
  records::Locator locator;
  fe::AppliedLoad load;
  fe::InitialForces initial;  ///< of a temperature set
  int load_set = 0;           ///< whose loads along beams the forces of elements hold; 0: none
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

/// Φᵀ Σ (g + GE) K_e Φ, n x n: g is PARAM,G, GE of the material or property of each element (MAT1, MAT2, MAT8, MAT9,
/// PCOMP, PELAS, CELAS2, PBUSH); MID1 of a PSHELL counts for all of it (Quick Reference Guide, PSHELL).
MatrixXd calc_material_damping(const fe::Model& model, double g, const MatrixXd& Phi);

}  // namespace bough::stiffening
