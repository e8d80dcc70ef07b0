#include "solver/system/levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bough::solver {
namespace {

constexpr double kAttached = 1e3;  // weight of nodes that carry hinges
constexpr double kRankTolerance = 1e-9;
constexpr double kConverged = 1e-14;  // of the coordinates
constexpr int kMaxIterations = 30;

Vector3d calc_rotation_vector(const Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

class Matcher {
 public:
  Matcher(const System& from, const SystemData& from_data, const System& to, SystemData& to_data, double t, int body,
          Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u)
      : to_(to), data_(to_data), t_(t), body_(body), q_(q), u_(u) {
    find_nodes(from, from_data);
    find_rows();
  }

  LevelMatch run() {
    match_positions();
    match_velocities();
    return calc_match();
  }

 private:
  struct Pair {
    int node = 0;    ///< index in the body of `to`
    NodeMotion old;  ///< of `from`
    double weight = 1;
  };

  const TreeBody& get_body() const { return to_.tree[body_]; }

  /// Nodes that both levels have, node 0 left out: the origin is no point of the material.
  void find_nodes(const System& from, const SystemData& from_data) {
    const auto& old_nodes = from.tree[body_].body.nodes();
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (size_t i = 1; i < old_nodes.size(); ++i) {
      const int node = get_body().body.find_node(old_nodes[i].id);
      if (node <= 0) continue;
      pairs_.push_back({node, calc_node_motion(from, from_data, body_, static_cast<int>(i)), 1});
      low = low.cwiseMin(old_nodes[i].p);
      high = high.cwiseMax(old_nodes[i].p);
    }
    size_ = pairs_.size() > 1 ? std::max((high - low).norm(), 1e-300) : 1;
    const auto weigh = [&](const Marker& marker) {
      for (Pair& pair : pairs_)
        if (marker.body == body_ && marker.node == pair.node) pair.weight = kAttached;
    };
    for (const Marker& marker : to_.tree.markers) weigh(marker);
  }

  void find_rows() {
    const TreeBody& tb = get_body();
    bool is_free = tb.num_hinge_u() == 6 && tb.num_hinge_q() == 7;
    for (int i = 0; i < tb.num_hinge_u(); ++i)
      is_free = is_free && data_.tree.mode[static_cast<size_t>(tb.u_offset + i)] == HingeMode::Free;
    for (int i = 0; is_free && i < 6; ++i) rows_.push_back(tb.u_offset + i);
    for (int j = 0; j < tb.num_modes(); ++j) rows_.push_back(tb.eta_dot_offset() + j);
  }

  /// Velocities of the nodes at rates u, weighted: 6 rows per node.
  VectorXd calc_velocities(const VectorXd& u) {
    calc_kinematics(to_, data_, t_, q_, u);
    VectorXd v(6 * std::ssize(pairs_));
    for (size_t i = 0; i < pairs_.size(); ++i) {
      const NodeMotion k = calc_node_motion(to_, data_, body_, pairs_[i].node);
      v.segment<3>(6 * static_cast<Eigen::Index>(i)) = pairs_[i].weight * k.v_WK;
      v.segment<3>(6 * static_cast<Eigen::Index>(i) + 3) = pairs_[i].weight * size_ * k.w_WK;
    }
    return v;
  }

  /// ∂velocities/∂u of rows_, at q_.
  MatrixXd calc_jacobian() {
    const VectorXd zero = VectorXd::Zero(to_.num_u());
    const VectorXd none = calc_velocities(zero);
    MatrixXd J(none.size(), std::ssize(rows_));
    for (size_t i = 0; i < rows_.size(); ++i) {
      VectorXd unit = zero;
      unit[rows_[i]] = 1;
      J.col(static_cast<Eigen::Index>(i)) = calc_velocities(unit) - none;
    }
    return J;
  }

  static VectorXd solve(const MatrixXd& J, const VectorXd& residual) {
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> factor;
    factor.setThreshold(kRankTolerance);
    factor.compute(J);
    return factor.solve(residual);
  }

  void match_positions() {
    const TreeBody& tb = get_body();
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      const MatrixXd J = calc_jacobian();
      calc_kinematics(to_, data_, t_, q_, VectorXd::Zero(to_.num_u()));
      VectorXd gap(J.rows());
      for (size_t i = 0; i < pairs_.size(); ++i) {
        const NodeMotion k = calc_node_motion(to_, data_, body_, pairs_[i].node);
        const auto row = 6 * static_cast<Eigen::Index>(i);
        gap.segment<3>(row) = pairs_[i].weight * (pairs_[i].old.p_WK - k.p_WK);
        gap.segment<3>(row + 3) =
            pairs_[i].weight * size_ * calc_rotation_vector(pairs_[i].old.R_WK * k.R_WK.transpose());
      }
      const VectorXd change = solve(J, gap);
      VectorXd step = VectorXd::Zero(to_.num_u()), q_dot(to_.num_q());
      for (size_t i = 0; i < rows_.size(); ++i) step[rows_[i]] = change[static_cast<Eigen::Index>(i)];
      calc_q_dot(to_, data_, t_, q_, step, q_dot);
      const int first = rows_.front() == tb.u_offset ? tb.q_offset : tb.eta_offset();
      const int count = tb.eta_offset() + tb.num_modes() - first;
      q_.segment(first, count) += q_dot.segment(first, count);
      if (first == tb.q_offset) q_.segment<4>(first).normalize();
      if (change.norm() <= kConverged * (1 + q_.segment(first, count).norm())) return;
    }
  }

  void match_velocities() {
    const MatrixXd J = calc_jacobian();
    VectorXd rest = u_;
    for (const int row : rows_) rest[row] = 0;
    VectorXd gap = -calc_velocities(rest);
    for (size_t i = 0; i < pairs_.size(); ++i) {
      const auto row = 6 * static_cast<Eigen::Index>(i);
      gap.segment<3>(row) += pairs_[i].weight * pairs_[i].old.v_WK;
      gap.segment<3>(row + 3) += pairs_[i].weight * size_ * pairs_[i].old.w_WK;
    }
    const VectorXd rates = solve(J, gap);
    for (size_t i = 0; i < rows_.size(); ++i) u_[rows_[i]] = rates[static_cast<Eigen::Index>(i)];
  }

  LevelMatch calc_match() {
    LevelMatch match;
    match.body = body_;
    calc_kinematics(to_, data_, t_, q_, u_);
    for (const Pair& pair : pairs_) {
      const NodeMotion k = calc_node_motion(to_, data_, body_, pair.node);
      match.position = std::max(match.position, (k.p_WK - pair.old.p_WK).norm());
      match.rotation = std::max(match.rotation, calc_rotation_vector(pair.old.R_WK * k.R_WK.transpose()).norm());
      match.velocity = std::max(match.velocity, (k.v_WK - pair.old.v_WK).norm());
    }
    return match;
  }

  const System& to_;
  SystemData& data_;
  double t_;
  int body_;
  Eigen::Ref<VectorXd> q_, u_;
  std::vector<Pair> pairs_;
  std::vector<int> rows_;
  double size_ = 1;
};

}  // namespace

std::vector<LevelMatch> match_levels(const System& from, const SystemData& from_data, const System& to,
                                     SystemData& to_data, double t, Eigen::Ref<VectorXd> q, Eigen::Ref<VectorXd> u) {
  std::vector<LevelMatch> matches;
  for (int b = 0; b < to.num_bodies(); ++b) {
    if (from.get_level(from.variant, b) == to.get_level(to.variant, b)) continue;
    matches.push_back(Matcher(from, from_data, to, to_data, t, b, q, u).run());
  }
  return matches;
}

}  // namespace bough::solver
