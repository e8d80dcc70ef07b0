#pragma once
/// \file Mass integrals of given matrices and modes (NASA-CR-202063 4.2.3).
#include <optional>
#include <string>

#include "analysis/common/events.hpp"
#include "formats/flx/flx_file.hpp"

namespace bough::analysis {

struct IntegralsRequest {
  std::string model;                   ///< model information file: sizes, DOF map, nodes, options
  std::string matrices;                ///< file with mass, stiffness, damping and mode shapes
  std::string integrals = "momentum";  ///< "momentum": the report's formulas; or "exact"
  int digits = 9;                      ///< significant digits of the .FLX file
  bool inertial_loads = false;         ///< the twelve inertial loads too
};

struct IntegralsAnswer {
  flx::FlxFile file;
  Eigen::MatrixXi dof_map;  ///< [num_dofs x 2] node and DOF of each row of the matrices
  /// [num_dofs x 12] per unit of ax ay az, alx aly alz, wx2 wy2 wz2, wxwy wxwz wywz (docs/formats/flx.md); if
  /// requested.
  std::optional<Eigen::MatrixXd> inertial_loads;
};

/// Warnings: those of the readers, flx.generalized-dofs, flx.missing-dofs. Throws the errors of
/// flx::read_model_input(), flx::read_model_matrices() and modal::calc_matrix_body().
IntegralsAnswer calc_integrals(const IntegralsRequest& request, Events& events);

}  // namespace bough::analysis
