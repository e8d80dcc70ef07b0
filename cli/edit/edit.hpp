#pragma once
/// \file The verb `edit`, as in cli/verbs.hpp.
#include "cli/verbs.hpp"

namespace bough::cli {

void add_edit(CLI::App& app, Action& action);

}  // namespace bough::cli
