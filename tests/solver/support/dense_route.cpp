#include "tests/solver/support/dense_route.hpp"

#include <algorithm>
#include <cmath>

#include "tests/solver/support/dense_equations.hpp"

namespace bough::solver::testing {
namespace dense_route {

using records::ConstraintRecord;
using records::ConstraintType;
using records::HingeType;

Route::Route(const records::SystemSpec& spec, const std::map<std::string, records::FlexBody>& flex,
             const System& system, const DiscreteState& discrete, const History& history, double t, const VectorXd& x)
    : spec_(spec), flex_(flex), system_(system), discrete_(discrete), history_(history), t_(t), tree_(system.tree) {
  const StateLayout layout = system.layout();
  q_ = get_q(layout, x);
  u_ = get_u(layout, x);
  z_ = get_z(layout, x);
  u_dot_ = VectorXd::Zero(tree_.num_u);
  BOUGH_DEMAND(static_cast<int>(spec.hinges.size()) == tree_.size());
  for (int b = 0; b < tree_.size(); ++b) {
    const auto& hinge = get_hinge(b);
    BOUGH_DEMAND(hinge.child == tree_[b].name);
    for (size_t i = 0; i < hinge.motion.size(); ++i) {
      const Vector3d f = calc_function(hinge.motion[i]);
      const int k = static_cast<int>(i);
      q_[tree_[b].q_offset + k] = f[0];
      u_[tree_[b].u_offset + k] = f[1];
      u_dot_[tree_[b].u_offset + k] = f[2];
    }
  }
  lay_out_states();
}

DenseDerivative Route::calc() {
  const int n = tree_.num_u;
  LongMatrix mass = LongMatrix::Zero(n, n);
  LongVector force = LongVector::Zero(n);
  Acting acting{VectorXd::Zero(n)};  // forces by virtual power
  for (int i = 0; i < n; ++i) units_.push_back(calc_poses(q_, VectorXd::Unit(n, i), VectorXd::Zero(n)));
  const Motion motion = calc_poses(q_, u_, u_dot_);
  for (int b = 0; b < tree_.size(); ++b) add_inertia(b, motion, mass, force, acting.dissipated);
  add_motors(mass, force);
  add_forces(motion, acting);
  VectorXd z_dot = VectorXd::Zero(z_.size());
  add_signals(motion, acting, z_dot);
  force += acting.force.cast<long double>();

  std::vector<int> free;
  for (int i = 0; i < n; ++i)
    if (discrete_.mode[static_cast<size_t>(i)] == HingeMode::Free) free.push_back(i);
  LongMatrix G;
  LongVector gamma;
  calc_constraints(motion, G, gamma);
  const LongMatrix M = mass(free, free), own = G(Eigen::all, free);
  const Eigen::LDLT<LongMatrix> factor(M);
  LongVector solution = factor.solve(LongVector(force(free)));
  LongVector lambda = LongVector::Zero(G.rows());
  long double condition = 1;
  if (G.rows() > 0) {
    // Pseudo-inverse: constraints may depend on each other.
    const LongMatrix A = own * factor.solve(LongMatrix(own.transpose()));
    const Eigen::SelfAdjointEigenSolver<LongMatrix> eigen(A);
    const LongVector right = eigen.eigenvectors().transpose() * (gamma - own * solution);
    const long double least =
        std::max(1e-11L * eigen.eigenvalues().maxCoeff(), 1e-20L);  // or a row that nothing free can move
    for (Eigen::Index i = 0; i < right.size(); ++i) {
      const long double own_value = eigen.eigenvalues()[i];
      if (!(own_value > least)) continue;
      lambda += eigen.eigenvectors().col(i) * (right[i] / own_value);
      condition = std::max(condition, eigen.eigenvalues().maxCoeff() / own_value);
    }
    solution += factor.solve(LongVector(own.transpose() * lambda));
  }
  LongVector change = LongVector::Zero(n);  // `force` has u̇ of prescribed coordinates already
  for (size_t i = 0; i < free.size(); ++i) change[free[i]] = solution[static_cast<Eigen::Index>(i)];
  const LongVector held = mass * change - force - G.transpose() * lambda;
  for (int i = 0; i < n; ++i) {
    if (discrete_.mode[static_cast<size_t>(i)] == HingeMode::Free)
      u_dot_[i] = static_cast<double>(change[i]);
    else
      acting.power += static_cast<double>(held[i]) * u_[i];
  }
  const StateLayout layout = system_.layout();
  VectorXd x_dot(layout.size());
  get_u(layout, x_dot) = u_dot_;
  get_z(layout, x_dot) = z_dot;
  get_q(layout, x_dot) = calc_rates();
  x_dot[layout.work()] = acting.power - acting.dissipated;
  x_dot[layout.dissipated()] = acting.dissipated;
  return {x_dot, static_cast<double>(condition)};
}

const records::FunctionRecord& Route::find_function(const std::string& name) const {
  const auto found =
      std::find_if(spec_.functions.begin(), spec_.functions.end(), [&](const auto& f) { return f.name == name; });
  BOUGH_DEMAND(found != spec_.functions.end());
  return *found;
}

Vector3d Route::calc_function(const std::string& name) const {
  if (name.empty()) return Vector3d::UnitX();
  const auto& f = find_function(name);
  BOUGH_DEMAND(f.type == "sine");
  const double a = f.values.at("amplitude"), w = f.values.at("omega"), phase = w * t_ + f.values.at("phase");
  return {f.values.at("offset") + a * std::sin(phase), a * w * std::cos(phase), -a * w * w * std::sin(phase)};
}

Pose Route::calc_hinge(const records::HingeRecord& h, const double* q, const double* u, const double* a) const {
  Pose pose;
  pose.R.at.setIdentity();
  const auto num = [&](int i) { return make_num(q[i], u[i], a[i]); };
  const auto along = [&](const Vector3d& axis, int i) { return scale(num(i), make_constant<3, 1>(axis)); };
  const Vector3d axis = h.axis.normalized();
  switch (h.type) {
    case HingeType::Fixed:
      break;
    case HingeType::Revolute:
      pose.R = calc_turn(axis, num(0));
      break;
    case HingeType::Prismatic:
      pose.p = along(axis, 0);
      break;
    case HingeType::Screw:
      pose.R = calc_turn(axis, num(0));
      pose.p = along(h.pitch * axis, 0);
      break;
    case HingeType::Cylindrical:
      pose.R = calc_turn(axis, num(0));
      pose.p = along(axis, 1);
      break;
    case HingeType::Universal:
      pose.R = calc_turn(axis, num(0)) * calc_turn(h.axis2.normalized(), num(1));
      break;
    case HingeType::Planar: {
      const Vector3d guide = std::abs(axis.x()) > 1 - 1e-6 ? Vector3d::UnitZ() : Vector3d::UnitX();
      const Vector3d e1 = (guide - guide.dot(axis) * axis).normalized();
      pose.p = along(e1, 0) + along(axis.cross(e1), 1);
      pose.R = calc_turn(axis, num(2));
      break;
    }
    case HingeType::Free:
      pose.p = {Vector3d(q[4], q[5], q[6]), Vector3d(u[3], u[4], u[5]), Vector3d(a[3], a[4], a[5])};
      [[fallthrough]];
    case HingeType::Spherical:
      pose.R = calc_quaternion_rotation(Eigen::Map<const Eigen::Vector4d>(q), Vector3d(u[0], u[1], u[2]),
                                        Vector3d(a[0], a[1], a[2]));
      break;
    case HingeType::General: {
      int i = 0;
      for (const char letter : h.rotations) pose.R = pose.R * calc_turn(Vector3d::Unit(letter - 'x'), num(i)), ++i;
      for (const char letter : h.translations) pose.p = pose.p + along(Vector3d::Unit(letter - 'x'), i), ++i;
      break;
    }
  }
  return pose;
}

Pose Route::calc_node(int b, int id, const Series<Eigen::Dynamic, 1>& eta) const {
  Pose pose;
  pose.R.at.setIdentity();
  if (b < 0 || id == 0) return pose;
  const auto& body = get_body(b);
  if (body.file.empty()) {
    for (const auto& node : body.nodes)
      if (node.id == id) pose.p.at = node.p;
    return pose;
  }
  const records::FlexBody& flex = flex_.at(body.file);
  const auto k = static_cast<size_t>(std::find(flex.node_id.begin(), flex.node_id.end(), id) - flex.node_id.begin());
  const MatrixXd& shape = flex.phi[k];
  const VectorXd at = shape * eta.at, d1 = shape * eta.d1, d2 = shape * eta.d2;
  pose.p = {flex.node_xyz.row(static_cast<Eigen::Index>(k)).transpose() + at.head<3>(), d1.head<3>(), d2.head<3>()};
  Vec theta{at.tail<3>(), d1.tail<3>(), d2.tail<3>()};
  if (body.stiffening) {
    for (size_t e = 0; e < flex.locators.size(); ++e) {
      if (flex.locators[e].node != id) continue;
      const MatrixXd& K = flex.kg_external[e];  // minus the second-order field
      Vec& to = flex.locators[e].direction <= 3 ? pose.p : theta;
      const int a = (flex.locators[e].direction - 1) % 3;
      to.at[a] -= 0.5 * eta.at.dot(K * eta.at);
      to.d1[a] -= eta.at.dot(K * eta.d1);
      to.d2[a] -= eta.d1.dot(K * eta.d1) + eta.at.dot(K * eta.d2);
    }
  }
  pose.R = calc_rotation(theta);
  return pose;
}

Pose Route::calc_marker(int b, int id, const Vector3d& p, const Matrix3d& R, const Motion& poses) const {
  const Pose offset{make_constant<3, 1>(p), make_constant<3, 3>(R)};
  if (b < 0) return offset;
  return poses.X[static_cast<size_t>(b)] * (calc_node(b, id, poses.eta[static_cast<size_t>(b)]) * offset);
}

Motion Route::calc_poses(const VectorXd& q, const VectorXd& u, const VectorXd& a) const {
  Motion poses;
  poses.X.resize(static_cast<size_t>(tree_.size()));
  for (int b = 0; b < tree_.size(); ++b) {
    const TreeBody& tb = tree_[b];
    const auto& h = get_hinge(b);
    Series<Eigen::Dynamic, 1> eta;
    eta.at = get_eta(b, q);
    eta.d1 = u.segment(tb.eta_dot_offset(), tb.num_modes());
    eta.d2 = a.segment(tb.eta_dot_offset(), tb.num_modes());
    poses.eta.push_back(eta);
    const Pose Hp = calc_marker(find_body(h.parent), h.parent_node, h.parent_position, h.parent_rotation, poses);
    const Pose X = calc_hinge(h, q.data() + tb.q_offset, u.data() + tb.u_offset, a.data() + tb.u_offset);
    const Pose Hc = calc_node(b, h.child_node, eta) *
                    Pose{make_constant<3, 1>(h.child_position), make_constant<3, 3>(h.child_rotation)};
    Pose own = Hp * X;
    own.R = own.R * Hc.R.transpose();
    own.p = own.p - own.R * Hc.p;
    poses.X[static_cast<size_t>(b)] = own;
  }
  return poses;
}

Matrix6d make_rigid_mass(double mass, const Vector3d& cg, const Matrix3d& inertia) {
  Matrix6d M;
  const Matrix3d c = skew(cg);
  M << mass * Matrix3d::Identity(), -mass * c, mass * c, inertia - mass * c * c;
  return M;
}

MatrixXd Route::calc_mass(int b, const VectorXd& eta) const {
  const auto& r = get_body(b);
  if (!r.file.empty()) {
    BodyInertia inertia = tree_[b].body.make_inertia();
    tree_[b].body.calc_mass(eta, inertia);
    return inertia.make_M();
  }
  Matrix6d M = make_rigid_mass(r.mass, r.cg, r.inertia);
  for (size_t i = 0; i < spec_.tanks.size(); ++i)
    if (spec_.tanks[i].body == r.name) M += calc_content(spec_.tanks[i], r, tank_mass_[i]);
  return M;
}

std::array<VectorXd, 2> Route::calc_velocity(int b, const Motion& poses) const {
  const Pose& X = poses.X[static_cast<size_t>(b)];
  const auto& eta = poses.eta[static_cast<size_t>(b)];
  const Matrix3d T = X.R.at.transpose();
  std::array<VectorXd, 2> V{VectorXd(6 + eta.at.size()), VectorXd(6 + eta.at.size())};
  V[0] << T * X.p.d1, get_axial(T * X.R.d1), eta.d1;
  V[1] << X.R.d1.transpose() * X.p.d1 + T * X.p.d2, get_axial(X.R.d1.transpose() * X.R.d1 + T * X.R.d2), eta.d2;
  return V;
}

void Route::add_inertia(int b, const Motion& motion, LongMatrix& mass, LongVector& force, double& dissipated) const {
  const TreeBody& tb = tree_[b];
  const int n = tb.num_modes(), num_u = tree_.num_u;
  MatrixXd J(6 + n, num_u);
  for (int i = 0; i < num_u; ++i) J.col(i) = calc_velocity(b, units_[static_cast<size_t>(i)])[0];
  const VectorXd eta = get_eta(b, q_);
  const auto V = calc_velocity(b, motion);
  const MatrixXd M = calc_mass(b, eta);
  const Vector3d v = V[0].head<3>(), w = V[0].segment<3>(3);
  const VectorXd P = M * V[0];
  VectorXd load = M * V[1];
  for (int j = 0; j < n; ++j) {
    const MatrixXd dM =
        differentiate([&](double s) { return MatrixXd(calc_mass(b, eta + s * VectorXd::Unit(n, j))); }, 0.1);
    load += dM * V[0] * V[0][6 + j];
    load[6 + j] -= 0.5 * V[0].dot(dM * V[0]);
  }
  load.head<3>() += w.cross(Vector3d(P.head<3>()));
  load.segment<3>(3) += w.cross(Vector3d(P.segment<3>(3))) + v.cross(Vector3d(P.head<3>()));
  if (n > 0) {
    const records::FlexBody& flex = flex_.at(get_body(b).file);
    const VectorXd eta_dot = V[0].tail(n);
    load.tail(n) += flex.modal_stiffness * eta + flex.modal_damping * eta_dot;
    dissipated += eta_dot.dot(flex.modal_damping * eta_dot);
  }
  load -= M.leftCols<3>() * (motion.X[static_cast<size_t>(b)].R.at.transpose() * spec_.simulation.gravity);
  const LongMatrix long_J = J.cast<long double>();
  mass += long_J.transpose() * M.cast<long double>() * long_J;
  force -= long_J.transpose() * load.cast<long double>();
}

void Route::add_motors(LongMatrix& mass, LongVector& force) const {
  for (int b = 0; b < tree_.size(); ++b) {
    const auto& law = get_hinge(b).law;
    for (size_t i = 0; i < law.rotor_inertia.size(); ++i) {
      const int row = tree_[b].u_offset + static_cast<int>(i);
      const double ratio = law.gear_ratio.empty() ? 1 : law.gear_ratio[i],
                   inertia = law.rotor_inertia[i] * ratio * ratio;
      mass(row, row) += inertia;
      force[row] -= inertia * u_dot_[row];
    }
  }
}

std::vector<Eigen::Vector2d> Route::calc_rows(const ConstraintRecord& c, const ConstraintState& state,
                                              const Motion& poses) const {
  const Pose P = calc_marker(find_body(c.parent), c.parent_node, c.parent_position, c.parent_rotation, poses);
  const Pose C = calc_marker(find_body(c.child), c.child_node, c.child_position, c.child_rotation, poses) *
                 Pose{make_constant<3, 1>(state.p), make_constant<3, 3>(state.R)};
  const Mat T = P.R.transpose(), R = T * C.R;
  const Vec p = T * (C.p - P.p);
  const Vector3d w = get_axial(R.d1 * R.at.transpose());
  const Vector3d a = get_axial(R.d2 * R.at.transpose() + R.d1 * R.d1.transpose());
  std::vector<Eigen::Vector2d> rows;
  const auto keep_place = [&](const Vector3d& e) { rows.emplace_back(e.dot(p.d1), e.dot(p.d2)); };
  const auto keep_turn = [&](const Vector3d& e) { rows.emplace_back(e.dot(w), e.dot(a)); };
  const auto keep_angle = [&](const Vector3d& e, const Vector3d& f) {
    rows.emplace_back(e.dot(R.d1 * f), e.dot(R.d2 * f));
  };
  const auto keep_all = [](const auto& keep) {
    for (int i = 0; i < 3; ++i) keep(Vector3d(Vector3d::Unit(i)));
  };
  const auto keep_across = [](const Vector3d& e, const auto& keep) {
    const Vector3d e1 = e.unitOrthogonal();
    keep(e1);
    keep(Vector3d(e.cross(e1)));
  };
  const Vector3d axis = c.axis.normalized();
  if (c.type == ConstraintType::Distance) {
    const double r = p.at.norm(), along = p.at.dot(p.d1) / r;
    rows.emplace_back(along, (p.d1.squaredNorm() + p.at.dot(p.d2) - along * along) / r);
  } else if (c.type == ConstraintType::PointOnLine) {
    keep_across(axis, keep_place);
  } else if (c.type == ConstraintType::PointOnPlane) {
    keep_place(axis);
  } else {
    switch (c.hinge) {
      case HingeType::Fixed:
        keep_all(keep_place), keep_all(keep_turn);
        break;
      case HingeType::Revolute:
        keep_all(keep_place), keep_across(axis, keep_turn);
        break;
      case HingeType::Prismatic:
        keep_across(axis, keep_place), keep_all(keep_turn);
        break;
      case HingeType::Cylindrical:
        keep_across(axis, keep_place), keep_across(axis, keep_turn);
        break;
      case HingeType::Screw:
        keep_across(axis, keep_place), keep_across(axis, keep_turn);
        rows.emplace_back(axis.dot(p.d1) - c.pitch * axis.dot(w), axis.dot(p.d2) - c.pitch * axis.dot(a));
        break;
      case HingeType::Universal:
        keep_all(keep_place), keep_angle(axis, c.axis2.normalized());
        break;
      case HingeType::Planar:
        keep_place(axis), keep_across(axis, keep_turn);
        break;
      case HingeType::Spherical:
        keep_all(keep_place);
        break;
      case HingeType::General:
        for (const char letter : {'x', 'y', 'z'})
          if (c.translations.find(letter) == std::string::npos) keep_place(Vector3d::Unit(letter - 'x'));
        if (c.rotations == "xz") keep_angle(Vector3d::UnitX(), Vector3d::UnitZ());
        BOUGH_DEMAND(c.rotations == "xz" || c.rotations == "q");
        break;
      case HingeType::Free:
        break;
    }
  }
  return rows;
}

void Route::calc_constraints(const Motion& motion, LongMatrix& G, LongVector& gamma) const {
  std::vector<VectorXd> rows;
  std::vector<double> right;
  for (size_t c = 0; c < spec_.constraints.size(); ++c) {
    const ConstraintRecord& record = spec_.constraints[c];
    if (!discrete_.constraints[c].is_closed) continue;
    if (record.type == ConstraintType::Coupler) {
      VectorXd row = VectorXd::Zero(tree_.num_u);
      for (const auto& term : record.terms)
        row[tree_[system_.find_hinge(term.hinge)].u_offset + term.coordinate - 1] += term.ratio;
      right.push_back(-row.dot(u_dot_));
      rows.push_back(row);
      continue;
    }
    const auto at = calc_rows(record, discrete_.constraints[c], motion);
    const size_t first = rows.size();
    rows.resize(first + at.size(), VectorXd::Zero(tree_.num_u));
    for (const auto& row : at) right.push_back(-row[1]);
    for (int i = 0; i < tree_.num_u; ++i) {
      const auto column = calc_rows(record, discrete_.constraints[c], units_[static_cast<size_t>(i)]);
      for (size_t k = 0; k < at.size(); ++k) rows[first + k][i] = column[k][0];
    }
  }
  G.resize(static_cast<Eigen::Index>(rows.size()), tree_.num_u);
  gamma.resize(G.rows());
  for (size_t k = 0; k < rows.size(); ++k) {
    G.row(static_cast<Eigen::Index>(k)) = rows[k].transpose().cast<long double>();
    gamma[static_cast<Eigen::Index>(k)] = right[k];
  }
}

VectorXd Route::calc_rates() const {
  VectorXd rates(tree_.num_q);
  for (int b = 0; b < tree_.size(); ++b) {
    const TreeBody& tb = tree_[b];
    const int turns = has_quaternion(get_hinge(b).type) ? 1 : 0;
    if (turns)
      rates.segment<4>(tb.q_offset) = calc_quaternion_rate(q_.segment<4>(tb.q_offset), u_.segment<3>(tb.u_offset));
    for (int i = 3 * turns; i < tb.num_hinge_u(); ++i) rates[tb.q_offset + i + turns] = u_[tb.u_offset + i];
    for (int j = 0; j < tb.num_modes(); ++j) rates[tb.eta_offset() + j] = u_[tb.eta_dot_offset() + j];
  }
  return rates;
}

}  // namespace dense_route

DenseDerivative calc_dense_derivative(const records::SystemSpec& spec,
                                      const std::map<std::string, records::FlexBody>& flex, const System& system,
                                      const DiscreteState& discrete, double t, const VectorXd& x,
                                      const History& history) {
  return dense_route::Route(spec, flex, system, discrete, history, t, x).calc();
}

}  // namespace bough::solver::testing
