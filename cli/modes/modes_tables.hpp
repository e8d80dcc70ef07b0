#pragma once
/// \file What `bough modes` prints.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "formats/records/modes.hpp"
#include "modal/solver_use.hpp"

namespace bough::cli {

std::string format_modes(const records::ModesResult& result);
std::string format_buckling(const records::ModesResult& result);
/// Of properties, then of the elements that hold most; empty without.
std::string format_energies(const records::ModesResult& result);
std::string format_effective_mass_about(const records::ModesResult& result);
/// Rigid-body modes, the norm, the Sturm count, the largest residual, the eigensolver.
std::string format_health(const records::ModesResult& result, const std::vector<modal::SolverUse>& solvers,
                          const std::string& norm, bool buckling);
/// How many of the modes are residual vectors, of which loads, and which of these brought none; empty without loads.
std::string format_residual_vectors(const records::ModesResult& result, const std::vector<std::string>& loads,
                                    const std::vector<std::string>& unused);
nlohmann::json make_json(const records::ModesResult& result, const std::vector<modal::SolverUse>& solvers,
                         const std::string& norm, bool buckling);

}  // namespace bough::cli
