#include "bough/solver/bodies/body.hpp"

#include <cmath>

#include "bough/base/diagnostic.hpp"

namespace bough::solver {

namespace {
// Tensor components in the order of A_I(6..11).
constexpr int kRow[6] = {0, 1, 2, 0, 0, 1};
constexpr int kCol[6] = {0, 1, 2, 1, 2, 2};

Vector6d pack(const Matrix3d& J) {
  Vector6d c;
  for (int i = 0; i < 6; ++i) c[i] = 0.5 * (J(kRow[i], kCol[i]) + J(kCol[i], kRow[i]));
  return c;
}
Matrix3d unpack(const Vector6d& c) {
  Matrix3d J;
  for (int i = 0; i < 6; ++i) J(kRow[i], kCol[i]) = J(kCol[i], kRow[i]) = c[i];
  return J;
}
Eigen::Map<const Matrix3Xd> as_3xn(const VectorXd& x) { return {x.data(), 3, x.size() / 3}; }
Eigen::Map<const Matrix6Xd> as_6xn(const VectorXd& x) { return {x.data(), 6, x.size() / 6}; }
}  // namespace

Body Body::make_rigid(double mass, const Vector3d& cg, const Matrix3d& inertia_about_cg) {
  Body body;
  body.mass_ = mass;
  body.S0_ = mass * cg;
  const Matrix3d c = skew(cg);
  const Matrix3d J = 0.5 * (inertia_about_cg + inertia_about_cg.transpose()) - mass * c * c;
  body.J0_ = pack(J);
  body.M6_ << mass * Matrix3d::Identity(), -skew(body.S0_), skew(body.S0_), J;
  body.nodes_.emplace_back();
  return body;
}

Body Body::make_flexible(const records::FlexBody& flex, int num_modes, bool stiffening,
                         const std::vector<double>& damping_ratios) {
  Body body;
  const int n = num_modes < 0 ? flex.num_modes() : num_modes;
  const auto& integrals = flex.integrals();
  BOUGH_DEMAND(n <= flex.num_modes() && !integrals.empty());
  body.n_ = n;
  body.stiffened_ = stiffening;
  body.mass_ = flex.mass;
  body.S0_ = flex.mass * flex.cg;
  body.J0_ = pack(flex.inertia);
  body.M6_ << flex.mass * Matrix3d::Identity(), -skew(body.S0_), skew(body.S0_), unpack(body.J0_);
  body.gamma0_ = integrals.gamma0.leftCols(n);
  body.gamma1_ = integrals.gamma1.leftCols(n);
  body.M_ = flex.modal_mass.topLeftCorner(n, n);
  body.K_ = flex.modal_stiffness.topLeftCorner(n, n);
  // Stiffening by the motion comes with the motion: what of it the preload put into the stiffness goes out.
  if (stiffening)
    for (std::size_t i = 0; i < flex.kg_inertial.size() && flex.preload_A_I.size() > 0; ++i)
      if (const double a = flex.preload_A_I(static_cast<Eigen::Index>(i)); a != 0)
        body.K_ -= a * flex.kg_inertial[i].topLeftCorner(n, n);
  body.D_ = MatrixXd::Zero(n, n);
  if (!damping_ratios.empty()) {
    for (int j = 0; j < n; ++j) {
      const double ratio = damping_ratios.size() == 1 ? damping_ratios[0] : damping_ratios[static_cast<size_t>(j)];
      body.D_(j, j) = 2 * ratio * std::sqrt(body.K_(j, j) * body.M_(j, j));
    }
  } else if (flex.modal_damping.size() > 0) {
    body.D_ = flex.modal_damping.topLeftCorner(n, n);
  }
  body.add_second_order(flex);
  body.add_flexible_nodes(flex);
  return body;
}

void Body::add_second_order(const records::FlexBody& flex) {
  const auto& integrals = flex.integrals();
  const int n = n_;
  auto G = [&](int i) -> MatrixXd {
    const auto& g = flex.kg_inertial[static_cast<size_t>(i)];
    if (!stiffened_ || g.size() == 0) return MatrixXd::Zero(n, n);
    return 0.5 * (g.topLeftCorner(n, n) + g.topLeftCorner(n, n).transpose());
  };
  GS_ = C2_ = A2_ = MatrixXd::Zero(3 * n, n);
  Q_ = MatrixXd::Zero(6 * n, n);
  J1_ = Matrix6Xd::Zero(6, n);
  for (int a = 0; a < 3; ++a) {
    const MatrixXd Gs = G(a), Gc = G(3 + a);
    for (int j = 0; j < n; ++j) {
      GS_.row(a + 3 * j) = Gs.row(j);
      for (int k = 0; k < n; ++k) {
        const double g2_kj = integrals.gamma2[static_cast<size_t>(k)](a, j);
        C2_(a + 3 * j, k) = g2_kj + Gc(j, k);
        A2_(a + 3 * j, k) = g2_kj - integrals.gamma2[static_cast<size_t>(j)](a, k);
      }
    }
  }
  for (int j = 0; j < n; ++j) {
    const Matrix3d& g3 = integrals.gamma3[static_cast<size_t>(j)];
    J1_.col(j) = pack(g3 + g3.transpose());
    for (int k = 0; k < n; ++k) {
      const Vector6d g4 = pack(integrals.gamma4[static_cast<size_t>(j)][static_cast<size_t>(k)]);
      for (int c = 0; c < 6; ++c) {
        Q_(c + 6 * j, k) += 0.5 * g4[c];
        Q_(c + 6 * k, j) += 0.5 * g4[c];
      }
    }
  }
  for (int c = 0; c < 6; ++c) {
    const MatrixXd g = (c < 3 ? 1.0 : 0.5) * G(6 + c);  // a product ωaωb meets both J_ab and J_ba
    for (int j = 0; j < n; ++j) Q_.row(c + 6 * j) -= g.row(j);
  }
}

void Body::add_flexible_nodes(const records::FlexBody& flex) {
  nodes_.emplace_back();
  nodes_[0].phi = nodes_[0].psi = Matrix3Xd::Zero(3, n_);
  for (int k = 0; k < flex.num_nodes(); ++k) {
    Node node;
    node.id = flex.node_id[static_cast<size_t>(k)];
    node.p = flex.node_xyz.row(k).transpose();
    const MatrixXd& phi = flex.phi[static_cast<size_t>(k)];
    node.phi = phi.topLeftCorner(3, n_);
    node.psi = phi.block(3, 0, 3, n_);
    node.moves = n_ > 0 && phi.leftCols(n_).cwiseAbs().maxCoeff() > 0;
    int locator[3];
    for (int a = 0; a < 3; ++a) locator[a] = flex.find_locator(node.id, a + 1);
    node.has_locators = locator[0] >= 0 && locator[1] >= 0 && locator[2] >= 0;
    if (stiffened_ && node.has_locators && node.moves) {
      node.K2.resize(3 * n_, n_);
      for (int a = 0; a < 3; ++a) {
        const MatrixXd& full = flex.kg_external[static_cast<size_t>(locator[a])];
        const MatrixXd K2 = 0.5 * (full.topLeftCorner(n_, n_) + full.topLeftCorner(n_, n_).transpose());
        for (int j = 0; j < n_; ++j) node.K2.row(a + 3 * j) = K2.row(j);
      }
    }
    nodes_.push_back(std::move(node));
  }
}

int Body::find_node(int id) const {
  for (size_t k = 0; k < nodes_.size(); ++k) {
    if (nodes_[k].id == id) return static_cast<int>(k);
  }
  return -1;
}

void Body::add_rigid_node(int id, const Vector3d& p) {
  BOUGH_DEMAND(n_ == 0 && find_node(id) < 0);
  Node node;
  node.id = id;
  node.p = p;
  node.phi = node.psi = Matrix3Xd::Zero(3, 0);
  nodes_.push_back(std::move(node));
}

BodyInertia Body::make_inertia() const {
  BodyInertia inertia;
  inertia.h = VectorXd::Zero(6 + n_);
  inertia.S = S0_;
  if (n_ == 0) return inertia;
  inertia.M = MatrixXd::Zero(6 + n_, 6 + n_);
  inertia.M.topLeftCorner<6, 6>() = M6_;
  inertia.M.bottomRightCorner(n_, n_) = M_;
  for (VectorXd* x : {&inertia.GS, &inertia.GS_dot, &inertia.C2, &inertia.C2_dot, &inertia.A2})
    *x = VectorXd::Zero(3 * n_);
  inertia.Q = VectorXd::Zero(6 * n_);
  return inertia;
}

void Body::calc_inertia(const Vector3d& w, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                        BodyInertia& x) const {
  if (n_ == 0) {
    const Matrix3d J = M6_.bottomRightCorner<3, 3>();
    x.h.head<3>() = w.cross(w.cross(S0_));
    x.h.tail<3>() = w.cross(Vector3d(J * w));
    return;
  }
  const int n = n_;
  x.C2.noalias() = C2_ * eta;
  x.C2_dot.noalias() = C2_ * eta_dot;
  x.A2.noalias() = A2_ * eta_dot;
  x.Q.noalias() = Q_ * eta;
  if (stiffened_) {
    x.GS.noalias() = GS_ * eta;
    x.GS_dot.noalias() = GS_ * eta_dot;
  }
  auto Gamma0 = x.M.block(0, 6, 3, n);
  auto C = x.M.block(3, 6, 3, n);
  Gamma0 = gamma0_ + as_3xn(x.GS);
  C = gamma1_ + as_3xn(x.C2);
  x.M.block(6, 0, n, 6) = x.M.block(0, 6, 6, n).transpose();

  x.S = S0_;
  Vector3d S_dot = Vector3d::Zero(), S_ddot_0 = Vector3d::Zero(), C_eta_dot = Vector3d::Zero(),
           C_dot_eta_dot = C_eta_dot;
  Vector6d J6 = J0_, J6_dot = Vector6d::Zero();
  const Vector6d ww(w.x() * w.x(), w.y() * w.y(), w.z() * w.z(), 2 * w.x() * w.y(), 2 * w.x() * w.z(),
                    2 * w.y() * w.z());
  for (int j = 0; j < n; ++j) {
    x.S += (gamma0_.col(j) + 0.5 * as_3xn(x.GS).col(j)) * eta[j];
    S_dot += Gamma0.col(j) * eta_dot[j];
    S_ddot_0 += as_3xn(x.GS_dot).col(j) * eta_dot[j];
    C_eta_dot += C.col(j) * eta_dot[j];
    C_dot_eta_dot += as_3xn(x.C2_dot).col(j) * eta_dot[j];
    const Vector6d J1 = J1_.col(j), y = as_6xn(x.Q).col(j);
    const Vector6d dJ = J1 + 2 * y;
    J6 += (J1 + y) * eta[j];
    J6_dot += dJ * eta_dot[j];
    x.h[6 + j] = w.dot(as_3xn(x.A2).col(j)) - 0.5 * ww.dot(dJ);
  }
  x.h.tail(n).noalias() += K_ * eta;
  x.h.tail(n).noalias() += D_ * eta_dot;

  const Matrix3d J = unpack(J6), J_dot = unpack(J6_dot);
  x.M.block<3, 3>(0, 3) = -skew(x.S);
  x.M.block<3, 3>(3, 0) = skew(x.S);
  x.M.block<3, 3>(3, 3) = J;
  x.h.head<3>() = w.cross(w.cross(x.S)) + 2 * w.cross(S_dot) + S_ddot_0;
  x.h.segment<3>(3) = J_dot * w + C_dot_eta_dot + w.cross(Vector3d(J * w + C_eta_dot));
}

}  // namespace bough::solver
