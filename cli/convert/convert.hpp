#pragma once
/// \file The verb `convert`, as in cli/verbs.hpp.
#include "cli/verbs.hpp"

namespace bough::cli {

void add_convert(CLI::App& app, Action& action);

}  // namespace bough::cli
