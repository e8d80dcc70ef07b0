#pragma once
/// \file The external superelements of a deck in the report of `check`.
#include <nlohmann/json.hpp>
#include <string>

#include "formats/records/deck.hpp"

namespace bough::cli {

/// Adds a paragraph for each superelement to `text`, and json["superelements"].
void check_components(const records::Deck& deck, std::string& text, nlohmann::json& json, Diagnostics& diagnostics);

}  // namespace bough::cli
