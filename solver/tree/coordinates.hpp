#pragma once
/// \file What the coordinates of a hinge are.
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

}  // namespace bough::solver
