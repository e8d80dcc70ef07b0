#include "solver/bodies/body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/diagnostic.hpp"
#include "formats/records/special_nodes.hpp"
#include "solver/bodies/kernels.hpp"
#include "solver/bodies/row_basis.hpp"
#include "solver/bodies/soft_energy.hpp"
#include "solver/bodies/tensor.hpp"
#include "solver/bodies/third_order.hpp"

namespace bough::solver {

namespace {
using Amplitudes = AffineField::Amplitudes;

/// Modal mass about mean axes, M - Γᵀ M6⁻¹ Γ with Γ = [Γ0; Γ1] [6 x n]: the kinetic energy of a free body at given
/// modal rates when its frame takes the rigid-body motion that minimizes it. Equal for every frame of a free body.
/// Source: docs/theory/bases.md, Frames.
MatrixXd calc_mean_axis_mass(const MatrixXd& M, const Matrix6d& M6, const records::MassIntegrals& integrals) {
  const Eigen::Index n = M.rows();
  Matrix6Xd G(6, n);
  G << integrals.gamma0.leftCols(n), integrals.gamma1.leftCols(n);
  // Rows by the root of their inertia; mass on a line has no inertia about it, and no G there.
  const double largest = M6.diagonal().tail<3>().maxCoeff();
  Vector6d scale;
  for (int i = 0; i < 6; ++i) {
    const double inertia = M6(i, i);
    scale[i] = inertia > (i < 3 ? 0 : 1e-14 * largest) ? 1 / std::sqrt(inertia) : 0;
  }
  Eigen::CompleteOrthogonalDecomposition<Matrix6d> factor;
  factor.setThreshold(1e-12);
  factor.compute(scale.asDiagonal() * M6 * scale.asDiagonal());
  const Matrix6Xd H = scale.asDiagonal() * G;
  const MatrixXd mean = M - H.transpose() * factor.solve(H);
  return 0.5 * (mean + mean.transpose());
}

// D = Σ 2ζ_i ω_i (M φ_i)(M φ_i)ᵀ over the motions K φ = ω² M φ, by rising ω. Damping belongs to them, not to
// coordinates.
MatrixXd make_damping(const MatrixXd& M, const MatrixXd& K, const std::vector<double>& ratios) {
  const Eigen::Index n = M.rows();
  const auto ratio = [&](Eigen::Index j) { return ratios.size() == 1 ? ratios[0] : ratios[static_cast<size_t>(j)]; };
  MatrixXd D = MatrixXd::Zero(n, n);
  if (n == 0) return D;
  const auto is_nearly_diagonal = [](const MatrixXd& A) {
    const VectorXd root = A.diagonal().cwiseAbs().cwiseSqrt();
    const MatrixXd rest = A - MatrixXd(A.diagonal().asDiagonal());
    return (rest.cwiseAbs().array() <= 1e-9 * (root * root.transpose()).array()).all();
  };
  const bool is_definite = Eigen::LLT<MatrixXd>(M).info() == Eigen::Success;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> motions(K, is_definite ? M : MatrixXd::Identity(n, n));
  if ((is_nearly_diagonal(M) && is_nearly_diagonal(K)) || !is_definite || motions.info() != Eigen::Success) {
    for (Eigen::Index j = 0; j < n; ++j) D(j, j) = 2 * ratio(j) * std::sqrt(std::max(0.0, K(j, j) * M(j, j)));
    return D;
  }
  const MatrixXd A = M * motions.eigenvectors();
  for (Eigen::Index i = 0; i < n; ++i)
    D += 2 * ratio(i) * std::sqrt(std::max(0.0, motions.eigenvalues()[i])) * A.col(i) * A.col(i).transpose();
  return D;
}

/// Largest difference between the eigenvalues of the file and those of K and M, relative: of the pencil, or of each
/// coordinate alone, K_jj / M_jj, where the coordinates of the file are no modes. Infinite if M is not definite.
double calc_eigenvalue_error(const records::FlexBody& flex, const MatrixXd& M) {
  const MatrixXd& K = flex.modal_stiffness;
  const auto compare = [](const VectorXd& found, const VectorXd& expected) {
    const double floor = 1e-9 * expected.cwiseAbs().maxCoeff();
    return ((found - expected).array().abs() / expected.array().abs().max(floor)).maxCoeff();
  };
  if (flex.eigenvalue.size() != M.rows() || !(flex.eigenvalue.cwiseAbs().maxCoeff() > 0) ||
      Eigen::LLT<MatrixXd>(M).info() != Eigen::Success)
    return std::numeric_limits<double>::infinity();
  VectorXd sorted = flex.eigenvalue;
  std::sort(sorted.begin(), sorted.end());
  const VectorXd of_pencil =
      Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M, Eigen::EigenvaluesOnly).eigenvalues();
  return std::min(compare(of_pencil, sorted), compare(K.diagonal().cwiseQuotient(M.diagonal()), flex.eigenvalue));
}

/// Modal mass [n x n] to which damping ratios belong, that of the body as its file damps it: of a body whose rigid-body
/// motions were removed about mean axes, whatever its frame is; of a body on supports its own. A frame that nodes carry
/// is known by the eigenvalues, which are those of the free body.
MatrixXd calc_damped_mass(const records::FlexBody& flex, const Matrix6d& M6, Eigen::Index n) {
  constexpr double kEqual = 1e-5;  // files of five digits
  const MatrixXd& M = flex.modal_mass;
  if (n == 0 || !(flex.mass > 0)) return M.topLeftCorner(n, n);
  const MatrixXd mean = calc_mean_axis_mass(M, M6, flex.integrals());
  const bool is_free =
      flex.is_free_free || (calc_eigenvalue_error(flex, M) > kEqual && calc_eigenvalue_error(flex, mean) <= kEqual);
  return (is_free ? mean : M).topLeftCorner(n, n);
}

}  // namespace

Body Body::make_rigid(double mass, const Vector3d& cg, const Matrix3d& inertia_about_cg) {
  Body body;
  body.mass_ = mass;
  body.S0_ = mass * cg;
  const Matrix3d c = skew(cg);
  const Matrix3d J = 0.5 * (inertia_about_cg + inertia_about_cg.transpose()) - mass * c * c;
  body.J0_ = pack_tensor(J);
  body.M6_ << mass * Matrix3d::Identity(), -skew(body.S0_), skew(body.S0_), J;
  body.nodes_.emplace_back();
  return body;
}

Body Body::make_flexible(const records::FlexBody& flex, int num_modes, bool stiffening,
                         const std::vector<double>& damping_ratios) {
  Body body;
  const int n = num_modes < 0 ? flex.num_modes() : num_modes;
  BOUGH_DEMAND(n <= flex.num_modes() && (n == 0 || !flex.integrals().empty()));
  body.n_ = n;
  body.stiffened_ = stiffening;
  body.mass_ = flex.mass;
  body.S0_ = flex.mass * flex.cg;
  body.J0_ = pack_tensor(flex.inertia);
  body.M6_ << flex.mass * Matrix3d::Identity(), -skew(body.S0_), skew(body.S0_), unpack_tensor(body.J0_);
  body.M_ = flex.modal_mass.topLeftCorner(n, n);
  body.K_ = flex.modal_stiffness.topLeftCorner(n, n);
  // The solver adds the stiffening by the motion: the part of it in the preloaded stiffness is subtracted.
  if (stiffening)
    for (std::size_t i = 0; i < flex.kg_inertial.size() && flex.preload_A_I.size() > 0; ++i)
      if (const double a = flex.preload_A_I(static_cast<Eigen::Index>(i)); a != 0)
        body.K_ -= a * flex.kg_inertial[i].topLeftCorner(n, n);
  body.D_ = MatrixXd::Zero(n, n);
  if (!damping_ratios.empty()) {
    body.D_ = make_damping(calc_damped_mass(flex, body.M6_, n), body.K_, damping_ratios);
  } else if (flex.modal_damping.size() > 0) {
    body.D_ = flex.modal_damping.topLeftCorner(n, n);
  }
  if (body.K_.isDiagonal(0)) body.K_diagonal_ = body.K_.diagonal();
  if (body.D_.isDiagonal(0)) body.D_diagonal_ = body.D_.diagonal();
  if (stiffening && n == flex.num_modes() && !flex.third_order.empty())
    body.third_ = std::make_shared<const ThirdOrderBody>(flex);
  else if (stiffening && !flex.next_order.empty() && flex.next_order.modes.back() < n)
    body.soft_energy_ = std::make_shared<const SoftEnergy>(flex.next_order);
  body.add_second_order(flex);
  body.add_flexible_nodes(flex);
  return body;
}

void Body::add_second_order(const records::FlexBody& flex) {
  const auto& integrals = flex.integrals();
  const int n = n_;
  field_ = AffineField::fit(flex, n, stiffened_ && !third_);
  const int r = field_.rank();
  const auto rows = pad(n);
  M_rest_ = MatrixXd::Zero(rows, rows);
  M_rest_.topLeftCorner(n, n) = M_ - field_.L.transpose() * field_.L;
  L_t_ = MatrixXd::Zero(rows, 12);
  L_t_.topRows(n) = field_.L.transpose();
  B_ = field_.B;
  gamma1_rest_t_ = MatrixXd::Zero(rows, 3);
  if (n > 0) gamma1_rest_t_.topRows(n) = integrals.gamma1.leftCols(n).transpose();  // without modes of no size
  J1_rest_t_ = MatrixXd::Zero(rows, 6);
  J0_rest_ = J0_ - pack_inertia(field_.A0 * field_.A0.transpose());
  MatrixXd J(6, n * n), C(3, n * n), A2(3, n * n), C_dot(3, n * (n + 1) / 2);
  MatrixXd y_dot(r, n * (n + 1) / 2);
  for (int j = 0, pair = 0; j < n; ++j) {
    const auto sj = static_cast<size_t>(j);
    const Matrix3d& g3 = integrals.gamma3[sj];
    const Amplitudes L = Amplitudes(Eigen::Map<const Amplitudes>(field_.L.col(j).data()));
    const Matrix3d E1 = L * field_.A0.transpose();
    J1_rest_t_.row(j) = pack_tensor(g3 + g3.transpose()) - pack_inertia(E1 + E1.transpose());
    for (int b = 0; b < 4; ++b)
      gamma1_rest_t_.row(j) -= Vector3d(field_.A0.col(b)).cross(Vector3d(L.col(b))).transpose();
    for (int k = 0; k < n; ++k) {
      const auto sk = static_cast<size_t>(k);
      const Vector3d g2_kj = integrals.gamma2[sk].col(j), g2_jk = integrals.gamma2[sj].col(k);
      J.col(k * n + j) = 0.5 * (pack_tensor(integrals.gamma4[sj][sk]) + pack_tensor(integrals.gamma4[sk][sj]));
      C.col(k * n + j) = g2_kj;
      A2.col(k * n + j) = g2_kj - g2_jk;
      if (k > j) continue;
      C_dot.col(pair) = (k < j ? 1.0 : 0.5) * (g2_kj + g2_jk);
      for (int q = 0; q < r; ++q) y_dot(q, pair) = (k < j ? 2.0 : 1.0) * field_.c[static_cast<size_t>(q)](j, k);
      ++pair;
    }
  }
  const double size = std::max(J.rowwise().norm().maxCoeff(), C.rowwise().norm().maxCoeff());
  bool is_rounding = true;  // next to √(J0 M_jj), which bounds what J gains by η_j
  for (int j = 0; j < n; ++j)
    is_rounding = is_rounding && J1_rest_t_.row(j).norm() <= 4e-15 * std::sqrt(J0_.norm() * std::abs(M_(j, j)));
  if (is_rounding) J1_rest_t_.resize(rows, 0);
  const RowBasis of_J = find_row_basis(J, size), of_C = find_row_basis(C, size), of_A2 = find_row_basis(A2, size),
                 of_C_dot = find_row_basis(C_dot, size);
  E_J_ = of_J.E;
  E_C_ = of_C.E;
  E_A2_ = of_A2.E;
  E_pair_ = of_C_dot.E;
  by_eta_ = MatrixXd::Zero((E_J_.rows() + r + E_C_.rows()) * rows, n);
  const auto place = [&](const MatrixXd& kinds, MatrixXd& tables, Eigen::Index first) {
    for (Eigen::Index i = 0; i < kinds.rows(); ++i)
      for (int k = 0; k < n; ++k)
        tables.block((first + i) * rows, k, n, 1) = kinds.row(i).segment(k * n, n).transpose();
  };
  place(of_J.rows, by_eta_, 0);
  for (int q = 0; q < r; ++q) by_eta_.middleRows((E_J_.rows() + q) * rows, n) = field_.c[static_cast<size_t>(q)];
  place(of_C.rows, by_eta_, E_J_.rows() + r);
  A2_ = MatrixXd::Zero(E_A2_.rows() * rows, n);
  place(of_A2.rows, A2_, 0);
  by_pair_ = MatrixXd::Zero(pad(y_dot.cols()), E_pair_.rows() + r);
  by_pair_.topLeftCorner(y_dot.cols(), E_pair_.rows()) = of_C_dot.rows.transpose();
  by_pair_.topRightCorner(y_dot.cols(), r) = y_dot.transpose();
}

void Body::add_flexible_nodes(const records::FlexBody& flex) {
  nodes_.emplace_back();
  nodes_[0].is_material = !flex.is_free_free || n_ == 0;
  nodes_[0].phi = nodes_[0].psi = Matrix3Xd::Zero(3, n_);
  // A mode moves the mass by √(M_jj / m) in the mean; rotations are that over the body's size.
  const VectorXd mean = (M_.diagonal().cwiseMax(0) / std::max(mass_, 1e-300)).cwiseSqrt();
  const double size = std::sqrt(J0_.head<3>().sum() / std::max(mass_, 1e-300));
  const auto is_rounding = [&](const Matrix3Xd& shape, double arm) {
    if (!(mass_ > 0)) return false;
    for (int j = 0; j < n_; ++j) {
      if (arm * shape.col(j).cwiseAbs().maxCoeff() > 1e-12 * mean[j]) return false;
    }
    return true;
  };
  for (int k = 0; k < flex.num_nodes(); ++k) {
    Node node;
    node.id = flex.node_id[static_cast<size_t>(k)];
    node.p = flex.node_xyz.row(k).transpose();
    const MatrixXd& phi = flex.phi[static_cast<size_t>(k)];
    node.phi = phi.topLeftCorner(3, n_);
    node.psi = phi.block(3, 0, 3, n_);
    // Rounding of another program's shapes is no motion.
    if (is_rounding(node.phi, 1)) node.phi.setZero();
    if (is_rounding(node.psi, size)) node.psi.setZero();
    node.moves = !node.phi.isZero(0) || !node.psi.isZero(0);
    if (records::is_special_node(flex, k)) {
      node.is_material = false;
      nodes_.push_back(std::move(node));
      continue;
    }
    const auto stack_locators = [&](int first_direction, RowMatrixXd& K2) {
      int locator[3];
      for (int a = 0; a < 3; ++a) locator[a] = flex.find_locator(node.id, first_direction + a);
      if (locator[0] < 0 || locator[1] < 0 || locator[2] < 0) return false;
      if (!stiffened_ || third_ || !node.moves) return true;
      K2.resize(3 * n_, n_);
      for (int a = 0; a < 3; ++a) {
        const MatrixXd& full = flex.kg_external[static_cast<size_t>(locator[a])];
        const MatrixXd half = 0.5 * (full.topLeftCorner(n_, n_) + full.topLeftCorner(n_, n_).transpose());
        for (int j = 0; j < n_; ++j) K2.row(a + 3 * j) = half.row(j);
      }
      return true;
    };
    // A held node outside the interface stays at rest: the fields are its motion but for a thousandth of u₂.
    if (third_ && (node.moves || third_->is_exact(flex, node.id))) {
      node.higher = third_->make_node_motion(flex, static_cast<size_t>(k));
      node.moves = node.moves || !node.higher.is_zero();
    }
    node.has_locators = stack_locators(1, node.K2);
    node.has_moments = stack_locators(4, node.K2_theta);
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

MatrixXd BodyInertia::make_M() const {
  const Eigen::Index n = M_top.cols();
  MatrixXd M(6 + n, 6 + n);
  M.topLeftCorner<6, 6>() = M6;
  M.topRightCorner(6, n) = M_top;
  M.bottomLeftCorner(n, 6) = M_top.transpose();
  M.bottomRightCorner(n, n) = M_modal.topLeftCorner(n, n).selfadjointView<Eigen::Lower>();
  return M;
}

BodyInertia Body::make_inertia() const {
  BodyInertia inertia;
  inertia.h = VectorXd::Zero(6 + n_);
  inertia.mass = mass_;
  inertia.S = S0_;
  inertia.M6 = M6_;
  if (n_ == 0) return inertia;
  inertia.M_top = Matrix6Xd::Zero(6, n_);
  const auto rows = pad(n_);
  inertia.by_eta = MatrixXd::Zero(rows, by_eta_.rows() / rows);
  inertia.A2 = MatrixXd::Zero(rows, E_A2_.rows());
  inertia.pairs = VectorXd::Zero(by_pair_.rows());
  inertia.by_pair = VectorXd::Zero(by_pair_.cols());
  inertia.V = MatrixXd::Zero(rows, 12);
  inertia.C = MatrixXd::Zero(rows, 3);
  inertia.M_modal = MatrixXd::Zero(rows, rows);
  inertia.M_modal.topLeftCorner(n_, n_) = M_;
  inertia.h_modal = inertia.eta = VectorXd::Zero(rows);
  if (third_) inertia.third.push_back(third_->make_data());
  return inertia;
}

}  // namespace bough::solver
