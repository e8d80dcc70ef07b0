#pragma once
/// \file Table, JSON and frequency response of retained modes.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/select/selection.hpp"

namespace bough::cli {

/// A body whose modes are rows of a ranking.
struct RankedBody {
  std::string name;  ///< empty: a body without a system
  std::string file;
  const records::FlexBody* body = nullptr;
};

/// Costs and choices of all modes as JSON, and the share of the cost and the peak error of each configuration.
nlohmann::json make_json(const std::vector<RankedBody>& bodies, const analysis::Selection& selection);
/// Table of costs and choices of all modes. \param inertial_load  from 1: a column shows K_G / K of the mode for this
/// inertial load; 0: no column.
std::string format(const std::vector<RankedBody>& bodies, const analysis::Selection& selection, int inertial_load);
/// Frequency response before and after, of the first configuration: .svg is drawn, else CSV.
void write_response(const analysis::Selection& selection, const std::string& path);

}  // namespace bough::cli
