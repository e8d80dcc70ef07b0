#pragma once
/// \file The verbs about linear models, as those of verbs.hpp.
#include "cli/verbs.hpp"

namespace bough::cli {

void add_equilibrium(CLI::App& app, Action& action);
void add_linearize(CLI::App& app, Action& action);
void add_select(CLI::App& app, Action& action);

}  // namespace bough::cli
