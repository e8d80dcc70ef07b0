#pragma once
/// \file Checks of a delivered component (Hurty-Craig-Bampton): rigid-body forces, mass, coupling, held frequencies.
#include "fe/matrices/assembly.hpp"

namespace bough::fe {

struct SuperelementCheck {
  int id = 0;
  std::string file;  ///< of its matrices
  int num_grids = 0, num_points = 0;
  /// Strain energy of each of the six rigid-body motions of the boundary grids, divided by the largest that the
  /// diagonal of K would allow: 1e-15 to 1e-13 after a condensation; 0 if K is round-off, as of one boundary grid.
  Eigen::Matrix<double, 6, 1> rigid_energy = Eigen::Matrix<double, 6, 1>::Zero();
  double rigid_force = 0, rigid_moment = 0;  ///< largest of K_bb Φ_r, motions about the centre of the boundary
  records::MassProperties mass;              ///< of Φ_rᵀ M_bb Φ_r about the basic origin
  double coupling = 0;                       ///< largest |K_bq| / sqrt(K_bb K_qq) of the diagonals
  double mass_defect = 0;                    ///< most negative eigenvalue of M, its diagonal scaled to ones; 0: none
  VectorXd held_hz;                          ///< of K_qq, M_qq: boundary held
};

/// Reports fe.superelement-grounded, fe.superelement-coupled (note), fe.superelement-mass as warnings.
SuperelementCheck check_superelement(const records::Deck& deck, const records::Superelement& superelement,
                                     Diagnostics& diagnostics);

/// Warns fe.superelement-stiffening of superelements of the model whose geometric stiffness is not known: delivered
/// matrices, and parts of many boundary dofs.
void report_unstiffened(const Model& model, const records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::fe
