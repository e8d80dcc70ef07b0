#pragma once
/// \file Functions of a system file outside a run: for arrows and curves.
#include <memory>
#include <string>
#include <vector>

#include "formats/records/system_spec.hpp"
#include "solver/functions/function.hpp"

namespace bough::analysis {

/// The functions of a system file, made as a run makes them. The spec must outlive it.
class SpecFunctions {
 public:
  explicit SpecFunctions(const records::SystemSpec& spec) : spec_(spec) {}
  /// nullptr for a function that is not there or cannot be made.
  const solver::TimeFunction* find(const std::string& name);

 private:
  const records::SystemSpec& spec_;
  std::vector<std::unique_ptr<const solver::TimeFunction>> kept_;
  solver::FunctionMap made_;
};

/// Points of a [[function]], for a picture.
struct FunctionCurve {
  std::string name, type;
  bool is_of_time = true;  ///< false: a table, whose argument is what it is used for
  Eigen::VectorXd x;       ///< time of the run [T], or the range of a table and a tenth of it to each side
  Eigen::VectorXd y;
};
/// Curves of the functions that can be made, in the order of the file, each with at least 400 points; at a jump two
/// points with the values on both sides.
std::vector<FunctionCurve> list_function_curves(const records::SystemSpec& spec);

}  // namespace bough::analysis
