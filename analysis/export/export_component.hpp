#pragma once
/// \file A deck or a flexible body as an external superelement of Nastran: .op4, .asm and .pch of EXTSEOUT.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::analysis {

struct ComponentExportOptions {
  int id = 0;                 ///< of the superelement; 0: EXTID of the deck, else 1
  int unit = 0;               ///< of the .op4 in the assembly deck; 0: MATOP4 of the deck, else the id
  std::string vendor = "nx";  ///< whose names of matrices
  int first_point = 0;        ///< id of the first generalized coordinate of a body; 0: 1001 above the highest node
};

struct ComponentSummary {
  int id = 0;                                      ///< of the superelement
  std::size_t num_grids = 0, num_generalized = 0;  ///< boundary grids, generalized coordinates
  std::string stem;                                ///< of the files written
};

/// Writes STEM.op4, STEM.asm, STEM.pch.
ComponentSummary export_component(const std::string& file, const std::string& stem,
                                  const ComponentExportOptions& options, const std::vector<std::string>& ignore_cards,
                                  Diagnostics& diagnostics);

}  // namespace bough::analysis
