#pragma once
/// \file Table, JSON and frequency response of retained modes.
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/select/selection.hpp"

namespace bough::cli {

nlohmann::json make_json(const records::FlexBody& body, const analysis::Selection& selection);
std::string format(const records::FlexBody& body, const analysis::Selection& selection, int inertial_load);
/// Frequency response before and after, of the first configuration: .svg is drawn, else CSV.
void write_response(const analysis::Selection& selection, const std::string& path);

}  // namespace bough::cli
