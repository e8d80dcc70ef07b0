#pragma once
/// \file Answer of `check` as text and as JSON.
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/check/check.hpp"

namespace bough::cli {

/// Adds the content to `text` and sets the keys of `json`.
void describe(const analysis::CheckAnswer& answer, std::string& text, nlohmann::json& json);

}  // namespace bough::cli
