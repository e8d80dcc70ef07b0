#pragma once
/// \file Static deflections of the assembled parts compared with those of the deck.
#include <string>
#include <vector>

#include "analysis/split/assembled_modes.hpp"
#include "analysis/split/split.hpp"

namespace bough::analysis::splitting {

/// Compares deflections under a unit acceleration along x, y and z, and under the load of the subcase. A free
/// structure: under that load, else unit forces at a grid of the first cut, in equilibrium with the inertia of the
/// structure and without rigid-body motion. Empty for a structure that is held in part.
///
/// \param bodies  in the order of the parts
/// \param rigid   num_gdofs x r rigid-body modes of the deck, M-orthonormal
/// \param lambda  [1/T²] of the size of the lowest elastic eigenvalue
/// \throws what fe::StaticSolver and fe::calc_load throw or report
std::vector<ComparedDeflection> compare_deflections(const fe::Model& model, const Structure& structure,
                                                    const Partition& partition, const Assembly& assembly,
                                                    const std::vector<const records::FlexBody*>& bodies,
                                                    const MatrixXd& rigid, double lambda, Diagnostics& diagnostics);

}  // namespace bough::analysis::splitting
