#include "solver/bodies/affine_field.hpp"

#include <cmath>

namespace bough::solver {

namespace {

using Amplitudes = AffineField::Amplitudes;
constexpr double kNoMass = 1e-10;    // of the largest second moment
constexpr double kThin = 1e-2;       // of the largest second moment
constexpr double kSmall = 1e-8;      // of the largest row, of the largest pivot
constexpr double kSameSpan = 1e-26;  // of the largest eigenvalue of CCᵀ: 1e-13 of C

// f_b = scale_b (p - c)·a_b for b > 0.
struct Basis {
  Amplitudes A0 = Amplitudes::Zero();
  Matrix3d axes = Matrix3d::Zero();    // a_b / √e_b; zero if there is no mass
  Matrix3d damped = Matrix3d::Zero();  // the same, less for a thin body's thin sides
  double scale = 0;                    // 1/√m
};

Basis make_basis(const records::FlexBody& flex) {
  Basis basis;
  if (!(flex.mass > 0)) return basis;
  const double root = std::sqrt(flex.mass);
  basis.scale = 1 / root;
  basis.A0.col(0) = root * flex.cg;
  const Matrix3d J = 0.5 * (flex.inertia + flex.inertia.transpose());
  const Matrix3d E = 0.5 * J.trace() * Matrix3d::Identity() - J - flex.mass * flex.cg * flex.cg.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(E);
  const double largest = principal.eigenvalues()[2];
  for (int b = 0; b < 3; ++b) {
    const double e = principal.eigenvalues()[b];
    if (!(e > kNoMass * largest)) continue;
    basis.axes.col(b) = principal.eigenvectors().col(b) / std::sqrt(e);
    basis.damped.col(b) = basis.axes.col(b) * e / (e + kThin * largest);
    basis.A0.col(1 + b) = principal.eigenvectors().col(b) * std::sqrt(e);
  }
  return basis;
}

// Σ m φ pᵀ: its symmetric part from Γ3, the other from Γ1 = Σ p×φ, which counts the rotations of the nodes.
Matrix3d make_W(const Matrix3d& gamma3, const Vector3d& gamma1) {
  const Matrix3d W = 0.5 * gamma3.trace() * Matrix3d::Identity() - gamma3;
  return 0.5 * (W + W.transpose()) + 0.5 * skew(gamma1);
}

// X_i of F_I(i) = -M X_i, as amplitudes.
Amplitudes make_inertial_field(int i, const Basis& basis) {
  Amplitudes X = Amplitudes::Zero();
  auto tilde = [](int a) { return skew(Vector3d(Vector3d::Unit(a))); };
  if (i < 3) {
    X(i, 0) = basis.scale > 0 ? 1 / basis.scale : 0;
  } else if (i < 6) {
    X = tilde(i - 3) * basis.A0;
  } else if (i < 9) {
    X = tilde(i - 6) * tilde(i - 6) * basis.A0;
  } else {
    const int r = i == 11 ? 1 : 0, s = i == 9 ? 1 : 2;
    X = (tilde(r) * tilde(s) + tilde(s) * tilde(r)) * basis.A0;
  }
  return X;
}

}  // namespace

AffineField AffineField::fit(const records::FlexBody& flex, int n, bool stiffening) {
  const Basis basis = make_basis(flex);
  const auto& integrals = flex.integrals();
  AffineField field;
  field.A0 = basis.A0;
  field.W.rightCols<3>() = basis.damped;
  field.Q = Matrix3d::Identity() - 0.5 * basis.A0.rightCols<3>() * basis.damped.transpose();
  field.L = Columns::Zero(12, n);
  field.B = Columns::Zero(12, 0);
  for (int j = 0; j < n; ++j) {
    const Vector3d gamma0 = integrals.gamma0.col(j);
    Eigen::Map<Amplitudes> L(field.L.col(j).data());
    L.col(0) = basis.scale * gamma0;
    L.rightCols<3>() =
        (make_W(integrals.gamma3[static_cast<size_t>(j)], integrals.gamma1.col(j)) - gamma0 * flex.cg.transpose()) *
        basis.axes;
  }
  std::vector<int> loads;
  for (int i = 0; stiffening && i < records::kNumInertialLoads; ++i) {
    const auto at = static_cast<size_t>(i);
    if (flex.kg_inertial_computed[at] && flex.kg_inertial[at].size() > 0) loads.push_back(i);
  }
  if (loads.empty() || n == 0) return field;

  // X_i : C_jl = K_G1(i)_jl for the pairs j ≤ l; of all such C the least, which is the one of least kinetic energy.
  const auto num = static_cast<Eigen::Index>(loads.size()), num_pairs = static_cast<Eigen::Index>(n) * (n + 1) / 2;
  MatrixXd X(num, 12), K(num, num_pairs);
  for (Eigen::Index r = 0; r < num; ++r) {
    const int i = loads[static_cast<size_t>(r)];
    const Amplitudes x = make_inertial_field(i, basis);
    const MatrixXd& G = flex.kg_inertial[static_cast<size_t>(i)];
    X.row(r) = Eigen::Map<const Eigen::Matrix<double, 1, 12>>(x.data());
    Eigen::Index pair = 0;
    for (int l = 0; l < n; ++l) {
      for (int j = 0; j <= l; ++j) K(r, pair++) = 0.5 * (G(j, l) + G(l, j));
    }
  }
  const double largest = K.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return field;
  const VectorXd norm = X.rowwise().norm();
  VectorXd weight = VectorXd::Zero(num);
  for (Eigen::Index r = 0; r < num; ++r) {
    if (norm[r] > kSmall * norm.maxCoeff()) weight[r] = 1 / norm[r];
  }
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
  solver.setThreshold(kSmall);
  solver.compute(weight.asDiagonal() * X);
  MatrixXd C = solver.solve(weight.asDiagonal() * K);  // 12 x pairs
  field.lost = (X * C - K).cwiseAbs().maxCoeff() / largest;

  const Eigen::SelfAdjointEigenSolver<MatrixXd> span(C * C.transpose());
  const Eigen::Index rank = (span.eigenvalues().array() > kSameSpan * span.eigenvalues()[11]).count();
  field.B = span.eigenvectors().rightCols(rank);
  C = field.B.transpose() * C;
  field.c.assign(static_cast<size_t>(rank), MatrixXd(n, n));
  for (Eigen::Index q = 0; q < rank; ++q) {
    MatrixXd& c = field.c[static_cast<size_t>(q)];
    Eigen::Index pair = 0;
    for (int l = 0; l < n; ++l) {
      for (int j = 0; j <= l; ++j) c(j, l) = c(l, j) = C(q, pair++);
    }
  }
  return field;
}

}  // namespace bough::solver
