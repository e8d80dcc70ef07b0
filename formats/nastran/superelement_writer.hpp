#pragma once
/// \file Bulk data of an external superelement, as Nastran's EXTSEOUT writes it.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/deck.hpp"

namespace bough::nastran {

/// Rows of its matrices: six of each grid in basic axes, then the scalar points.
struct ExternalComponent {
  int id = 0;                                          ///< of the superelement
  int unit = 0;                                        ///< of ASSIGN INPUTT4 in the assembly deck
  std::vector<std::pair<int, Eigen::Vector3d>> grids;  ///< ascending; places in basic
  std::vector<int> scalar_points;                      ///< ascending
  std::vector<records::RecoveryTable> recovery;        ///< their items alone are written
};

struct ExternalTexts {
  std::string assembly;  ///< .asm: for the main bulk data
  std::string section;   ///< .pch: BEGIN SUPER, after the main bulk data
};
/// Writes SEBULK, SECONCT and grids for the assembly, and EXTRN, ASET and recovery tables for the section.
ExternalTexts write_external_component(const ExternalComponent& component);

}  // namespace bough::nastran
