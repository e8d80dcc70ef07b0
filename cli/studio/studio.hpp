#pragma once
/// \file The verb `studio`, as in cli/verbs.hpp.
#include "cli/verbs.hpp"

namespace bough::cli {

void add_studio(CLI::App& app, Action& action);

}  // namespace bough::cli
