#pragma once
/// \file Stiffness, mass, damping and geometric stiffness of a deck before constraints.
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/common/model_choice.hpp"
#include "formats/records/static_result.hpp"

namespace bough::analysis {

struct MatricesRequest {
  std::string deck;  ///< file
  ModelChoice model;
  std::vector<int> loads;  ///< load sets of K_G; empty: every LOAD of the case control
  bool no_kg = false;      ///< without geometric stiffness
};

/// Assembles the matrices; whole on the first rank. Collective.
/// \throws what reading, fe and static solutions throw.
records::MatricesResult assemble_matrices(const MatricesRequest& request, Events& events);

}  // namespace bough::analysis
