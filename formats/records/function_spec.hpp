#pragma once
/// \file [[function]] of a system file.
#include <map>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::records {

struct FunctionRecord {
  std::string name;
  std::string type;                      ///< constant step ramp pulse sine ... (solver/functions/function.hpp)
  std::map<std::string, double> values;  ///< parameters by key, after defaults
  std::vector<double> x, y;              ///< table
  std::string file;                      ///< table: where x and y come from; empty: from the system file
  std::string time_column, column;       ///< table, of a file: names or numbers of its columns; empty: 1 and 2
  std::string interpolation = "linear";  ///< table: linear or cubic
  std::string law = "logarithmic";       ///< sweep: its frequency over time, or linear
  std::string expression;                ///< expression: of t; x: its jumps and corners
  std::string first, second;             ///< expression: its derivatives; empty: not known
  std::vector<std::string> of;           ///< sum, product: names of functions
  std::vector<double> weights;           ///< sum: a factor of each; empty: 1
  SourceLocation at;
};

}  // namespace bough::records
