#pragma once
/// \file A deck or a flexible body as an external superelement of Nastran: .op4, .asm and .pch of EXTSEOUT.
#include <string>
#include <vector>

#include "cli/common/console.hpp"

namespace CLI {
class App;
}

namespace bough::cli {

struct ComponentExportOptions {
  int id = 0;                 ///< of the superelement; 0: EXTID of the deck, else 1
  int unit = 0;               ///< of the .op4 in the assembly deck; 0: MATOP4 of the deck, else the id
  std::string vendor = "nx";  ///< whose names of matrices
  int first_point = 0;        ///< id of the first generalized coordinate of a body; 0: 1001 above the highest node
};

void add_component_options(CLI::App& verb, ComponentExportOptions& options);

/// Writes STEM.op4, STEM.asm, STEM.pch. Returns what was written, in words.
std::string export_component(const std::string& file, const std::string& stem, const ComponentExportOptions& options,
                             const std::vector<std::string>& ignore_cards, Diagnostics& diagnostics);

}  // namespace bough::cli
