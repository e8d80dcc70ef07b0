#pragma once
/// \file The tables that a Nastran user looks for: mass properties, ground check, AUTOSPC, cards.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "analysis/check/check.hpp"
#include "analysis/common/subcase_failures.hpp"
#include "fe/matrices/checks.hpp"
#include "fe/matrices/grid_point_weight.hpp"
#include "formats/records/deck.hpp"

namespace bough::cli {

/// Φ_RᵀMΦ_R about the reference, centre of mass, inertia about the reference, about the centre of mass, principal.
std::string format_mass_properties(const records::MassProperties& properties);
/// Text of the grid point weight generator, before WTMASS: matrices MO and S, mass and centre of mass along the axes of
/// S.
std::string format_weight(const fe::GridPointWeight& weight);
/// Table of the six rigid-body motions on g-, n- and f-set; "pass" below 1e-9 of the reference energy.
std::string format_ground_check(const analysis::GroundChecks& ground);
/// Connected parts, coincident and unused grids, and the worst shapes of plane and solid elements.
std::string format_geometry(const fe::Model& model, const records::Deck& deck);
/// The numbers of format_geometry() as JSON.
nlohmann::json make_geometry_json(const fe::Model& model, const records::Deck& deck);
/// Table of the section properties of every PBARL and PBEAML, station by station; empty without them.
std::string format_sections(const records::Deck& deck);
/// The numbers of format_sections() as JSON.
nlohmann::json make_sections_json(const records::Deck& deck);
/// At most ten of them.
std::string format_autospc(const fe::Model& model);
/// Number of cards of each name; skipped cards with the place of the first one.
std::string format_card_counts(const records::Deck& deck);

/// [{"id": 7, "messages": [...]}, ...]
nlohmann::json to_json(const analysis::SubcaseFailures& failures);
/// MO, S, masses, centres of mass and inertia matrices as JSON.
nlohmann::json to_json(const fe::GridPointWeight& weight);
/// The numbers of format_mass_properties() as JSON.
nlohmann::json to_json(const records::MassProperties& properties);
/// Rows of any matrix or the entries of any vector as nested JSON arrays.
nlohmann::json to_json(const Eigen::Ref<const Eigen::MatrixXd>& matrix);
/// Entries of a vector as a flat JSON array.
nlohmann::json to_json_list(const Eigen::Ref<const Eigen::VectorXd>& vector);

}  // namespace bough::cli
