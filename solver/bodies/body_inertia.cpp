// M(η) and h of one body. All in B; r(p) = Σ_b A_b f_b(p) + φη with orthonormal f, A = A0 + x(a), P = ∫ρ r fᵀ, Y =
// ∂A/∂η. The mass integrals of a product of r's follow from ∫ρ ffᵀ = 1, L = ∫ρ φfᵀ and, for φ with φ, Γ2, Γ4 and M.
#include "solver/bodies/body.hpp"

#include <cmath>

#include "base/diagnostic.hpp"
#include "solver/bodies/tensor.hpp"

namespace bough::solver {

namespace {

using Amplitudes = AffineField::Amplitudes;
using Vector12d = Eigen::Matrix<double, 12, 1>;
using Factors = Eigen::Matrix<double, 3, 12>;

template <int R>
Amplitudes expand(const AffineField::Columns& B, const Eigen::Matrix<double, R, 1>& a) {
  Vector12d x = Vector12d::Zero();
  if constexpr (R == 12) {
    x = a;
  } else {
    for (int q = 0; q < R; ++q) x += B.col(q) * a[q];
  }
  return Eigen::Map<const Amplitudes>(x.data());
}

// ∂A/∂a b.
Vector12d turn(const AffineField& field, const Amplitudes& a, const Vector12d& b) {
  const Eigen::Map<const Amplitudes> b_34(b.data());
  const Amplitudes x = b_34 - field.calc_correction(a, b_34);
  return Eigen::Map<const Vector12d>(x.data());
}

// Σ_b P_b × x_b as factors of the 3 x 4 amplitudes x.
Factors make_factors(const Amplitudes& P) {
  Factors f;
  for (int b = 0; b < 4; ++b) {
    const double x = P(0, b), y = P(1, b), z = P(2, b);
    f.col(3 * b) << 0, z, -y;
    f.col(3 * b + 1) << -z, 0, x;
    f.col(3 * b + 2) << y, -x, 0;
  }
  return f;
}

void add_modal(const MatrixXd& K, bool is_diagonal, const ConstVectorRef& x, double* f) {
  const Eigen::Index n = x.size();
  if (is_diagonal) {
    for (Eigen::Index j = 0; j < n; ++j) f[j] += K(j, j) * x[j];
  } else {
    Eigen::Map<VectorXd>(f, n).noalias() += K * x;
  }
}

}  // namespace

template <int R>
void Body::calc_flexible_mass(const ConstVectorRef& eta, BodyInertia& x) const {
  using VectorR = Eigen::Matrix<double, R, 1>;
  const int n = n_, stride = 9 + R;
  const auto& L = field_.L;
  x.by_eta.noalias() = by_eta_ * eta;  // per mode: J of Γ4 (6), C of Γ2 (3), y (R)
  const auto J_of = [&](int j) { return Eigen::Map<const Vector6d>(x.by_eta.data() + stride * j); };
  const auto C_of = [&](int j) { return Eigen::Map<const Vector3d>(x.by_eta.data() + stride * j + 6); };
  const auto y_of = [&](int j) { return Eigen::Map<const VectorR>(x.by_eta.data() + stride * j + 9); };

  Vector12d l = Vector12d::Zero();
  VectorR a = VectorR::Zero();
  for (int j = 0; j < n; ++j) {
    l += L.col(j) * eta[j];
    a += y_of(j) * (0.5 * eta[j]);
  }
  const Eigen::Map<const Amplitudes> l_34(l.data());
  x.a = expand<R>(field_.B, a);
  x.A = field_.A0 + x.a - 0.5 * field_.calc_correction(x.a, x.a);
  x.P = x.A + l_34;
  const double root = std::sqrt(mass_);
  x.S = root * x.P.col(0);

  const Factors of_L = make_factors(x.A), of_Y = make_factors(x.P);
  Eigen::Matrix<double, 12, R> turned;  // ∂A/∂a B
  if constexpr (R < 12) {
    for (int q = 0; q < R; ++q) turned.col(q) = turn(field_, x.a, field_.B.col(q));
  }
  const Matrix3d E = x.A * (x.A + 2 * l_34).transpose();
  Vector6d J6 = J0_rest_ + pack_inertia(E);
  for (int j = 0; j < n; ++j) {
    Vector12d Y = Vector12d::Zero();
    if constexpr (R == 12) {
      Y = turn(field_, x.a, y_of(j));
    } else {
      for (int q = 0; q < R; ++q) Y += turned.col(q) * y_of(j)[q];
    }
    x.V.col(j) = Y + L.col(j);
    Vector3d C_j = gamma1_rest_.col(j) + C_of(j);
    for (int q = 0; q < 12; ++q) C_j += of_L.col(q) * L(q, j) + of_Y.col(q) * Y[q];
    x.M.col(6 + j).template head<3>() = root * x.V.col(j).template head<3>();
    x.M.col(6 + j).template segment<3>(3) = C_j;
    J6 += (J1_rest_.col(j) + J_of(j)) * eta[j];
  }
  for (int j = 0; j < n; ++j) {  // M_ηη is the constant remainder and a square
    for (int k = 0; k <= j; ++k) {
      x.M(6 + j, 6 + k) = x.M(6 + k, 6 + j) = M_rest_(k, j) + x.V.col(j).dot(x.V.col(k));
    }
  }
  x.M.block(6, 0, n, 6) = x.M.block(0, 6, 6, n).transpose();
  x.M.template block<3, 3>(0, 3) = -skew(x.S);
  x.M.template block<3, 3>(3, 0) = skew(x.S);
  x.M.template block<3, 3>(3, 3) = unpack_tensor(J6);
}

template <int R>
void Body::calc_flexible_bias(const Vector3d& w, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                              BodyInertia& x) const {
  using VectorR = Eigen::Matrix<double, R, 1>;
  const int n = n_, stride = 9 + R;
  const auto& L = field_.L;
  x.A2.noalias() = A2_ * eta_dot;
  const auto J_of = [&](int j) { return Eigen::Map<const Vector6d>(x.by_eta.data() + stride * j); };
  const auto y_of = [&](int j) { return Eigen::Map<const VectorR>(x.by_eta.data() + stride * j + 9); };
  Vector12d l_dot = Vector12d::Zero();
  VectorR a_dot = VectorR::Zero();
  for (int j = 0, pair = 0; j < n; ++j) {
    l_dot += L.col(j) * eta_dot[j];
    a_dot += y_of(j) * eta_dot[j];
    for (int k = 0; k <= j; ++k) x.pairs[pair++] = eta_dot[j] * eta_dot[k];
  }
  x.by_pair.noalias() = by_pair_ * x.pairs;
  const Eigen::Map<const Amplitudes> l_dot_34(l_dot.data());
  const Amplitudes a_dot_34 = expand<R>(field_.B, a_dot),
                   a_ddot_34 = expand<R>(field_.B, x.by_pair.template tail<R>());  // at η̈ = 0
  const Amplitudes A_dot = a_dot_34 - field_.calc_correction(x.a, a_dot_34);
  const Amplitudes A_ddot =
      a_ddot_34 - field_.calc_correction(x.a, a_ddot_34) - field_.calc_correction(a_dot_34, a_dot_34);
  const Amplitudes P_dot = A_dot + l_dot_34;
  const double root = std::sqrt(mass_);

  // ∫ρ ∂r/∂η_j·(ω×(ω×r) + 2ω×ṙ + r̈), but for products of two φ; V = Y + L.
  Matrix3d ww_tilde = w * w.transpose();
  ww_tilde.diagonal().array() -= w.squaredNorm();
  const Matrix3d w2_tilde = skew(Vector3d(2 * w));
  const Amplitudes U_Y = ww_tilde * x.P + w2_tilde * P_dot + A_ddot;
  const Amplitudes U_l = ww_tilde * (x.P - x.A) + w2_tilde * l_dot_34;
  const Eigen::Map<const Vector12d> of_V(U_Y.data()), of_L(U_l.data());
  const Vector6d ww(w.x() * w.x(), w.y() * w.y(), w.z() * w.z(), 2 * w.x() * w.y(), 2 * w.x() * w.z(),
                    2 * w.y() * w.z());
  Vector6d J6_dot = pack_inertia(2 * (A_dot * x.P.transpose() + l_dot_34 * x.A.transpose()));
  Vector3d C_eta_dot = Vector3d::Zero();
  for (int j = 0; j < n; ++j) {
    const Vector6d dJ = J1_rest_.col(j) + 2 * J_of(j);
    x.h[6 + j] = of_V.dot(x.V.col(j)) - of_L.dot(L.col(j)) + w.dot(x.A2.template segment<3>(3 * j)) - 0.5 * ww.dot(dJ);
    C_eta_dot += x.M.col(6 + j).template segment<3>(3) * eta_dot[j];
    J6_dot += dJ * eta_dot[j];
  }
  add_modal(K_, K_is_diagonal_, eta, x.h.data() + 6);
  add_modal(D_, D_is_diagonal_, eta_dot, x.h.data() + 6);

  const Matrix3d J = x.M.template block<3, 3>(3, 3), J_dot = unpack_tensor(J6_dot);
  x.h.template head<3>() = w.cross(w.cross(x.S)) + 2 * root * w.cross(Vector3d(P_dot.col(0))) + root * A_ddot.col(0);
  Vector3d moment = J_dot * w + x.by_pair.template head<3>() + w.cross(Vector3d(J * w + C_eta_dot));
  for (int b = 0; b < 4; ++b) moment += Vector3d(x.P.col(b)).cross(Vector3d(A_ddot.col(b)));
  x.h.template segment<3>(3) = moment;
}

void Body::calc_rigid_bias(const Vector3d& w, double* h) const {
  const Matrix3d J = M6_.bottomRightCorner<3, 3>();
  Eigen::Map<Vector3d>{h} = w.cross(w.cross(S0_));
  Eigen::Map<Vector3d>{h + 3} = w.cross(Vector3d(J * w));
}

void Body::calc_mass(const ConstVectorRef& eta, BodyInertia& x) const {
  switch (n_ == 0 ? 0 : field_.rank()) {
    case 0:
      return;
    case 4:
      return calc_flexible_mass<4>(eta, x);
    case 8:
      return calc_flexible_mass<8>(eta, x);
    case 12:
      return calc_flexible_mass<12>(eta, x);
    default:
      BOUGH_DEMAND(false);
  }
}

void Body::calc_bias(const Vector3d& w, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                     BodyInertia& x) const {
  switch (n_ == 0 ? 0 : field_.rank()) {
    case 0:
      return calc_rigid_bias(w, x.h.data());
    case 4:
      return calc_flexible_bias<4>(w, eta, eta_dot, x);
    case 8:
      return calc_flexible_bias<8>(w, eta, eta_dot, x);
    case 12:
      return calc_flexible_bias<12>(w, eta, eta_dot, x);
    default:
      BOUGH_DEMAND(false);
  }
}

}  // namespace bough::solver
