#include "solver/tree/body_sizes.hpp"

#include <algorithm>

#include "solver/bodies/extent.hpp"

namespace bough::solver {
namespace {

/// Reach of the hinges of all bodies; 1 where all are at the origin.
double calc_hinge_reach(const Tree& tree) {
  double reach = 0;
  for (const TreeBody& tb : tree.bodies) reach = std::max({reach, tb.on_parent.p_KM.norm(), tb.on_child.p_KM.norm()});
  return reach > 0 ? reach : 1;
}

}  // namespace

VectorXd calc_body_sizes(const Tree& tree) {
  VectorXd sizes(tree.size());
  for (int b = 0; b < tree.size(); ++b) {
    const Body& body = tree[b].body;
    sizes[b] = calc_extent(body);
    if (!(sizes[b] > 0) && body.mass() > 0) sizes[b] = (calc_centre_of_mass(body) - tree[b].on_child.p_KM).norm();
  }
  const double largest = sizes.size() > 0 ? sizes.maxCoeff() : 0;
  const double of_points = largest > 0 ? largest : calc_hinge_reach(tree);
  return sizes.unaryExpr([of_points](double size) { return size > 0 ? size : of_points; });
}

}  // namespace bough::solver
