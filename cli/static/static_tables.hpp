#pragma once
/// \file Tables and JSON of a static subcase.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "formats/records/static_result.hpp"

namespace bough::cli {

/// Maxima, balance and element forces; `full`: every grid and element. `dof_map`: of StaticResult.
std::string format_static(const Eigen::MatrixXi& dof_map, const records::StaticSubcase& subcase, bool full);
nlohmann::json to_json(const Eigen::MatrixXi& dof_map, const records::StaticSubcase& subcase, bool full);

}  // namespace bough::cli
