#pragma once
/// \file The verbs `frequency` and `transient`, as in cli/verbs.hpp.
#include "cli/verbs.hpp"

namespace bough::cli {

void add_frequency(CLI::App& app, Action& action);
void add_transient(CLI::App& app, Action& action);

}  // namespace bough::cli
