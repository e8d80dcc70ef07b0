#include "solver/system/law_difference.hpp"

#include <algorithm>
#include <cmath>

#include "solver/tree/coordinates.hpp"

namespace bough::solver {
namespace {

constexpr double kAngle = 0.1, kShare = 0.05;

/// Reach of the nodes and hinges of all bodies; 1 where all lie at the origin.
double calc_size(const Tree& tree) {
  double size = 0;
  for (const TreeBody& tb : tree.bodies) {
    for (const Node& node : tb.body.nodes()) size = std::max(size, node.p.norm());
    size = std::max({size, tb.on_parent.p_KM.norm(), tb.on_child.p_KM.norm()});
  }
  return size > 0 ? size : 1;
}

}  // namespace

Difference differentiate_system(SystemData& data, LawTangents& tangents, const std::function<VectorXd(double)>& f,
                                double step, std::vector<LawKink>* kinks) {
  struct Scope {
    TreeData& tree;
    ~Scope() { tree.tangents = nullptr; }
  } scope{data.tree};
  data.tree.tangents = &tangents;
  tangents.record();
  f(0);
  const auto differentiate_side = [&](int side) {
    return differentiate(
        [&](double h) {
          tangents.replay(side);
          return f(h);
        },
        step);
  };
  Difference mean = differentiate_side(0);
  const auto found = tangents.list_kinks();
  if (found.empty()) return mean;
  const VectorXd half = differentiate_side(1).value - mean.value;
  bool has_effect = false;
  for (Eigen::Index e = 0; e < half.size(); ++e) {
    if (std::abs(half[e]) <= mean.error[e] || std::abs(half[e]) <= 1e-9 * std::abs(mean.value[e])) continue;
    mean.kink[e] = half[e];
    has_effect = true;
  }
  if (has_effect && kinks != nullptr) kinks->insert(kinks->end(), found.begin(), found.end());
  return mean;
}

VectorXd calc_displacement_steps(const Tree& tree) {
  const double size = calc_size(tree);
  VectorXd steps(tree.num_u);
  for (const TreeBody& tb : tree.bodies) {
    for (int i = 0; i < tb.num_hinge_u(); ++i) steps[tb.u_offset + i] = is_translation(tb, i) ? kShare * size : kAngle;
    for (int i = 0; i < tb.num_modes(); ++i) {
      double largest = 0;
      for (const Node& node : tb.body.nodes()) largest = std::max(largest, node.phi.col(i).norm() / size);
      for (const Node& node : tb.body.nodes()) largest = std::max(largest, node.psi.col(i).norm());
      steps[tb.eta_dot_offset() + i] = largest > 0 ? kShare / largest : 1;
    }
  }
  return steps;
}

}  // namespace bough::solver
