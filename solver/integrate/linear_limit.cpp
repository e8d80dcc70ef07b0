#include "solver/integrate/linear_limit.hpp"

#include "solver/system/impl.hpp"

namespace bough::solver {
namespace {
const std::vector<Node>& get_nodes(const System& system, int body) {
  return system.impl().tree.bodies[static_cast<size_t>(body)].body.nodes();
}
}  // namespace

LinearLimit::LinearLimit(const System& system) : system_(system) {
  for (int b = 0; b < system.num_bodies(); ++b) {
    if (system.num_modes(b) == 0) continue;
    double size = 0;
    for (const Node& node : get_nodes(system, b)) size = std::max(size, node.p.norm());
    if (size > 0) watched_.push_back({b, size, false});
  }
}

std::optional<LinearLimit::Crossing> LinearLimit::find_crossing(const Eigen::Ref<const VectorXd>& q) {
  for (Watched& w : watched_) {
    if (w.reported) continue;
    const auto eta = q.segment(system_.eta_offset(w.body), system_.num_modes(w.body));
    for (const Node& node : get_nodes(system_, w.body)) {
      if (!node.moves) continue;
      Vector3d d = Vector3d::Zero();
      for (int j = 0; j < eta.size(); ++j) d += node.phi.col(j) * eta[j];
      if (d.norm() <= kLinearLimit * w.size) continue;
      w.reported = true;
      return Crossing{system_.body_name(w.body), node.id, d.norm(), w.size};
    }
  }
  return {};
}

}  // namespace bough::solver
