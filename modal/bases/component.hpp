#pragma once
/// \file A model reduced to boundary grids and generalized coordinates, as a component of other models (Craig-Bampton).
#include "modal/bases/ritz.hpp"

namespace bough::modal::bases {

struct ComponentOptions {
  std::vector<int> boundary;  ///< grids, six dofs each
  int num_modes = 0;          ///< with the boundary held; 0: all below max_hz
  std::optional<double> max_hz;
  bool has_inertial_residuals = true;  ///< residual vectors of the six accelerations of the boundary (RESVEC)
  std::string solver;                  ///< EPS type of SLEPc; empty: the one that suits
};

/// u_g = Shapes [u_b; q], u_b translations and rotations of the boundary grids in basic axes, grid after grid by id; q
/// of the modes with the boundary held, then of the residual vectors.
struct Component {
  std::vector<int> boundary;
  MatrixXd shapes;  ///< num_gdofs x (6 grids + nq), basic
  MatrixXd K, M, B, K4;
  VectorXd lambda;  ///< nq: K_qq
  int num_modes = 0;
};

/// K_bq is zero and K_qq diagonal by construction. K4 is of GE: PARAM,G of the assembly acts on all of K. K4 and B are
/// empty if nothing damps.
/// Throws as FixedInterface; InputError "modal.held-boundary" for a dof of a boundary grid that a constraint holds or
/// that follows others.
Component calc_component(const fe::System& system, const ComponentOptions& options, Diagnostics& diagnostics);

}  // namespace bough::modal::bases
