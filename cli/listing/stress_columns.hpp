#pragma once
/// \file Stresses of elements in the columns of Nastran's tables (docs/formats/op2.md).
#include <functional>
#include <map>
#include <optional>

#include "fe/model/model.hpp"
#include "formats/records/listing.hpp"
#include "formats/records/static_result.hpp"

namespace bough::cli {

/// ST, SC, SS of the MAT1 of bars, beams and rods; 0: not given.
struct StressLimits {
  double tension = 0, compression = 0, shear = 0;
};
std::map<int, StressLimits> list_stress_limits(const records::Deck& deck);

/// limit / |stress| - 1 for tension and compression; no number without a limit, or where nothing of that sign acts.
double calc_margin(double stress, double limit);

/// Of the elements of one card that `is_wanted` (ids) takes, by their ids; none where this card has no such table.
/// `forces`: of the same card.
std::optional<records::ListedElements> make_listed_stresses(const fe::Model& model, const records::Deck& deck,
                                                            const records::ElementStresses& stresses,
                                                            const std::vector<records::ElementForces>& forces,
                                                            const std::map<int, StressLimits>& limits,
                                                            const std::function<bool(int)>& is_wanted);

}  // namespace bough::cli
