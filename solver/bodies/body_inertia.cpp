// M(η) and h of one body. All in B; r(p) = Σ_b A_b f_b(p) + φη with orthonormal f, A = A0 + x(a), P = ∫ρ r fᵀ, Y =
// ∂A/∂η. The mass integrals of a product of r's follow from ∫ρ ffᵀ = 1, L = ∫ρ φfᵀ and, for φ with φ, Γ2, Γ4 and M.
#include "solver/bodies/body.hpp"

#include <cmath>

#include "solver/bodies/kernels.hpp"
#include "solver/bodies/tensor.hpp"
#include "solver/bodies/third_order.hpp"

namespace bough::solver {

namespace {

using Amplitudes = AffineField::Amplitudes;
using Vector12d = Eigen::Matrix<double, 12, 1>;
using Factors = Eigen::Matrix<double, 3, 12>;
using Turned = Eigen::Matrix<double, 12, Eigen::Dynamic, 0, 12, 12>;
using Sums = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 18, 1>;  // one per kind of product, J's and y's

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

// diagonal: of K where it has nothing else, or empty.
void add_modal(const MatrixXd& K, const VectorXd& diagonal, const ConstVectorRef& x, double* f) {
  Eigen::Map<VectorXd> sum(f, x.size());
  if (diagonal.size() > 0) {
    sum += diagonal.cwiseProduct(x);
  } else {
    sum.noalias() += K * x;
  }
}

}  // namespace

void Body::calc_flexible_mass(const ConstVectorRef& eta, BodyInertia& x) const {
  const Eigen::Index n = n_, rows = pad(n), num_J = E_J_.rows(), num_y = B_.cols(), num_C = E_C_.rows();
  x.eta.head(n) = eta;
  multiply(by_eta_.data(), by_eta_.rows(), n, eta.data(), x.by_eta.data());
  const double* y = x.by_eta.data() + num_J * rows;
  Sums sums(num_J + num_y);
  multiply_transposed(x.by_eta.data(), rows, num_J + num_y, x.eta.data(), sums.data());

  Vector12d l, a;
  multiply(field_.L.data(), 12, n, eta.data(), l.data());
  a = 0.5 * B_.lazyProduct(sums.tail(num_y));
  const Eigen::Map<const Amplitudes> l_34(l.data());
  x.a = Eigen::Map<const Amplitudes>(a.data());
  x.A = field_.A0 + x.a - 0.5 * field_.calc_correction(x.a, x.a);
  x.P = x.A + l_34;
  const double root = std::sqrt(mass_);
  x.S = root * x.P.col(0);

  Turned turned(12, num_y);  // ∂A/∂a B
  for (Eigen::Index q = 0; q < num_y; ++q) turned.col(q) = turn(field_, x.a, B_.col(q));
  const Factors of_L = make_factors(x.A), of_Y = make_factors(x.P);
  Eigen::Matrix<double, Eigen::Dynamic, 12, 0, 12, 12> to_V = turned.transpose();
  x.V.noalias() = L_t_;
  add_product(y, rows, num_y, to_V.data(), 12, x.V.data());
  const Eigen::Matrix<double, 12, 3> from_L = of_L.transpose();
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 15, 3> from_y(num_y + num_C, 3);
  from_y.topRows(num_y).noalias() = (of_Y * turned).transpose();
  from_y.bottomRows(num_C) = E_C_;
  x.C.noalias() = gamma1_rest_t_;
  add_product(L_t_.data(), rows, 12, from_L.data(), 3, x.C.data());
  add_product(y, rows, num_y + num_C, from_y.data(), 3, x.C.data());

  Vector6d J_rest = Vector6d::Zero();
  multiply_transposed(J1_rest_t_.data(), rows, J1_rest_t_.cols(), x.eta.data(), J_rest.data());
  Vector6d J6 = J0_rest_ + pack_inertia(x.A * (x.A + 2 * l_34).transpose()) + J_rest;
  J6 += E_J_.transpose().lazyProduct(sums.head(num_J));

  // M_ηη is the constant remainder and a square.
  add_square(M_rest_.data(), x.V.data(), rows, x.M_modal.data());
  for (Eigen::Index j = 0; j < n; ++j) {
    for (int i = 0; i < 3; ++i) {
      x.M_top(i, j) = root * x.V(j, i);
      x.M_top(3 + i, j) = x.C(j, i);
    }
  }
  x.M6.topRightCorner<3, 3>() = -skew(x.S);
  x.M6.bottomLeftCorner<3, 3>() = skew(x.S);
  x.M6.bottomRightCorner<3, 3>() = unpack_tensor(J6);
}

void Body::calc_flexible_bias(const Vector3d& w, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                              BodyInertia& x) const {
  const Eigen::Index n = n_, rows = pad(n), num_J = E_J_.rows(), num_y = B_.cols(), num_A2 = E_A2_.rows();
  x.eta.head(n) = eta_dot;
  multiply(A2_.data(), A2_.rows(), n, eta_dot.data(), x.A2.data());
  Sums sums(num_J + num_y);
  multiply_transposed(x.by_eta.data(), rows, num_J + num_y, x.eta.data(), sums.data());
  double* pair = x.pairs.data();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k <= j; ++k) *pair++ = eta_dot[j] * eta_dot[k];
  }
  multiply_transposed(by_pair_.data(), by_pair_.rows(), by_pair_.cols(), x.pairs.data(), x.by_pair.data());
  Vector12d l_dot, a_dot, a_ddot;
  multiply(field_.L.data(), 12, n, eta_dot.data(), l_dot.data());
  a_dot = B_.lazyProduct(sums.tail(num_y));
  a_ddot = B_.lazyProduct(x.by_pair.tail(num_y));  // at η̈ = 0
  const Eigen::Map<const Amplitudes> l_dot_34(l_dot.data()), a_dot_34(a_dot.data()), a_ddot_34(a_ddot.data());
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
  const Amplitudes U_l = -ww_tilde * (x.P - x.A) - w2_tilde * l_dot_34;
  const Vector6d half_ww(0.5 * w.x() * w.x(), 0.5 * w.y() * w.y(), 0.5 * w.z() * w.z(), w.x() * w.y(), w.x() * w.z(),
                         w.y() * w.z());
  const Vector6d minus_half = -half_ww;
  const Vector3d C_eta_dot = [&] {
    Vector3d sum;
    multiply_transposed(x.C.data(), rows, 3, x.eta.data(), sum.data());
    return sum;
  }();
  Sums of_J(num_J), of_A2(num_A2);
  of_J = -2 * E_J_.lazyProduct(half_ww);
  of_A2 = E_A2_.lazyProduct(w);
  double* h = x.h_modal.data();
  x.h_modal.setZero();
  add_product(x.V.data(), rows, 12, U_Y.data(), 1, h);
  add_product(L_t_.data(), rows, 12, U_l.data(), 1, h);
  add_product(J1_rest_t_.data(), rows, J1_rest_t_.cols(), minus_half.data(), 1, h);
  add_product(x.by_eta.data(), rows, num_J, of_J.data(), 1, h);
  add_product(x.A2.data(), rows, num_A2, of_A2.data(), 1, h);
  x.h.tail(n) = x.h_modal.head(n);
  add_modal(K_, K_diagonal_, eta, x.h.data() + 6);
  add_modal(D_, D_diagonal_, eta_dot, x.h.data() + 6);

  Vector6d J_rest = Vector6d::Zero();
  multiply_transposed(J1_rest_t_.data(), rows, J1_rest_t_.cols(), x.eta.data(), J_rest.data());
  Vector6d J6_dot = pack_inertia(2 * (A_dot * x.P.transpose() + l_dot_34 * x.A.transpose())) + J_rest;
  J6_dot += 2 * E_J_.transpose().lazyProduct(sums.head(num_J));
  const Matrix3d J = x.M6.bottomRightCorner<3, 3>(), J_dot = unpack_tensor(J6_dot);
  x.h.head<3>() = w.cross(w.cross(x.S)) + 2 * root * w.cross(Vector3d(P_dot.col(0))) + root * A_ddot.col(0);
  Vector3d moment = J_dot * w + w.cross(Vector3d(J * w + C_eta_dot));
  moment += E_pair_.transpose().lazyProduct(x.by_pair.head(E_pair_.rows()));
  for (int b = 0; b < 4; ++b) moment += Vector3d(x.P.col(b)).cross(Vector3d(A_ddot.col(b)));
  x.h.segment<3>(3) = moment;
}

LinearField Body::make_linear_field(const Matrix3d& T, const BodyInertia& x) const {
  if (third_) return third_->make_linear_field(T, x.third[0]);
  // Matrix Ω in place of ωωᵀ in ½ ∫ρ r·Tr = -½ Ω : J, as for ω̃ω̃ in calc_flexible_bias.
  const Matrix3d Omega = T - 0.5 * T.trace() * Matrix3d::Identity();
  Vector6d half = pack_tensor(Omega);
  half.head<3>() *= 0.5;
  LinearField field;
  field.V = T * x.P;
  field.L = T * (x.A - x.P);
  field.J1 = -half;
  field.J = -2 * E_J_.lazyProduct(half);
  return field;
}

double Body::calc_modal_force(const LinearField& field, const BodyInertia& x, int j) const {
  using Eigen::Map;
  if (third_) return third_->calc_modal_force(field, x.third[0], j);
  double force =
      x.V.row(j).dot(Map<const Vector12d>(field.V.data())) + L_t_.row(j).dot(Map<const Vector12d>(field.L.data()));
  if (J1_rest_t_.cols() > 0) force += J1_rest_t_.row(j).dot(field.J1);
  for (Eigen::Index i = 0; i < field.J.size(); ++i) force += x.by_eta(j, i) * field.J[i];
  return force;
}

void calc_rigid_bias(const BodyInertia& x, const Vector3d& w, double* h) {
  const Matrix3d J = x.M6.bottomRightCorner<3, 3>();
  Eigen::Map<Vector3d>{h} = w.cross(w.cross(x.S));
  Eigen::Map<Vector3d>{h + 3} = w.cross(Vector3d(J * w));
}

void Body::calc_mass(const ConstVectorRef& eta, BodyInertia& x) const {
  if (n_ == 0) return;
  if (third_) return third_->calc_mass(eta, x.third[0], x);
  calc_flexible_mass(eta, x);
}

void Body::calc_third_order_bias(const Vector3d& w, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                                 BodyInertia& x) const {
  third_->calc_bias(w, eta, eta_dot, x.third[0], x);
  add_modal(K_, K_diagonal_, eta, x.h.data() + 6);
  add_modal(D_, D_diagonal_, eta_dot, x.h.data() + 6);
}

double Body::calc_strain_energy(const ConstVectorRef& eta) const {
  double twice = 0;
  for (int j = 0; j < n_; ++j) twice += eta[j] * K_.col(j).dot(eta);
  return 0.5 * twice + (third_ ? third_->calc_energy(eta) : 0);
}

void Body::calc_bias(const Vector3d& w, const ConstVectorRef& eta, const ConstVectorRef& eta_dot,
                     BodyInertia& x) const {
  if (n_ == 0) return calc_rigid_bias(x, w, x.h.data());
  if (third_) return calc_third_order_bias(w, eta, eta_dot, x);
  calc_flexible_bias(w, eta, eta_dot, x);
}

}  // namespace bough::solver
