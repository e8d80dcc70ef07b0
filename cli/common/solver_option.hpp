#pragma once
/// \file The eigensolver of commands that compute modes: how it is chosen and how it is named.
#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "modal/solver_use.hpp"

namespace bough::cli {

/// --solver.
void add_solver_option(CLI::App& verb, std::string& solver);

/// "eps", "st", "factor" and "solutions" of each.
nlohmann::json to_json(const std::vector<modal::SolverUse>& uses);

}  // namespace bough::cli
