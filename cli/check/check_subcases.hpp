#pragma once
/// \file Checks of each subcase: its sets exist; resultants of its loads.
#include <nlohmann/json_fwd.hpp>

#include "fe/model/model.hpp"

namespace bough::cli {

/// A table of the subcases that have a load, temperatures or enforced displacements, with the resultants of their loads
/// about the origin. `model`: of the subcase in `options`. What static would refuse is an error, and a warning in decks
/// of other solutions; reports cli.empty-load.
void check_subcases(const records::Deck& deck, const fe::Model& model, const fe::ModelOptions& options,
                    std::string& text, nlohmann::json& json, Diagnostics& diagnostics);

}  // namespace bough::cli
