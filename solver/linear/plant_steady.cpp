// Steady spin of bodies that float: which accelerations it has in inertial coordinates.
#include "solver/linear/plant.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

namespace {

constexpr double kAligned = 1e-9;  // of unit vectors
constexpr double kRounding = 1e-12;
/// Forces below this part of the sum of their terms are roundoff.
constexpr double kCancelled = 1e-13;
/// Step of a translation, of the reach.
constexpr double kReachShare = 0.05;

/// Free translations of a hinge on ground that a turn about ω maps onto each other. In Hp, as ω, v and the rest.
struct FloatingBase {
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 6> axes{3, 0};
  std::vector<int> rates;  ///< of the hinge, one per axis
  Vector3d w = Vector3d::Zero(), v = Vector3d::Zero();
};

FloatingBase find_base(const TreeBody& tb, const TreeData& data, int body) {
  FloatingBase base;
  const auto& H = data[body].hinge.H;
  for (int i = 0; i < tb.num_hinge_u(); ++i) {
    const double rate = data.u[tb.u_offset + i];
    base.v += H.col(i).head<3>() * rate;
    base.w += H.col(i).tail<3>() * rate;
    if (data.mode[static_cast<size_t>(tb.u_offset + i)] != HingeMode::Free || !H.col(i).tail<3>().isZero(0)) continue;
    base.axes.conservativeResize(3, base.axes.cols() + 1);
    base.axes.rightCols<1>() = H.col(i).head<3>();
    base.rates.push_back(i);
  }
  return base;
}

}  // namespace

VectorXd Plant::calc_spin() const {
  const Tree& tree = system_.tree;
  const TreeData& data = data_->tree;
  VectorXd all = VectorXd::Zero(system_.num_u());
  std::vector<int> root(static_cast<size_t>(tree.size()));
  for (int b = 0; b < tree.size(); ++b)
    root[static_cast<size_t>(b)] = tree[b].parent < 0 ? b : root[static_cast<size_t>(tree[b].parent)];
  for (int b = 0; b < tree.size(); ++b) {
    const TreeBody& tb = tree[b];
    if (tb.parent >= 0) continue;
    const FloatingBase base = find_base(tb, data, b);
    if (base.rates.empty() || base.w.isZero(0)) continue;
    const MatrixXd to_rates = base.axes.completeOrthogonalDecomposition().pseudoInverse();
    const Matrix3d P = base.axes * to_rates, turn = skew(Vector3d(base.w.normalized()));
    if (!(turn * P - P * turn).isZero(kAligned)) continue;
    double mass = 0;
    Vector3d momentum = Vector3d::Zero();
    for (int c = b; c < tree.size(); ++c) {
      if (root[static_cast<size_t>(c)] != b) continue;
      Vector3d linear, angular;
      calc_body_momentum(system_, *data_, c, linear, angular);
      mass += data[c].inertia.mass;
      momentum += linear;
    }
    if (!(mass > 0)) continue;
    const Vector3d v_centre = tb.on_parent.R_KM.transpose() * momentum / mass;
    const VectorXd spin = to_rates * base.w.cross(base.v - v_centre);
    for (size_t i = 0; i < base.rates.size(); ++i)
      all[tb.u_offset + base.rates[i]] = spin[static_cast<Eigen::Index>(i)];
  }
  return restrict(all);
}

VectorXd Plant::calc_unsteadiness(const VectorXd& u_dot) const {
  const auto value = u_dot.head(num_dofs()).array();
  const Eigen::ArrayXd spin = calc_spin().array(), rest = value - spin;
  return (rest.abs() > kRounding * (value.abs() + spin.abs())).select(rest, 0.0).matrix();
}

VectorXd Plant::calc_imbalance() const {
  const TreeData& tree = data_->tree;
  const VectorXd spin = calc_spin();
  const auto clear = [](const Imbalance& found) -> VectorXd {
    return (found.force.array().abs() > kCancelled * found.terms.array()).select(found.force, 0.0);
  };
  if (!has_loops()) return restrict(clear(solver::calc_imbalance(system_.tree, tree, expand(spin))));
  // Rates that follow do no work on the loads of the loops. Accelerations that follow are those of the last evaluate.
  const MatrixXd follow = calc_follow();
  const VectorXd u_dot = tree.motion.u_dot, alone = follow *restrict(u_dot);
  const Eigen::ArrayXd terms = VectorXd(u_dot.cwiseAbs() + follow.cwiseAbs()* restrict(u_dot).cwiseAbs()).array();
  const Eigen::ArrayXd bias = (u_dot - alone).array();
  const VectorXd steady = follow * spin + (bias.abs() > kRounding * terms).select(bias, 0.0).matrix();
  const Imbalance all = solver::calc_imbalance(system_.tree, tree, steady);
  return clear({follow.transpose() * all.force, follow.cwiseAbs().transpose() * all.terms});
}

VectorXd Plant::calc_spin_rounding(const OperatingPoint& point) const {
  double w = 0, reach = 0;
  for (int i = 0; i < num_dofs(); ++i)
    if (!is_mode(i) && dof_dims(i) == "1") w = std::max(w, std::abs(point.u[i]));
  // Parents that turn by a motion count too, and positions far from their axis.
  for (int b = 0; b < system_.num_bodies(); ++b) {
    w = std::max(w, data_->tree[b].state.w_B.norm());
    reach = std::max(reach, data_->tree[b].state.p_WBo.norm());
  }
  VectorXd rounding(num_dofs());
  for (int i = 0; i < num_dofs(); ++i) {
    const double way = dof_dims(i) == "L" ? std::max(step(i), kReachShare * reach) : step(i);
    rounding[i] = 10 * kRounding * way * w * w;
  }
  return rounding;
}

}  // namespace bough::solver
