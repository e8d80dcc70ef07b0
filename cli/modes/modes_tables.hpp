#pragma once
/// \file Tables and JSON of `bough modes`.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "analysis/modes/sensitivities.hpp"
#include "formats/records/modes.hpp"
#include "modal/solver_use.hpp"

namespace bough::cli {

/// Tables of eigenvalues, frequencies and modal masses, and of effective masses in percent of mass and of inertia about
/// the origin.
std::string format_modes(const records::ModesResult& result);
/// Table of load factors, with the residual of each.
std::string format_buckling(const records::ModesResult& result);
/// Energies of properties, then of the elements with the largest; empty without energies.
std::string format_energies(const records::ModesResult& result);
/// Table of modal effective masses about the grid of MEFFMASS; empty without one.
std::string format_effective_mass_about(const records::ModesResult& result);
/// Rigid-body modes, the norm, the Sturm count, the largest residual, the eigensolver.
std::string format_health(const records::ModesResult& result, const std::vector<modal::SolverUse>& solvers,
                          const std::string& norm, bool buckling);
/// Number of residual vectors, their loads, and the loads without any; empty without loads.
std::string format_residual_vectors(const records::ModesResult& result, const std::vector<std::string>& loads,
                                    const std::vector<std::string>& unused);
/// All numbers of the modes as JSON, with norm, Sturm count and eigensolvers.
nlohmann::json make_json(const records::ModesResult& result, const std::vector<modal::SolverUse>& solvers,
                         const std::string& norm, bool buckling);

/// Slopes of the frequencies: df/dx and (x/f) df/dx of each mode and design variable.
std::string format_sensitivities(const analysis::ModeSensitivities& s);
/// The slopes as JSON.
nlohmann::json make_json(const analysis::ModeSensitivities& s);

}  // namespace bough::cli
