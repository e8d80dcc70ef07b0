#pragma once
/// \file Direct input on the p-set: K2PP, M2PP, B2PP and TF, on the dofs of the model and on extra points.
#include <vector>

#include "fe/model/model.hpp"
#include "formats/records/deck_dynamics.hpp"
#include "modal/complex/quadratic_pencil.hpp"

namespace bough::modal::complex_modes {

/// u_p = N_g u_g + N_e u_e of the p dofs that direct input names; u_g in basic axes, u_p in the CD axes of the grids.
struct PhysicalInput {
  std::vector<int> extra_points;    ///< ids, ascending, without points that have no term
  Eigen::SparseMatrix<double> N_g;  ///< p x num_gdofs
  Eigen::SparseMatrix<double> N_e;  ///< p x extra points
  ComplexSparse K, B, M;            ///< p x p
  std::vector<std::string> names;   ///< "grid 3 component 2", "extra point 9"
  /// Returns true if the subcase selects no direct input.
  bool is_empty() const { return K.rows() == 0; }
  /// [N_g T, N_e] for coordinates q with u_g = T q.
  Eigen::SparseMatrix<double> calc_transform(const Eigen::SparseMatrix<double>& T) const;
};

/// Terms of the DMIG of K2PP, M2PP and B2PP and of the TF cards of TFL. Reports fe.missing-direct, modal.direct-shape,
/// modal.missing-transfer, fe.missing-grid, fe.bad-component, modal.extra-point-unused (warning).
PhysicalInput collect_physical_input(const fe::Model& model, const records::DynamicDeck& deck,
                                     const records::DynamicSubcase& subcase, Diagnostics& diagnostics);

}  // namespace bough::modal::complex_modes
