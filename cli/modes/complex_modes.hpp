#pragma once
/// \file `bough modes` of SOL 107 and 110: complex eigenvalues.
#include "cli/common/console.hpp"
#include "cli/modes/modes_options.hpp"

namespace bough::cli {

int run_complex_modes(const ModesOptions& options, const std::vector<int>& subcases, Console& console);

}  // namespace bough::cli
