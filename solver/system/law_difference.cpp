#include "solver/system/law_difference.hpp"

#include <algorithm>
#include <cmath>

#include "solver/tree/body_sizes.hpp"
#include "solver/tree/coordinates.hpp"

namespace bough::solver {
namespace {

constexpr double kAngle = 0.1, kShare = 0.05;

}  // namespace

Difference differentiate_system(SystemData& data, LawTangents& tangents, const std::function<VectorXd(double)>& f,
                                double step, bool has_large_terms, std::vector<LawKink>* kinks) {
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
        step, has_large_terms);
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
  const VectorXd sizes = calc_body_sizes(tree);
  VectorXd carried = sizes;
  for (int b = tree.size() - 1; b >= 0; --b)
    if (tree[b].parent >= 0) carried[tree[b].parent] = std::max(carried[tree[b].parent], carried[b]);
  VectorXd steps(tree.num_u);
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    const double size = sizes[b];
    for (int i = 0; i < tb.num_hinge_u(); ++i)
      steps[tb.u_offset + i] = is_translation(tb, i) ? kShare * carried[b] : kAngle;
    for (int i = 0; i < tb.num_modes(); ++i) {
      double largest = 0;
      for (const Node& node : tb.body.nodes())
        if (node.is_material) largest = std::max({largest, node.phi.col(i).norm() / size, node.psi.col(i).norm()});
      steps[tb.eta_dot_offset() + i] = largest > 0 ? kShare / largest : 1;
    }
  }
  return steps;
}

double calc_far_step(const TreeData& data) {
  constexpr double kFarShare = 1e-6;
  double reach = 0;
  for (const BodyData& body : data.bodies) reach = std::max(reach, body.state.p_WBo.norm());
  return kFarShare * reach;
}

bool lies_far(const Tree& tree, const TreeData& data) {
  const VectorXd sizes = calc_body_sizes(tree);
  return sizes.size() > 0 && calc_far_step(data) > 1e-3 * sizes.maxCoeff();
}

}  // namespace bough::solver
