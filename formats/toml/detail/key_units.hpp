#pragma once
/// \file Units of the keys of a TOML file, by the dimensions in data/schema.
#include <functional>
#include <string>
#include <vector>

#include "formats/toml/detail/unit_expression.hpp"
#include "formats/toml/detail/unit_walk.hpp"

namespace bough::toml_files {

/// Units of names in dimensions, as effort or travel, at one table.
struct KeyContext {
  /// Unit of a name per component, or one unit; empty if it is not known: then the key is not converted. Names that
  /// are powers of M L T F E need no entry. \param key  the key whose dimension has the name.
  std::function<Units(const std::string& name, const std::string& key, const UnitTable& at)> find;
  /// Returns true for each of the `count` components of an angle key that is an angle; by default all are.
  std::function<std::vector<bool>(const std::string& key, std::size_t count)> list_angles = {};
  /// Units of the inputs, for columns of matrices and for formulas.
  Units inputs = {};
};

/// Multiplies the keys of a table, and of tables below it, by the units of their dimensions in the system schema.
/// \param kind  "hinge", "simulation".
void scale_keys(const UnitTable& t, const std::string& kind, const records::UnitChange& change,
                const KeyContext& context);
/// Likewise of a body file, whose root is `t`.
void scale_body_keys(const UnitTable& t, const records::UnitChange& change);

/// Forms of a dimension that are more than a factor: "polynomial: out/in".
/// Multiplies a matrix, whose columns are of the inputs.
void scale_columns(const UnitTable& t, const char* key, double factor, const Units& inputs);
/// Multiplies coefficients by falling powers of a variable of unit 1/time.
void scale_polynomial(const UnitTable& t, const char* key, double factor, double time);
/// Rewrites formulas of u1, u2, ... and t.
void rewrite_formulas(const UnitTable& t, const char* key, double factor, double time, const Units& inputs);

}  // namespace bough::toml_files
