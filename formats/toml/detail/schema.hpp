#pragma once
/// \file Checks a TOML document against one of the JSON Schemas of data/schema: they are the one list of keys, types,
/// ranges and choices, for the reader, for editors and for the documentation.
#include "formats/toml/detail/value.hpp"

namespace bough::toml_files {

/// The text of data/schema/{body,system,campaign,psd,budget}.schema.json, compiled in.
const char* get_body_schema();
const char* get_system_schema();
const char* get_campaign_schema();
/// The text of data/schema/psd.schema.json, of spectral densities for `response --psd`.
const char* get_psd_schema();
/// The text of data/schema/budget.schema.json, of pointing budgets for `response --budget`.
const char* get_budget_schema();

/// Reports every departure of `root` from the schema with the line of the key. The part of JSON Schema 2020-12 that is
/// understood: type, enum, pattern (names), properties, required, additionalProperties, items, minItems, maxItems,
/// minimum, exclusiveMinimum, $ref to #/$defs, and oneOf, anyOf, not, allOf over "required". Beyond the schema, every
/// number has to be finite.
/// Ids: toml.unknown-table toml.unsupported-table toml.unknown-key toml.missing-table toml.missing-key toml.wrong-type
/// toml.wrong-length toml.bad-value toml.bad-name toml.out-of-range toml.conflicting-keys toml.nan.
void check_schema(const Value& root, const char* schema_text, const std::string& file, Diagnostics& diagnostics);

}  // namespace bough::toml_files
