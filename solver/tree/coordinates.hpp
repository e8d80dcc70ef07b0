#pragma once
/// \file Names and kinds of the coordinates of a hinge.
#include <string>

#include "solver/tree/tree.hpp"

namespace bough::solver {

/// Translations move without turning. coordinate: from 0.
inline bool is_translation(const TreeBody& tb, int coordinate) {
  VectorXd q(tb.hinge->num_q()), u = VectorXd::Zero(tb.hinge->num_u());
  tb.hinge->set_neutral(q.data());
  HingeMotion motion;
  tb.hinge->calc_motion(q.data(), u.data(), motion);
  return motion.H.col(coordinate).tail<3>().isZero(0);
}

/// Returns true if position `coordinate` (from 0, as in files: a quaternion has one more than rates) is a length.
inline bool is_length(const TreeBody& tb, int coordinate) {
  const bool has_quaternion = tb.num_hinge_q() == tb.num_hinge_u() + 1;
  if (has_quaternion) return coordinate >= 4 && is_translation(tb, coordinate - 1);
  return is_translation(tb, coordinate);
}

enum class HingeQuantity { Position, Rate, Force };

/// Dimensions of `count` coordinates from `first`: one for all, "1/T", or where they differ one each, "L/T, 1/T".
std::string list_hinge_dims(const TreeBody& tb, HingeQuantity quantity, int first, int count);

}  // namespace bough::solver
