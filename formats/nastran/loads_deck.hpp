#pragma once
/// \file The twelve inertial loads of a body as load cards, for another FE program (NASA-CR-202063 4.1.2).
#include <string>

#include "formats/records/flex_body.hpp"

namespace bough::nastran {

inline constexpr int kFirstInertialSet = 101;

/// FORCE, MOMENT and SLOAD cards in sixteen columns (ten digits at least), a load set for each column of F_I:
/// first_set for ax, ... first_set + 11 for wywz, in basic axes (CID 0); loads that are zero everywhere have a remark
/// and no card. Their K_G is K_G1 of the body but for the second order of masses that their grids carry off centre or
/// turning (docs/theory/flexible-body.md §3), which no nodal load has. Needs F_I and its dof_map.
std::string write_loads_deck(const records::FlexBody& body, int first_set = kFirstInertialSet);

}  // namespace bough::nastran
