#pragma once
/// \file Load on a node of a body from a hinge, a constraint or a [[force]].
#include <vector>

#include "solver/forces/applied.hpp"
#include "solver/motion/motion.hpp"

namespace bough::solver {

/// One of hinge, constraint, force.
struct NodeSource {
  int node = 0;                         ///< index into Body::nodes()
  int hinge = -1;                       ///< the body whose inboard hinge it is
  int constraint = -1;                  ///< no coupler
  bool is_parent = false;               ///< the node is on the parent's side of it
  const AppliedForce* force = nullptr;  ///< with a function, or constant
};

/// Hinges, constraints and forces at the nodes of `body`, in this order; load patterns are none.
std::vector<NodeSource> list_node_sources(const Tree& tree, const Loops& loops, const std::vector<AppliedForce>& forces,
                                          int body);
/// Force and moment about the node, components in the frame of the body. After calc_accelerations. No allocation.
Vector6d calc_node_load(const NodeSource& source, int body, const Motion& motion);

}  // namespace bough::solver
