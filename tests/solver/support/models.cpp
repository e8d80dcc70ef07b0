#include "tests/solver/support/models.hpp"
#include "solver/builder/build_system.hpp"

namespace bough::solver::testing {

MatrixXd Random::symmetric(int n, double scale) {
  MatrixXd a = MatrixXd::NullaryExpr(n, n, [&] { return (*this)(scale); });
  return 0.5 * (a + a.transpose());
}

Matrix3d Random::rotation() { return calc_rotation_exp(vector(2.5)); }

double PointBody::calc_kinetic(const Vector3d& v, const Vector3d& w, const VectorXd& eta,
                               const VectorXd& eta_dot) const {
  double kinetic = 0;
  for (size_t k = 0; k < p.size(); ++k) {
    Vector3d r = p[k] + phi[k] * eta, r_dot = phi[k] * eta_dot;
    for (int a = 0; a < 3; ++a) {
      r[a] += 0.5 * eta.dot(g[k][static_cast<size_t>(a)] * eta);
      r_dot[a] += eta_dot.dot(g[k][static_cast<size_t>(a)] * eta);
    }
    kinetic += 0.5 * mass[k] * (v + w.cross(r) + r_dot).squaredNorm();
  }
  return kinetic;
}

PointBody make_point_body(int n, unsigned seed, double second_order_scale) {
  Random random(seed), turning(seed + 1000);
  PointBody body;
  body.num_modes = n;
  const int num = n + 6;
  for (int k = 0; k < num; ++k) {
    body.mass.push_back(0.5 + std::abs(random()));
    body.p.push_back(random.vector(1.5));
    body.phi.push_back(MatrixXd::NullaryExpr(3, n, [&] { return random(0.5); }));
    body.psi.push_back(MatrixXd::NullaryExpr(3, n, [&] { return random(0.5); }));
    body.g.push_back({random.symmetric(n, second_order_scale), random.symmetric(n, second_order_scale),
                      random.symmetric(n, second_order_scale)});
    body.g_theta.push_back({turning.symmetric(n, second_order_scale), turning.symmetric(n, second_order_scale),
                            turning.symmetric(n, second_order_scale)});
  }
  const MatrixXd k = random.symmetric(n, 1), d = random.symmetric(n, 0.1);
  body.K = 30 * MatrixXd::Identity(n, n) + 5 * k * k.transpose();
  body.D = 0.2 * MatrixXd::Identity(n, n) + d * d.transpose();
  return body;
}

records::FlexBody PointBody::make_record(const std::string& name) const {
  const int n = num_modes, num = static_cast<int>(p.size());
  records::FlexBody flex;
  flex.name = name;
  flex.node_xyz.resize(num, 3);
  auto& integrals = flex.lumped;
  flex.integrals_method = "lumped";
  integrals.gamma0 = integrals.gamma1 = MatrixXd::Zero(3, n);
  integrals.gamma2.assign(static_cast<size_t>(n), MatrixXd::Zero(3, n));
  integrals.gamma3.assign(static_cast<size_t>(n), Matrix3d::Zero());
  integrals.gamma4.assign(static_cast<size_t>(n), std::vector<Matrix3d>(static_cast<size_t>(n), Matrix3d::Zero()));
  for (auto& G : flex.kg_inertial) G = MatrixXd::Zero(n, n);
  flex.kg_inertial_computed.fill(true);
  flex.modal_mass = MatrixXd::Zero(n, n);
  flex.modal_stiffness = K;
  flex.modal_damping = D;
  flex.eigenvalue = K.diagonal();
  flex.frequency_hz = flex.eigenvalue.cwiseSqrt() / 6.283185307179586;
  Vector3d moment = Vector3d::Zero();
  flex.external_load.resize(n, (g_theta.empty() ? 3 : 6) * num);
  for (int k = 0; k < num; ++k) {
    const auto i = static_cast<size_t>(k);
    const double m = mass[i];
    flex.mass += m;
    moment += m * p[i];
    flex.inertia += m * (p[i].squaredNorm() * Matrix3d::Identity() - p[i] * p[i].transpose());
    flex.node_id.push_back(101 + k);
    flex.node_xyz.row(k) = p[i].transpose();
    MatrixXd shape(6, n);
    shape << phi[i], psi[i];
    flex.phi.push_back(shape);
    flex.modal_mass += m * phi[i].transpose() * phi[i];
    integrals.gamma0 += m * phi[i];
    integrals.gamma1 += m * skew(p[i]) * phi[i];
    for (int j = 0; j < n; ++j) {
      const Vector3d fj = phi[i].col(j);
      integrals.gamma2[static_cast<size_t>(j)] += m * skew(fj) * phi[i];
      integrals.gamma3[static_cast<size_t>(j)] += m * (p[i].dot(fj) * Matrix3d::Identity() - fj * p[i].transpose());
      for (int l = 0; l < n; ++l) {
        const Vector3d fl = phi[i].col(l);
        integrals.gamma4[static_cast<size_t>(j)][static_cast<size_t>(l)] +=
            m * (fj.dot(fl) * Matrix3d::Identity() - fj * fl.transpose());
      }
    }
    const auto& [gx, gy, gz] = g[i];
    const Vector3d& x = p[i];
    auto& G = flex.kg_inertial;
    G[0] += m * gx;
    G[1] += m * gy;
    G[2] += m * gz;
    G[3] += m * (x.y() * gz - x.z() * gy);  // (e_a × p)·g
    G[4] += m * (x.z() * gx - x.x() * gz);
    G[5] += m * (x.x() * gy - x.y() * gx);
    G[6] -= m * (x.y() * gy + x.z() * gz);  // ½ωᵀJω gets Σ m (ω×p)·(ω×½ηᵀgη)
    G[7] -= m * (x.x() * gx + x.z() * gz);
    G[8] -= m * (x.x() * gx + x.y() * gy);
    G[9] += m * (x.x() * gy + x.y() * gx);
    G[10] += m * (x.x() * gz + x.z() * gx);
    G[11] += m * (x.y() * gz + x.z() * gy);
    for (int a = 0; a < 3; ++a) {
      flex.locators.push_back({name + std::to_string(101 + k) + "xyz"[a], 101 + k, a + 1});
      flex.kg_external.push_back(-g[i][static_cast<size_t>(a)]);
      flex.external_load.col(3 * k + a) = phi[i].row(a).transpose();
    }
  }
  for (size_t i = 0; i < g_theta.size(); ++i) {
    const int id = flex.node_id[i];
    for (int a = 0; a < 3; ++a) {
      flex.locators.push_back({name + std::to_string(id) + "_r" + "xyz"[a], id, a + 4});
      flex.external_load.col(static_cast<Eigen::Index>(flex.kg_external.size())) = psi[i].row(a).transpose();
      flex.kg_external.push_back(-g_theta[i][static_cast<size_t>(a)]);
    }
  }
  flex.interface_nodes = flex.node_id;
  flex.cg = moment / flex.mass;
  return flex;
}

records::BodyRecord make_rigid_record(const std::string& name, Random& random) {
  records::BodyRecord r;
  r.name = name;
  r.mass = 1 + std::abs(random());
  r.cg = random.vector(0.5);
  r.inertia = Vector3d(1.0, 1.2, 1.5).asDiagonal();
  const Matrix3d R = random.rotation();
  r.inertia = R * (r.inertia + 0.2 * std::abs(random()) * Matrix3d::Identity()) * R.transpose();
  r.inertia = (0.5 * (r.inertia + r.inertia.transpose())).eval();
  r.nodes = {{101, random.vector()}, {102, random.vector()}, {103, random.vector()}};
  return r;
}

records::HingeRecord make_hinge_record(const std::string& name, records::HingeType type, const std::string& parent,
                                       const std::string& child) {
  records::HingeRecord h;
  h.name = name;
  h.type = type;
  h.parent = parent;
  h.child = child;
  return h;
}

namespace {
int count_speeds(records::HingeType type) {
  using records::HingeType;
  switch (type) {
    case HingeType::Fixed:
      return 0;
    case HingeType::Revolute:
    case HingeType::Prismatic:
    case HingeType::Screw:
      return 1;
    case HingeType::Universal:
    case HingeType::Cylindrical:
      return 2;
    case HingeType::Planar:
    case HingeType::Spherical:
      return 3;
    case HingeType::Free:
    case HingeType::General:  // as the catalogue of the random trees has none
      return 6;
  }
  return 0;
}
}  // namespace

RandomTree make_random_tree(unsigned seed, const RandomTreeOptions& o) {
  using records::HingeType;
  Random random(seed);
  RandomTree tree;
  auto& spec = tree.spec;
  spec.simulation.gravity = o.forces ? Vector3d(1, -9, 2) : Vector3d::Zero();
  records::FunctionRecord sine;
  sine.name = "wave";
  sine.type = "sine";
  sine.values = {{"amplitude", 0.7}, {"omega", 2.3}, {"phase", 0.4}, {"offset", 0.2}};
  spec.functions.push_back(sine);
  const int first_type = random.integer(0, 7);
  for (int b = 0; b < o.num_bodies; ++b) {
    const std::string name = "b" + std::to_string(b);
    const bool flexible = (b + static_cast<int>(seed)) % 2 == 0;
    records::BodyRecord body;
    if (flexible) {
      const PointBody points = make_point_body(1 + random.integer(0, 3), seed * 100 + static_cast<unsigned>(b));
      records::FlexBody flex = points.make_record(name);
      if (!o.dissipation) flex.modal_damping.setZero();
      body.name = name;
      body.file = name + ".h5";
      body.stiffening = random.integer(0, 3) > 0;
      tree.flex.emplace(body.file, std::move(flex));
    } else {
      body = make_rigid_record(name, random);
    }
    spec.bodies.push_back(body);
    const bool is_root = b == 0 || (o.to_ground && random.integer(0, 5) == 0);
    const std::string parent = is_root ? "ground" : "b" + std::to_string(random.integer(std::max(0, b - 3), b - 1));
    const HingeType type = is_root && !o.to_ground ? HingeType::Free : kAllHinges[(first_type + b) % 8];
    auto hinge = make_hinge_record("h" + std::to_string(b), type, parent, name);
    hinge.axis = random.vector();
    hinge.axis2 = random.vector();
    hinge.parent_node = is_root ? 0 : random.integer(0, 1) * 101;
    hinge.child_node = random.integer(0, 1) * 102;
    hinge.parent_position = random.vector(0.5);
    hinge.child_position = random.vector(0.5);
    hinge.parent_rotation = random.rotation();
    hinge.child_rotation = random.rotation();
    const int nu = count_speeds(type);
    const bool plain = type != HingeType::Spherical && type != HingeType::Free;
    if (o.prescribed && plain && nu > 0 && random.integer(0, 2) == 0) {
      hinge.motion.assign(static_cast<size_t>(nu), "wave");
    } else {
      for (int i = 0; i < nu && o.springs; ++i) hinge.stiffness.push_back(2 + random());
      for (int i = 0; i < nu && o.dissipation; ++i) hinge.damping.push_back(0.5 + 0.3 * random());
      if (is_root && !o.to_ground) hinge.stiffness.clear(), hinge.damping.clear();
    }
    spec.hinges.push_back(hinge);
    if (o.forces) {
      records::ForceRecord force;
      force.name = "f" + std::to_string(b);
      force.body = name;
      force.node = random.integer(0, 1) * 103;
      force.kind = random.integer(0, 1) ? records::ForceKind::Force : records::ForceKind::Moment;
      force.frame = static_cast<records::VectorFrame>(random.integer(0, 2));
      force.direction = random.vector(3);
      force.function = random.integer(0, 1) ? "wave" : "";
      spec.forces.push_back(force);
    }
  }
  return tree;
}

void make_random_state(const System& system, unsigned seed, VectorXd& q, VectorXd& u) {
  Random random(seed);
  q.resize(system.num_q());
  u.resize(system.num_u());
  system.calc_initial_state(q, u);
  for (int b = 0; b < system.num_bodies(); ++b) {
    const TreeBody& tb = system.tree.bodies[static_cast<size_t>(b)];
    for (int i = 0; i < system.num_hinge_q(b); ++i) q[system.q_offset(b) + i] = random();
    if (!tb.hinge->has_independent_coordinates()) q.segment(system.q_offset(b), 4).normalize();
    for (int i = 0; i < system.num_hinge_u(b); ++i) u[system.u_offset(b) + i] = random();
    for (int j = 0; j < system.num_modes(b); ++j) {
      q[system.eta_offset(b) + j] = random(0.15);
      u[system.eta_dot_offset(b) + j] = random(0.8);
    }
  }
}

System build(const records::SystemSpec& spec, const std::map<std::string, records::FlexBody>& flex) {
  Diagnostics diagnostics;
  return build_system(spec, flex, diagnostics);
}

VectorXd calc_u_dot(const System& system, SystemData& data, double t, const VectorXd& q, const VectorXd& u) {
  VectorXd u_dot(system.num_u());
  calc_kinematics(system, data, t, q, u);
  add_forces(system, data, t);
  calc_accelerations(system, data, t, u_dot);
  return u_dot;
}

void step_rk4(const System& system, SystemData& data, double t, double h, VectorXd& q, VectorXd& u) {
  VectorXd q_dot[4], u_dot[4];
  const double c[4] = {0, 0.5, 0.5, 1}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  for (int s = 0; s < 4; ++s) {
    const VectorXd qs = s == 0 ? q : VectorXd(q + c[s] * h * q_dot[s - 1]);
    const VectorXd us = s == 0 ? u : VectorXd(u + c[s] * h * u_dot[s - 1]);
    q_dot[s].resize(q.size());
    calc_q_dot(system, data, t + c[s] * h, qs, us, q_dot[s]);
    u_dot[s] = calc_u_dot(system, data, t + c[s] * h, qs, us);
  }
  for (int s = 0; s < 4; ++s) {
    q += weight[s] * h * q_dot[s];
    u += weight[s] * h * u_dot[s];
  }
}

VectorXd advance_q(const System& system, SystemData& data, double t, double dt, const VectorXd& q0, const VectorXd& u0,
                   const VectorXd& u_dot0) {
  VectorXd k[4];
  const double c[4] = {0, 0.5, 0.5, 1}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  VectorXd q = q0;
  for (int s = 0; s < 4; ++s) {
    const VectorXd qs = s == 0 ? q0 : VectorXd(q0 + c[s] * dt * k[s - 1]);
    k[s].resize(q0.size());
    calc_q_dot(system, data, t + c[s] * dt, qs, u0 + c[s] * dt * u_dot0, k[s]);
    q += weight[s] * dt * k[s];
  }
  return q;
}

Matrix6Xd calc_momentum_rates(const System& system, double t, const VectorXd& q, const VectorXd& u,
                              const VectorXd& u_dot) {
  const double h = 4e-3;
  const auto other = system.make_data();
  const auto calc_momenta = [&](double dt) {
    calc_kinematics(system, *other, t + dt, advance_q(system, *other, t, dt, q, u, u_dot), u + dt * u_dot);
    Matrix6Xd momenta(6, system.num_bodies());
    for (int b = 0; b < system.num_bodies(); ++b) {
      Vector3d p, l;
      calc_body_momentum(system, *other, b, p, l);
      momenta.col(b) << p, l;
    }
    return momenta;
  };
  Matrix6Xd rate = Matrix6Xd::Zero(6, system.num_bodies());
  const double weight[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  for (int k = 1; k <= 4; ++k) rate += weight[k - 1] / h * (calc_momenta(k * h) - calc_momenta(-k * h));
  return rate;
}

Vector6d calc_applied_loads(const System& system, const SystemData& data, int b) {
  const TreeBody& tb = system.tree[b];
  const BodyState& s = data.tree[b].state;
  const Vector3d S = tb.is_flexible() ? data.tree[b].inertia.S : tb.body.first_moment();
  const Vector3d f = s.R_WB * data.tree.applied.segment<3>(tb.v_offset);
  const Vector3d m = s.R_WB * data.tree.applied.segment<3>(tb.v_offset + 3);
  Vector6d loads;
  loads << f + tb.body.mass() * data.tree.gravity,
      m + s.p_WBo.cross(f) + (tb.body.mass() * s.p_WBo + s.R_WB * S).cross(data.tree.gravity);
  return loads;
}

}  // namespace bough::solver::testing
