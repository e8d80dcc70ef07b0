#pragma once
/// \file Stresses and strains of elements in the columns of Nastran's tables (docs/formats/op2.md).
#include <functional>
#include <map>
#include <optional>

#include "analysis/listing/element_columns.hpp"
#include "fe/model/model.hpp"
#include "formats/records/listing.hpp"
#include "formats/records/static_result.hpp"

namespace bough::analysis {

/// ST, SC, SS of the MAT1 of bars, beams and rods; 0: not given.
struct StressLimits {
  double tension = 0, compression = 0, shear = 0;
};
/// Collects the stress limits of each bar, beam, tube and rod element by its id; elements whose material has no limit
/// are absent.
std::map<int, StressLimits> list_stress_limits(const records::Deck& deck);

/// limit / |stress| - 1 for tension and compression; no number without a limit, or where nothing of that sign acts.
double calc_margin(double stress, double limit);

/// Stresses or strains (`table`) of the elements of one card that `is_wanted` (ids) selects, by their ids; none if this
/// card has no such table. `forces`: of the same card. Strains have no margins.
std::optional<records::ListedElements> make_listed_stresses(const fe::Model& model, const ElementIndex& elements,
                                                            const records::Deck& deck,
                                                            const records::ElementStresses& stresses,
                                                            const std::vector<records::ElementForces>& forces,
                                                            const std::map<int, StressLimits>& limits,
                                                            const std::function<bool(int)>& is_wanted,
                                                            records::PointTable table = records::PointTable::Stress);

/// Stresses of CBUSH, SA times forces and ST times moments, or strains, EA times translations and ET times rotations,
/// with the coefficients of PBUSH RCV; none for other cards. \param u_g  displacements of the strains.
std::optional<records::ListedElements> make_listed_bushes(const ElementIndex& elements, const records::Deck& deck,
                                                          const records::ElementForces& forces,
                                                          const Eigen::Ref<const Eigen::VectorXd>& u_g,
                                                          const std::function<bool(int)>& is_wanted,
                                                          records::PointTable table);

/// Columns of make_listed_stresses that are linear in the motion, for real and imaginary parts of a response: bars
/// SA1 to SA4, axial, SB1 to SB4; beams SXC to SXF of both ends; rods axial, torsion; plates distance, x, y, xy of both
/// surfaces; plies 11 22 12 xz yz; solids xx yy zz xy yz zx.
void keep_linear_columns(records::ListedElements& block);

}  // namespace bough::analysis
