#include "stiffening/given_rigid.hpp"
#include "fe/linear/products.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>

namespace bough::stiffening {

namespace {

using Eigen::Index;
using SparseColumns = Eigen::SparseMatrix<double>;

constexpr double kRowRoundoff = 1e-10;     ///< of a row of K R, relative to the sum of the magnitudes of its terms
constexpr double kEnergyRoundoff = 1e-14;  ///< of RᵀKR, relative to Rᵀ diag(K) R
constexpr double kMinSupportPivot = 1e-6;  ///< last pivot of R on the support, relative to the first: below, no support
constexpr double kMasslessMotion = 1e-10;  ///< eigenvalue of RᵀMR with a unit diagonal, relative to the largest
constexpr double kMasslessEnergy = 1e-10;  ///< energy of a rigid massless motion, relative to that of diag K
constexpr double kRitzRank = 1e-12;        ///< of the mass matrix of the subspace, relative to its largest eigenvalue
constexpr double kRitzConvergence = 1e-6;  ///< change of the first elastic Ritz value per step; only its size matters
constexpr double kMaxCorrection = 1e-4;    ///< of an entry of K, relative to √(K_ii K_jj): above, K is not rounded

/// R [num_gdofs x 6] about the mean position, rotations by an angle that moves the farthest grid by one unit of length;
/// 0 in rows without stiffness. `rotation_rows`: 1 at rotations.
MatrixXd calc_motions(const PointTable& points, const VectorXd& D, VectorXd& rotation_rows, double& size) {
  const auto dofs = points.calc_nodal_dofs();
  const Eigen::Vector3d centre = dofs.xyz.colwise().mean();
  size = (dofs.xyz.rowwise() - centre.transpose()).rowwise().norm().maxCoeff();
  if (!(size > 0)) size = 1;
  MatrixXd R = dofs.calc_rigid_modes(centre);
  R.rightCols<3>() /= size;
  rotation_rows = VectorXd::Zero(R.rows());
  for (Index k = 0; k < dofs.row.rows(); ++k)
    for (int c = 3; c < 6; ++c) rotation_rows(dofs.row(k, c)) = 1;
  for (Index i = 0; i < R.rows(); ++i)
    if (!(D(i) > 0)) R.row(i).setZero();
  return R;
}

/// Returns true if K R = 0 to round-off.
bool is_exact(const SparseRows& K, const VectorXd& D, const MatrixXd& R) {
  const MatrixXd K_R = K * R, terms = K.cwiseAbs() * R.cwiseAbs();
  if ((K_R.array().abs() > kRowRoundoff * terms.array()).any()) return false;
  for (Index c = 0; c < R.cols(); ++c)
    if (std::abs(R.col(c).dot(K_R.col(c))) > kEnergyRoundoff * R.col(c).cwiseAbs2().dot(D)) return false;
  return true;
}

/// Chooses six well-conditioned rows of R; translations first, since a constrained rotation may be a soft support.
std::vector<Index> choose_support(const MatrixXd& R, const VectorXd& rotation_rows, double size) {
  constexpr double kRotationWeight = 0.01;
  const VectorXd weight = (1 + rotation_rows.array() * (kRotationWeight * size - 1)).matrix();
  const Eigen::ColPivHouseholderQR<MatrixXd> qr((weight.asDiagonal() * R).transpose());
  if (R.rows() < 6 || std::abs(qr.matrixR()(5, 5)) < kMinSupportPivot * std::abs(qr.matrixR()(0, 0))) return {};
  std::vector<Index> rows;
  for (int i = 0; i < 6; ++i) rows.push_back(qr.colsPermutation().indices()(i));
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// Pseudo-inverse of the symmetric A >= 0, judged with a unit diagonal; `null`: its null space.
MatrixXd invert(const MatrixXd& A, MatrixXd& null) {
  const VectorXd s = A.diagonal().unaryExpr([](double a) { return a > 0 ? 1 / std::sqrt(a) : 1.0; });
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(s.asDiagonal() * A * s.asDiagonal());
  const VectorXd& values = solver.eigenvalues();
  const auto num = (values.array() <= kMasslessMotion * values.maxCoeff()).count();
  const MatrixXd V = s.asDiagonal() * solver.eigenvectors();
  null = V.leftCols(num);
  const auto kept = V.rightCols(V.cols() - num);
  return kept * values.tail(V.cols() - num).cwiseInverse().asDiagonal() * kept.transpose();
}

/// Number of zero-energy modes: Ritz values below the last gap of kMaxRigidQuotient.
Index count_mechanisms(const VectorXd& values) {
  Index num = 0;
  for (Index k = 1; k < values.size(); ++k)
    if (std::abs(values(k - 1)) < kMaxRigidQuotient * values(k)) num = k;
  return num;
}

/// Ritz values of K φ = λ M φ orthogonal to the rigid-body motions R, ascending, of four vectors.
VectorXd calc_ritz_values(const SparseRows& M, const MatrixXd& R, const MatrixXd& mass_inverse,
                          const std::vector<Index>& others, const Eigen::SimplicialLDLT<SparseColumns>& K_oo) {
  const Index n = R.rows(), m = std::min<Index>(4, static_cast<Index>(others.size()));
  const MatrixXd M_R = M * R;
  MatrixXd X(n, m);
  const auto fill = [&](Index column, int seed) {
    for (Index i = 0; i < n; ++i) X(i, column) = std::sin(1.0 + 0.7 * static_cast<double>(i * (column + 1) + seed));
  };
  for (Index c = 0; c < m; ++c) fill(c, 0);
  VectorXd values;
  for (int step = 1; step <= 40; ++step) {
    MatrixXd F = M * X;
    F -= M_R * (mass_inverse * (R.transpose() * F));
    MatrixXd Y = MatrixXd::Zero(n, m);
    const MatrixXd Y_o = K_oo.solve(MatrixXd(F(others, Eigen::all)));  // not into a view: it permutes its rows in place
    Y(others, Eigen::all) = Y_o;
    Y -= R * (mass_inverse * (M_R.transpose() * Y));
    const MatrixXd energy = Y.transpose() * F, mass = Y.transpose() * (M * Y);  // K Y = F
    const VectorXd s = mass.diagonal().unaryExpr([](double a) { return a > 0 ? 1 / std::sqrt(a) : 0.0; });
    const MatrixXd A = s.asDiagonal() * energy * s.asDiagonal(), B = s.asDiagonal() * mass * s.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> range(linear::symmetrize(B));
    const VectorXd& b = range.eigenvalues();
    const auto rank = (b.array() > kRitzRank * b.maxCoeff()).count();
    if (rank == 0 || !std::isfinite(b.sum()) || !std::isfinite(A.sum())) return {};
    const MatrixXd W = range.eigenvectors().rightCols(rank) * b.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(W.transpose() * linear::symmetrize(A) * W);
    X.leftCols(rank) = Y * (s.asDiagonal() * (W * ritz.eigenvectors()));
    // Orthogonal to the accepted ones: K_oo⁻¹ amplifies a mechanism in any vector, so only one would be found.
    const MatrixXd M_kept = M * X.leftCols(rank);
    for (Index c = rank; c < m; ++c) {
      fill(c, step);
      for (int pass = 0; pass < 2; ++pass) X.col(c) -= X.leftCols(rank) * (M_kept.transpose() * X.col(c)).eval();
    }
    const VectorXd before = values;
    values = ritz.eigenvalues();
    const Index first = count_mechanisms(values);
    if (before.size() == values.size() && std::abs(values(first) - before(first)) < kRitzConvergence * values(first))
      break;
  }
  return values;
}

/// K with the columns of `support` from equilibrium; empty if these differ from K by more than kMaxCorrection.
SparseRows restore(const SparseRows& K, const VectorXd& D, const MatrixXd& R, const std::vector<Index>& support,
                   const std::vector<Index>& others) {
  const MatrixXd inverse = R(support, Eigen::all).fullPivLu().inverse();
  MatrixXd R_o = R;
  R_o(support, Eigen::all).setZero();
  MatrixXd K_s = -((K * R_o) * inverse);  // columns of the support, rows of the others
  const MatrixXd K_ss = -(R(others, Eigen::all) * inverse).transpose() * K_s(others, Eigen::all);
  K_s(support, Eigen::all) = linear::symmetrize(K_ss);
  std::vector<int> place(static_cast<std::size_t>(K.rows()), -1);
  for (std::size_t j = 0; j < support.size(); ++j) place[static_cast<std::size_t>(support[j])] = static_cast<int>(j);
  std::vector<Eigen::Triplet<double>> entries;
  MatrixXd old = MatrixXd::Zero(K.rows(), 6);
  for (int i = 0; i < K.outerSize(); ++i)
    for (SparseRows::InnerIterator it(K, i); it; ++it) {
      const int s = place[static_cast<std::size_t>(it.col())];
      if (s >= 0)
        old(i, s) = it.value();
      else if (place[static_cast<std::size_t>(i)] < 0)
        entries.emplace_back(i, static_cast<int>(it.col()), it.value());
    }
  for (Index i = 0; i < K.rows(); ++i)
    for (Index j = 0; j < 6; ++j) {
      const Index s = support[static_cast<std::size_t>(j)];
      if (std::abs(K_s(i, j) - old(i, j)) > kMaxCorrection * std::sqrt(std::abs(D(i) * D(s)))) return {};
      if (K_s(i, j) == 0) continue;
      entries.emplace_back(static_cast<int>(i), static_cast<int>(s), K_s(i, j));
      if (place[static_cast<std::size_t>(i)] < 0)
        entries.emplace_back(static_cast<int>(s), static_cast<int>(i), K_s(i, j));
    }
  SparseRows restored(K.rows(), K.cols());
  restored.setFromTriplets(entries.begin(), entries.end());
  return restored;
}

}  // namespace

namespace {

bool is_direct_stiffness(const fe::Element& element) {
  const auto* direct = dynamic_cast<const fe::DirectElement*>(&element);
  return direct && direct->kind() == fe::DirectKind::Stiffness;
}

}  // namespace

RigidMotionCheck check_rigid_motions(const PointTable& points, const SparseRows& K, const SparseRows& M) {
  RigidMotionCheck result;
  const VectorXd D = K.diagonal();
  VectorXd rotation_rows;
  double size = 1;
  const MatrixXd R = calc_motions(points, D, rotation_rows, size);
  result.is_exact = is_exact(K, D, R);
  if (result.is_exact) return result;
  const auto support = choose_support(R, rotation_rows, size);
  if (support.empty()) return result;
  std::vector<Index> others;
  for (Index i = 0; i < K.rows(); ++i)
    if (D(i) > 0 && std::find(support.begin(), support.end(), i) == support.end()) others.push_back(i);
  if (others.empty()) return result;

  std::vector<int> place(static_cast<std::size_t>(K.rows()), -1);
  for (std::size_t i = 0; i < others.size(); ++i) place[static_cast<std::size_t>(others[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Index row : others)
    for (SparseRows::InnerIterator it(K, row); it; ++it)
      if (const int c = place[static_cast<std::size_t>(it.col())]; c >= 0)
        entries.emplace_back(place[static_cast<std::size_t>(row)], c, it.value());
  SparseColumns A(static_cast<Index>(others.size()), static_cast<Index>(others.size()));
  A.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<SparseColumns> K_oo(A);
  if (K_oo.info() != Eigen::Success) return result;

  const MatrixXd mass = R.transpose() * (M * R), energy = R.transpose() * (K * R);
  MatrixXd massless;
  const MatrixXd mass_inverse = invert(linear::symmetrize(mass), massless);
  const VectorXd ritz = calc_ritz_values(M, R, mass_inverse, others, K_oo);
  if (ritz.size() == 0) return result;
  result.num_mechanisms = static_cast<int>(count_mechanisms(ritz));
  result.elastic = ritz(result.num_mechanisms);
  if (!(result.elastic > 0)) return result;
  for (Index c = 0; c < massless.cols(); ++c) {
    const VectorXd x = massless.col(c), u = R * x;
    if (std::abs(x.dot(energy * x)) < kMasslessEnergy * u.cwiseAbs2().dot(D)) ++result.num_rigid;
  }
  // Eigenvalues of (RᵀKR, RᵀMR) on the motions with mass.
  const Eigen::SelfAdjointEigenSolver<MatrixXd> root(mass_inverse);
  const Index num = 6 - massless.cols();
  const MatrixXd W =
      root.eigenvectors().rightCols(num) * root.eigenvalues().tail(num).cwiseMax(0).cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> quotients(W.transpose() * linear::symmetrize(energy) * W);
  result.worst = quotients.eigenvalues().cwiseAbs().maxCoeff();
  const double max_quotient = kMaxRigidQuotient * result.elastic;
  result.num_rigid += static_cast<int>((quotients.eigenvalues().array().abs() < max_quotient).count());
  if (result.num_rigid < 6) return result;
  result.K = restore(K, D, R, support, others);
  result.is_free = result.K.nonZeros() > 0;
  return result;
}

std::string describe(const RigidMotionCheck& check) {
  const auto to_hz = [](double lambda) { return std::sqrt(lambda) / (2 * std::numbers::pi); };
  char text[200];
  std::snprintf(text, sizeof text, "up to %.2g Hz, the first elastic mode has %.6g Hz", to_hz(check.worst),
                to_hz(check.elastic));
  return text;
}

void restore_direct_stiffness(const records::Deck& deck, const Eigen::Vector3d& origin, const fe::Elements& others,
                              fe::ElementList& direct, Diagnostics& diagnostics) {
  const auto is_stiffness = [](const auto& element) { return is_direct_stiffness(*element); };
  if (std::none_of(direct.elements.begin(), direct.elements.end(), is_stiffness)) return;
  Diagnostics repeated;  // by the model
  const PointTable points(deck, origin, repeated);
  if (repeated.num_errors() > 0) return;
  const auto add_stiffness = [](const fe::Element& element, Eigen::Ref<MatrixXd> A) { element.add_stiffness(1, A); };
  const auto add_mass = [](const fe::Element& element, Eigen::Ref<MatrixXd> A) {
    element.add_mass(fe::MassKind::Consistent, 1, A);
  };
  const SparseRows K = fe::sum_elements(direct.elements, points.num_gdofs, add_stiffness);
  const SparseRows M = fe::sum_elements(direct.elements, points.num_gdofs, add_mass) +
                       fe::sum_elements(others, points.num_gdofs, add_mass);
  const auto check = check_rigid_motions(points, K, M);
  if (!check.is_free) return;
  std::erase_if(direct.elements, is_stiffness);
  add_direct_elements(points, check.K, fe::DirectKind::Stiffness, direct);
  diagnostics.note("reduce.rigid-roundoff", deck.locate({0, 0}),
                   "the stiffness matrix of K2GG strains in rigid-body motions by round-off: " + describe(check) +
                       "; they are taken as rigid",
                   "nothing to do; use frame = \"fixed\" if the body is held by springs as soft as these");
}

}  // namespace bough::stiffening
