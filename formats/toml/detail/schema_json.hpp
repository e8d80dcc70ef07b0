#pragma once
/// \file Schemas as JSON.
#include <string>

#include <nlohmann/json.hpp>

namespace bough::toml_files {

/// Merges a schema with its $ref; keywords of the schema take precedence.
nlohmann::json resolve_reference(const nlohmann::json& schema, const nlohmann::json& root);

/// Dimension of a key by its keyword `dims`: one text, or one per type of the table with "*" for the other types.
/// \param type  the table's type; empty if it has none.
/// \return empty for a key without a dimension, or for a type that is not listed.
std::string get_dims(const nlohmann::json& key, const std::string& type);

}  // namespace bough::toml_files
