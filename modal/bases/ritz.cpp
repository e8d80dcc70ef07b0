#include "modal/bases/ritz.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fe/linear/blas.hpp"
#include "fe/linear/products.hpp"
#include "fe/model/model_size.hpp"
#include "fe/model/row_kinds.hpp"
#include "modal/canonical.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::bases {

namespace {

/// Coordinates to units in which each has mass 1; those whose mass is negligible for their stiffness (frequencies 1e7
/// times that of the softest) go by their stiffness, so that their mass stays negligible.
VectorXd calc_mass_scale(const MatrixXd& M, const MatrixXd& K) {
  const VectorXd m = M.diagonal(), k = K.diagonal();
  double longest = 0;  // 1/ω²
  for (Eigen::Index j = 0; j < m.size(); ++j)
    if (m(j) > 0 && k(j) > 0) longest = std::max(longest, m(j) / k(j));
  VectorXd scale = VectorXd::Zero(m.size());
  for (Eigen::Index j = 0; j < m.size(); ++j) {
    const double min_norm = k(j) > 0 ? longest * k(j) : 0;
    const double mass = m(j) > detail::kStiffCoordinate * min_norm ? m(j) : min_norm;
    if (mass > 0) scale(j) = 1 / std::sqrt(mass);
  }
  return scale;
}

/// Elastic directions among Z: Y with YᵀKY = 1. The others are dependent vectors.
MatrixXd find_stiff(const MatrixXd& Z, const MatrixXd& K) {
  if (Z.cols() == 0) return Z;
  const VectorXd diagonal = (Z.cwiseAbs2().transpose() * K.diagonal().cwiseMax(0)).cwiseSqrt();
  const VectorXd scale = diagonal.unaryExpr([](double d) { return d > 0 ? 1 / d : 0.0; });
  const MatrixXd unit = Z * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> energy(linear::symmetrize(unit.transpose() * K * unit));
  const VectorXd& e = energy.eigenvalues();
  const auto num = (e.array() > detail::kDependentDirection).count();
  return unit * energy.eigenvectors().rightCols(num) * e.tail(num).cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace

RitzPairs calc_ritz_pairs(const MatrixXd& M, const MatrixXd& K) {
  RitzPairs pairs{VectorXd(0), MatrixXd(M.rows(), 0)};
  if (M.rows() == 0) return pairs;
  const VectorXd scale = calc_mass_scale(M, K);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> gram(linear::symmetrize(scale.asDiagonal() * M * scale.asDiagonal()));
  const VectorXd& d = gram.eigenvalues();
  const auto dropped = (d.array() <= detail::kMasslessDirection * std::max(d.maxCoeff(), 0.0)).count();
  const auto n = d.size() - dropped;
  MatrixXd W = scale.asDiagonal() * gram.eigenvectors().rightCols(n) *
               d.tail(n).cwiseMax(0).cwiseSqrt().cwiseInverse().asDiagonal();
  pairs.massless = find_stiff(scale.asDiagonal() * gram.eigenvectors().leftCols(dropped), K);
  if (n == 0) return pairs;
  // Massless motions follow statically, without force. If they were omitted they would be constrained.
  if (pairs.massless.cols() > 0) W -= pairs.massless * (pairs.massless.transpose() * K * W).eval();
  const MatrixXd K_w = linear::symmetrize(W.transpose() * K * W);
  if (Eigen::LLT<MatrixXd>(K_w).info() == Eigen::Success) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(MatrixXd::Identity(n, n), K_w);
    const VectorXd theta = solver.eigenvalues().reverse();
    pairs.lambda = theta.cwiseInverse();
    pairs.N = W * solver.eigenvectors().rowwise().reverse() * theta.cwiseSqrt().cwiseInverse().asDiagonal();
  } else {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(K_w);
    pairs.lambda = solver.eigenvalues();
    pairs.N = W * solver.eigenvectors();
  }
  return pairs;
}

namespace {

constexpr double kLost = 1e-6;  // part of a flexibility

/// Part of FᵀX = FᵀK⁻¹F that the shapes Y leave out, per column.
VectorXd calc_lost_flexibility(const fe::Model& model, const MatrixXd& Y, const MatrixXd& F, const MatrixXd& X) {
  VectorXd held = VectorXd::Zero(F.cols());
  if (Y.cols() > 0) {
    const MatrixXd YF = Y.transpose() * F;
    const Eigen::LDLT<MatrixXd> K(
        linear::symmetrize(linear::calc_inner_products(Y, fe::calc_stiffness_times(model, Y))));
    held = YF.cwiseProduct(K.solve(YF)).colwise().sum();
  }
  const VectorXd whole = F.cwiseProduct(X).colwise().sum();
  return (whole.array() > 0).select(1 - held.array() / whole.array(), 0.0);
}

/// Returns per load whether the supports hold it whole (a moment on a motion without mass and strain, a load on the
/// interface): the forces K X of its static solution are less than kHeldLoad of it. A moment counts as a force at the
/// size of the model, a load of scalar points by itself: the units do not matter.
std::vector<bool> find_held_loads(const fe::Model& model, const MatrixXd& F, const MatrixXd& X) {
  const auto kinds = fe::list_row_kinds(model);
  const double size = fe::calc_model_size(model), moment = size > 0 ? 1 / (size * size) : 1;
  // Squares of the loads of grids, and of those of scalar points.
  const auto sum_squares = [&](const Eigen::Ref<const VectorXd>& loads) {
    std::array<double, 2> sum{};
    for (Eigen::Index i = 0; i < loads.size(); ++i) {
      const auto kind = kinds[static_cast<std::size_t>(i)];
      sum[kind == linear::RowKind::Scalar] += (kind == linear::RowKind::Rotation ? moment : 1) * loads[i] * loads[i];
    }
    return sum;
  };
  const MatrixXd given = model.T().transpose() * F;
  const MatrixXd carried = model.T().transpose() * fe::calc_stiffness_times(model, X);
  std::vector<bool> is_held;
  for (Eigen::Index c = 0; c < F.cols(); ++c) {
    const auto whole = sum_squares(given.col(c)), part = sum_squares(carried.col(c));
    const auto is_small = [&](std::size_t k) {
      return whole[k] == 0 || part[k] <= detail::kHeldLoad * detail::kHeldLoad * whole[k];
    };
    is_held.push_back(is_small(0) && is_small(1));
  }
  return is_held;
}

/// M-norms at which a static solution X of F is round-off: a frequency 1e11 times the lowest of all, or one of a load
/// that the support holds. Such a vector, of unit mass, would be anything: a twist of any size, which has no mass.
/// \param held  find_held_loads
VectorXd calc_least_norms(const fe::Model& model, const MatrixXd& kept, const MatrixXd& F, const MatrixXd& X,
                          const VectorXd& norm, const std::vector<bool>& held) {
  const VectorXd flexibility = F.cwiseProduct(X).colwise().sum();
  double longest = 0;  // 1/ω²
  if (kept.cols() > 0) {
    const double lambda = kept.col(0).dot(VectorXd(fe::calc_stiffness_times(model, kept.col(0))));
    if (lambda > 0) longest = 1 / lambda;
  }
  const auto is_held = [&](Eigen::Index i) { return !(flexibility(i) > 0) || held[static_cast<std::size_t>(i)]; };
  for (Eigen::Index i = 0; i < F.cols(); ++i)
    if (!is_held(i)) longest = std::max(longest, norm(i) * norm(i) / flexibility(i));
  VectorXd min_norm(F.cols());
  for (Eigen::Index i = 0; i < F.cols(); ++i)
    min_norm(i) = is_held(i) ? HUGE_VAL : detail::kResidualRoundoff * std::sqrt(longest * flexibility(i));
  return min_norm;
}

/// Returns true if no grid and no scalar point has a force: a force moves the mass of its grid, which a large mass that
/// drives a base can exceed by any factor.
bool is_moment(const fe::Model& model, const Eigen::Ref<const VectorXd>& F) {
  return std::all_of(model.nodes().begin(), model.nodes().end(), [&](const fe::Node& node) {
    return F.segment(node.first_gdof, std::min(node.num_dofs, 3)).isZero(0);
  });
}

}  // namespace

MatrixXd equilibrate(const fe::Model& model, const MatrixXd& rigid, MatrixXd F) {
  if (rigid.cols() == 0 || F.cols() == 0) return F;
  const MatrixXd M_R = fe::calc_mass_times(model, model.mass_kind(), rigid);
  for (int pass = 0; pass < 2; ++pass) F -= M_R * (rigid.transpose() * F).eval();
  return F;
}

ResidualVectors calc_residual_vectors(const fe::Model& model, const StaticSolve& solve, const MatrixXd& rigid,
                                      const MatrixXd& kept, const MatrixXd& F) {
  const auto times_M = [&](const MatrixXd& X) { return fe::calc_mass_times(model, model.mass_kind(), X); };
  const auto m = F.cols();
  ResidualVectors result;
  result.modes = {VectorXd(0), MatrixXd(F.rows(), 0)};
  result.share.resize(m, 0);
  if (m == 0) return result;

  const MatrixXd F_e = equilibrate(model, rigid, F);
  MatrixXd X = solve(F_e);
  if (rigid.cols() > 0) X -= rigid * (rigid.transpose() * times_M(X));
  const MatrixXd X_static = X;
  const VectorXd before = X.cwiseProduct(times_M(X)).colwise().sum().cwiseMax(0).cwiseSqrt();
  const auto is_held = find_held_loads(model, F_e, X);
  const VectorXd min_norm = calc_least_norms(model, kept, F_e, X, before, is_held);

  MatrixXd Q(F.rows(), rigid.cols() + kept.cols());
  Q << rigid, kept;
  std::vector<int> used, balanced;
  for (int i = 0; i < m; ++i) used.push_back(i);
  for (int pass = 0; pass < 2; ++pass) {
    if (Q.cols() > 0) X -= Q * (times_M(Q).transpose() * X).eval();
    MatrixXd MX = times_M(X);
    for (std::size_t i = 0; i < used.size(); ++i) {
      const auto c = static_cast<Eigen::Index>(i);
      for (Eigen::Index b = 0; b < c; ++b) {
        const double along = X.col(b).dot(MX.col(c));
        X.col(c) -= along * X.col(b);
        MX.col(c) -= along * MX.col(b);
      }
      const double norm = std::sqrt(std::max(X.col(c).dot(MX.col(c)), 0.0));
      // A load that inertia balances of itself (a uniform acceleration) leaves roundoff only.
      const bool is_balanced = F_e.col(used[i]).norm() < detail::kBalancedLoad * F.col(used[i]).norm();
      const double moved = F_e.col(used[i]).dot(X.col(c)) / norm, carried = (rigid.transpose() * F.col(used[i])).norm();
      const bool is_massless = carried > 0 && std::sqrt(detail::kMasslessVector) * std::abs(moved) > carried &&
                               is_moment(model, F.col(used[i]));
      if (pass == 0 && (is_balanced || is_massless ||
                        !(norm > std::max(detail::kDependentResidual * before(used[i]), min_norm(used[i]))))) {
        X.col(c).setZero();
        MX.col(c).setZero();
        (is_balanced ? balanced : result.unused).push_back(used[i]);
        continue;
      }
      X.col(c) /= norm;
      MX.col(c) /= norm;
    }
    if (pass > 0) break;
    std::vector<int> rest;
    for (const int i : used)
      if (!(X.col(i).isZero(0))) rest.push_back(i);
    X = X(Eigen::all, rest).eval();
    used = rest;
  }

  if (!result.unused.empty()) {
    MatrixXd Y(F.rows(), kept.cols() + X.cols());
    Y << kept, X;
    const VectorXd lost =
        calc_lost_flexibility(model, Y, F_e(Eigen::all, result.unused), X_static(Eigen::all, result.unused));
    std::vector<int> held = balanced;
    for (std::size_t i = 0; i < result.unused.size(); ++i) {
      const double part = lost(static_cast<Eigen::Index>(i));
      if (part > kLost && !is_held[static_cast<std::size_t>(result.unused[i])])
        result.massless.emplace_back(result.unused[i], part);
      else
        held.push_back(result.unused[i]);
    }
    result.unused = held;
  } else {
    result.unused = balanced;
  }
  std::sort(result.unused.begin(), result.unused.end());

  if (used.empty()) return result;
  const MatrixXd K = linear::calc_inner_products(X, fe::calc_stiffness_times(model, X));
  const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(linear::symmetrize(K));
  result.modes.lambda = ritz.eigenvalues();
  result.modes.Phi = X * ritz.eigenvectors();
  detail::fix_signs(result.modes.Phi);
  result.share = MatrixXd::Zero(m, static_cast<Eigen::Index>(used.size()));
  result.share(used, Eigen::all) = ritz.eigenvectors().cwiseAbs2();
  return result;
}

}  // namespace bough::modal::bases
