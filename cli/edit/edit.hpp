#pragma once
/// \file `bough edit`: a session over a system or a body file.
#include "cli/verbs.hpp"

namespace bough::cli {

void add_edit(CLI::App& app, Action& action);

}  // namespace bough::cli
