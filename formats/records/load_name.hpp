#pragma once
/// \file Name of the static load of a subcase.
#include <string>

#include "formats/records/deck.hpp"

namespace bough::records {

/// "LOAD 2", "P2G", "LOAD and P2G": the set of a load with columns of P2G is in no deck.
inline std::string name_load(const Subcase& subcase) {
  const auto p2g = subcase.commands.find("P2G"), load = subcase.commands.find("LOAD");
  if (p2g == subcase.commands.end()) return "LOAD " + std::to_string(subcase.load);
  const bool has_cards = load != subcase.commands.end() && load->second.line != p2g->second.line;
  return has_cards ? "LOAD and P2G" : "P2G";
}

}  // namespace bough::records
