#include "solver/system/load_friction.hpp"

#include <algorithm>
#include <sstream>

#include "solver/system/system.hpp"

namespace bough::solver {
namespace {

constexpr int kMaxIterations = 100, kMaxCorrections = 8;
constexpr double kConverged = 1e-14;  // change of the loads, of the largest
constexpr double kAccepted = 1e-10;   // likewise, where round-off ends the corrections
constexpr int kHomotopySteps = 8;

[[noreturn]] void fail(const System& system, const SystemData& data) {
  Eigen::Index worst = 0;
  data.friction.coefficient.cwiseAbs().maxCoeff(&worst);
  const LoadFriction& friction = system.load_frictions[static_cast<size_t>(worst)];
  std::ostringstream what;
  what << "friction of " << friction.name << " has no value at t = " << data.tree.t
       << ": the load of the bearing grows by as much as the friction that it makes";
  throw ComputationError("solver.friction-jams", friction.at, what.str(),
                         "lower mu or the arms of friction: the joint locks itself while it slides");
}

void solve_tree(const System& system, SystemData& data, Eigen::Ref<VectorXd> u_dot) {
  solve(system.tree, data.tree, u_dot);
  close_loops(system.loops, system.tree, data.tree, data.loops, u_dot, true);
}

// L(reactions) - L, and ∂L/∂L at the loads of the argument, by the affine reactions.
void calc_residual(const System& system, LoadFrictionData& d, const VectorXd& load) {
  for (size_t i = 0; i < system.load_frictions.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    HingeReaction r = d.reactions[i];
    for (Eigen::Index j = 0; j < load.size(); ++j) {
      r.force += load[j] * d.response.block<3, 1>(6 * k, j);
      r.moment += load[j] * d.response.block<3, 1>(6 * k + 3, j);
    }
    Vector6d slope;
    d.residual[k] = system.load_frictions[i].calc_load(r, d.axis[i], &slope) - load[k];
    for (Eigen::Index j = 0; j < load.size(); ++j) d.slope(k, j) = slope.dot(d.response.block<6, 1>(6 * k, j));
  }
}

bool factor(LoadFrictionData& d, double share) {
  d.matrix = -share * d.slope;
  d.matrix.diagonal().array() += 1;
  d.factor.compute(d.matrix);
  return d.factor.determinant() > 0;
}

}  // namespace

LoadFrictionData make_load_friction_data(std::size_t n) {
  const auto size = static_cast<Eigen::Index>(n);
  LoadFrictionData d;
  d.load = d.coefficient = d.residual = d.step = VectorXd::Zero(size);
  d.axis.assign(n, Vector3d::UnitX());
  d.reactions.resize(n);
  d.response = MatrixXd::Zero(6 * size, size);
  d.slope = d.matrix = MatrixXd::Zero(size, size);
  d.factor = Eigen::PartialPivLU<MatrixXd>(size);
  return d;
}

void apply_load_friction(const System& system, SystemData& data, const VectorXd& load) {
  for (size_t i = 0; i < system.load_frictions.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const int row = system.load_frictions[i].u_row;
    const double force = -data.friction.coefficient[k] * load[k];
    data.tree.hinge_force[row] += force - data.tree.load_friction[row];
    data.tree.load_friction[row] = force;
  }
}

void add_load_friction(const System& system, SystemData& data, Eigen::Ref<VectorXd> u_dot) {
  const auto& frictions = system.load_frictions;
  LoadFrictionData& d = data.friction;
  TreeData& tree = data.tree;
  for (size_t i = 0; i < frictions.size(); ++i) {
    const LoadFriction& f = frictions[i];
    const auto k = static_cast<Eigen::Index>(i);
    d.axis[i] = f.calc_axis(tree);
    d.reactions[i] = calc_hinge_reaction(system.tree, tree, f.body);
    d.load[k] = f.calc_load(d.reactions[i], d.axis[i]);
    d.coefficient[k] = 0;
    if (tree.mode[static_cast<size_t>(f.u_row)] != HingeMode::Free) continue;
    const double slide = tree.slide[f.u_row];
    d.coefficient[k] = evaluate_scalar_law(tree.tangents, {&f, "friction of", f.name}, 0, tree.u[f.u_row],
                                           [&](auto rate) { return f.calc_coefficient(rate, slide); });
  }
  // The response of a coordinate is taken at a load of the size of all.
  const double unit = d.load.maxCoeff();
  if (unit > 0 && !d.coefficient.isZero(0)) {
    for (size_t j = 0; j < frictions.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      if (d.coefficient[column] == 0) {
        d.response.col(column).setZero();
        continue;
      }
      d.step.setZero();
      d.step[column] = unit;
      apply_load_friction(system, data, d.step);
      solve_tree(system, data, u_dot);
      for (size_t i = 0; i < frictions.size(); ++i) {
        const HingeReaction r = calc_hinge_reaction(system.tree, tree, frictions[i].body);
        const auto row = 6 * static_cast<Eigen::Index>(i);
        d.response.block<3, 1>(row, column) = (r.force - d.reactions[i].force) / unit;
        d.response.block<3, 1>(row + 3, column) = (r.moment - d.reactions[i].moment) / unit;
      }
    }
    double change = 0;
    for (int i = 0; i < kMaxIterations; ++i) {
      calc_residual(system, d, d.load);
      if (!factor(d, 1)) fail(system, data);
      d.step = d.factor.solve(d.residual);
      change = d.step.cwiseAbs().maxCoeff();
      d.load += d.step;
      if (!(change > kConverged * d.load.cwiseAbs().maxCoeff())) break;
    }
    if (!(change <= kAccepted * d.load.cwiseAbs().maxCoeff()) || !(d.load.minCoeff() >= 0)) fail(system, data);
    calc_residual(system, d, d.load);
    for (int s = 1; s <= kHomotopySteps; ++s)
      if (!factor(d, static_cast<double>(s) / kHomotopySteps)) fail(system, data);
    double last = 0;
    for (int i = 0;; ++i) {
      apply_load_friction(system, data, d.load);
      solve_tree(system, data, u_dot);
      for (size_t k = 0; k < frictions.size(); ++k) {
        const HingeReaction r = calc_hinge_reaction(system.tree, tree, frictions[k].body);
        const auto row = static_cast<Eigen::Index>(k);
        d.residual[row] = frictions[k].calc_load(r, d.axis[k]) - d.load[row];
      }
      change = d.residual.cwiseAbs().maxCoeff() / d.load.cwiseAbs().maxCoeff();
      if (!(change > kConverged) || (i > 0 && change > 0.5 * last)) break;
      if (i == kMaxCorrections) break;
      last = change;
      d.step = d.factor.solve(d.residual);
      d.load += d.step;
    }
    if (!(change <= kAccepted)) fail(system, data);
  }
  for (size_t i = 0; i < frictions.size(); ++i)
    tree.friction_limit[frictions[i].u_row] = frictions[i].at_rest * d.load[static_cast<Eigen::Index>(i)];
}

}  // namespace bough::solver
