#include "solver/simulate/modal_range_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/bodies/extent.hpp"
#include "solver/bodies/next_order.hpp"
#include "solver/bodies/soft_energy.hpp"
#include "solver/simulate/run.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {
namespace {

/// Deflection in sizes of the body above which round-off leaves the orders of its series apart.
constexpr double kMeasuredWay = 1e-5;

/// Joints that hold a body from which on it stretches as it bends, as a plate by its corners.
constexpr int kMinStretching = 3;

const TreeBody& get_body(const System& system, int body) { return system.tree.bodies[static_cast<size_t>(body)]; }

/// Number of joints that hold a body: its hinge, unless it is free, and constraints.
int count_joints(const System& system, int body) {
  int number = get_body(system, body).hinge->num_u() < 6 ? 1 : 0;
  for (const Constraint& c : system.loops.constraints) {
    if (!c.closure) continue;
    for (const int marker : {c.parent_marker, c.child_marker})
      if (system.tree.markers[static_cast<size_t>(marker)].body == body) ++number;
  }
  return number;
}

}  // namespace

double calc_body_size(const System& system, int b) {
  const TreeBody& tb = get_body(system, b);
  const Body& body = tb.body;
  Eigen::AlignedBox3d box;
  double farthest = 0;  // from Bo
  for (const Node& node : body.nodes()) {
    if (node.id != 0 && node.is_material) box.extend(node.p);
    farthest = std::max(farthest, node.p.norm());
  }
  if (tb.on_child.node == 0 && tb.hinge->num_u() < 6) box.extend(tb.on_child.p_KM);
  const double size = std::max(calc_inertia_extent(body), box.isEmpty() ? 0 : box.diagonal().norm());
  return farthest > 0 && size > 0 ? std::min(farthest, size) : std::max(farthest, size);
}

double calc_first_frequency(const System& system, int b) {
  const Body& body = get_body(system, b).body;
  const int n = body.num_modes();
  if (n == 0) return 0;
  const MatrixXd M = body.make_inertia().M_modal.topLeftCorner(n, n);
  if (Eigen::LLT<MatrixXd>(M).info() != Eigen::Success) return 0;
  const MatrixXd K = 0.5 * (body.K() + body.K().transpose());
  const VectorXd values = Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M).eigenvalues();
  for (const double value : values) {
    if (value > 1e-9 * values[n - 1]) return std::sqrt(value);
  }
  return 0;
}

ModalRangeMonitor::ModalRangeMonitor(const System& system) : system_(&system) {
  for (int b = 0; b < system.num_bodies(); ++b) {
    if (system.num_modes(b) == 0) continue;
    const bool is_stiffened = get_body(system, b).body.stiffened() || system.is_lagged;
    watched_.push_back({b, calc_body_size(system, b), is_stiffened ? 0 : calc_first_frequency(system, b)});
  }
}

std::vector<ModalRangeMonitor::Crossing> ModalRangeMonitor::find_crossings(double t, const SystemData& data,
                                                                           const Eigen::Ref<const VectorXd>& q) {
  std::vector<Crossing> found = find_deflections(q, t);
  for (Crossing& spin : find_spins(t, data)) found.push_back(std::move(spin));
  return found;
}

std::vector<ModalRangeMonitor::Crossing> ModalRangeMonitor::find_deflections(const Eigen::Ref<const VectorXd>& q,
                                                                             std::optional<double> t) {
  std::vector<Crossing> found;
  for (Watched& w : watched_) {
    if (w.reported == Range::Left || !(w.size > 0)) continue;
    const Body& body = get_body(*system_, w.body).body;
    const auto eta = q.segment(system_->eta_offset(w.body), system_->num_modes(w.body));
    double largest = 0;
    const Node* where = nullptr;
    for (const Node& node : body.nodes()) {
      if (!node.moves || !node.is_material) continue;
      Vector3d d = Vector3d::Zero();
      for (int j = 0; j < eta.size(); ++j) d += node.phi.col(j) * eta[j];
      if (d.norm() <= largest) continue;
      largest = d.norm();
      where = &node;
    }
    if (!where) continue;
    const bool is_far = largest > kCheckedWay * w.size;
    // Clamped plates stretch at a way of their thickness.
    const bool is_third = body.third_order() && largest > kMeasuredWay * w.size;
    if (!is_far && !is_third && !body.soft_energy()) continue;
    const auto report = [&](const std::string& limit, const std::string& advice) {
      w.reported = largest > w.size ? Range::Left : Range::Passed;
      found.push_back({w.body, "run.linear-limit",
                       "body '" + system_->body_name(w.body) + "' deflects by " + short_text(largest) + " at node " +
                           std::to_string(where->id) + (t ? " at t = " + short_text(*t) : " at rest") + limit,
                       advice + "cut its deck into several bodies with bough split DECK --parts N"});
    };
    if (largest > w.size) {
      report(", more than its size " + short_text(w.size),
             "the series of its displacements and energy are invalid there, and so are the results from then on; ");
      continue;
    }
    if (w.reported == Range::Passed) continue;
    if (!body.third_order() && !body.stiffened()) {
      if (largest > kLinearLimit * w.size)
        report(", more than " + short_text(100 * kLinearLimit) + " % of its size " + short_text(w.size),
               "linear modes are invalid there; ");
      continue;
    }
    double next = is_far || is_third ? calc_next_order(body, *where, eta, w.size)
                                     : body.soft_energy()->calc_error(*where, body.K(), eta);
    if (count_joints(*system_, w.body) >= kMinStretching) next = std::max(next, calc_small_error(body, eta));
    if (next > kNextOrderLimit)
      report(": the next order of its displacements is estimated at " + short_text(100 * next) +
                 " % of that, more than " + short_text(100 * kNextOrderLimit) + " %",
             body.third_order() ? "" : "set [body.stiffening] order = 3, or ");
  }
  return found;
}

std::vector<ModalRangeMonitor::Crossing> ModalRangeMonitor::find_spins(double t, const SystemData& data) {
  std::vector<Crossing> found;
  for (Watched& w : watched_) {
    const double spin = get_body_state(data, w.body).w_B.norm();
    if (!w.spin_reported && w.frequency > 0 && spin > kSpinLimit * w.frequency) {
      w.spin_reported = true;
      found.push_back(
          {w.body, spin_id,
           "body '" + system_->body_name(w.body) + "' has no stiffening and turns at " + short_text(spin) +
               " at t = " + short_text(t) + ", more than half of its first frequency " + short_text(w.frequency) +
               " (radians per unit of time): without stiffening its modes soften, while the spin stiffens the body",
           "set stiffening = true for this body"});
    }
  }
  return found;
}

bool ModalRangeMonitor::watches_spins() const {
  return std::any_of(watched_.begin(), watched_.end(), [](const Watched& w) { return w.frequency > 0; });
}

VectorXd ModalRangeMonitor::calc_modal_limit() const {
  VectorXd reach = VectorXd::Constant(system_->num_q(), std::numeric_limits<double>::infinity());
  for (const Watched& w : watched_) {
    for (int j = 0; j < system_->num_modes(w.body); ++j) {
      double largest = 0;
      for (const Node& node : get_body(*system_, w.body).body.nodes())
        if (node.is_material) largest = std::max(largest, node.phi.col(j).norm());
      if (largest > 0 && w.size > 0) reach[system_->eta_offset(w.body) + j] = w.size / largest;
    }
  }
  return reach;
}

void ModalRangeMonitor::get_memory(Eigen::Ref<VectorXd> memory) const {
  for (size_t i = 0; i < watched_.size(); ++i) {
    memory[static_cast<Eigen::Index>(2 * i)] = static_cast<double>(watched_[i].reported);
    memory[static_cast<Eigen::Index>(2 * i + 1)] = watched_[i].spin_reported;
  }
}

void ModalRangeMonitor::set_memory(const VectorXd& memory) {
  for (size_t i = 0; i < watched_.size(); ++i) {
    watched_[i].reported = static_cast<Range>(static_cast<int>(memory[static_cast<Eigen::Index>(2 * i)]));
    watched_[i].spin_reported = memory[static_cast<Eigen::Index>(2 * i + 1)] != 0;
  }
}

}  // namespace bough::solver
