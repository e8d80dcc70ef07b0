#pragma once
/// \file Prescribed motions, closures between two bodies, and the linear model of a start.
#include <string>

#include "solver/linear/linearize.hpp"
#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {

/// Constant rate from zero at t = 0 up to t = 100.
inline records::FunctionRecord make_ramp(const std::string& name, double rate) {
  records::FunctionRecord f;
  f.name = name, f.type = "table";
  f.x = {0, 100}, f.y = {0, 100 * rate};
  return f;
}

/// A closure of a type between two bodies.
inline records::ConstraintRecord make_constraint(const std::string& name, records::ConstraintType type,
                                                 const std::string& parent, const std::string& child) {
  records::ConstraintRecord constraint;
  constraint.name = name, constraint.type = type;
  constraint.parent = parent, constraint.child = child;
  return constraint;
}

/// The linear model about the initial state, with all inputs and outputs.
inline records::LinearModel linearize_start(Plant& plant) {
  Diagnostics diagnostics;
  return linearize(plant, plant.make_initial_point(), {}, {}, diagnostics);
}

}  // namespace bough::solver::testing
