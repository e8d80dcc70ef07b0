#include "modal/complex/complex_solver.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>

#include "base/diagnostic.hpp"
#include "modal/complex/schur.hpp"

namespace bough::modal::complex_modes {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRitzTolerance = 1e-12;
/// A solution to a random load this much larger than the pencil's scale: Q(σ) is singular to round-off.
constexpr double kSingularGrowth = 1e14;
/// Residual above which a pair is one of the infinite eigenvalues of a singular mass matrix.
constexpr double kNoPair = 1e-4;
/// Round-off makes infinite eigenvalues finite, of this θ relative to the largest. Residuals of pairs that far from the
/// shift are small, for λ² M and λ B are large.
constexpr double kFar = 1e-5, kMaxFarResidual = 1e-8;
/// Residual above which a shape is refined.
constexpr double kRefined = 1e-11;
constexpr double kMaxResidual = 1e-5;  ///< as of real modes: above the round-off of K x of soft modes
constexpr double kSameEigenvalue = 1e-6;
constexpr double kRealPart = 1e-7;  ///< eigenvalues closer to the real axis, relative, are real

/// The pencil in dimensionless unknowns, x = S x̂, and time, λ = scale λ̂.
struct ScaledPencil {
  QuadraticPencil pencil;
  VectorXd S;
  double scale = 1;
};

VectorXd calc_sizes(const QuadraticPencil& pencil, double scale) {
  VectorXd diagonal = VectorXd::Zero(pencil.size()), largest = diagonal;
  double factor = 1;
  for (const auto* A : {&pencil.K, &pencil.B, &pencil.M}) {
    for (Index row = 0; row < A->outerSize(); ++row)
      for (ComplexSparse::InnerIterator it(*A, row); it; ++it) {
        const double size = factor * std::abs(it.value());
        if (it.col() == row) diagonal(row) = std::max(diagonal(row), size);
        largest(row) = std::max(largest(row), size);
        largest(it.col()) = std::max(largest(it.col()), size);
      }
    factor *= scale;
  }
  const double all = std::max(largest.maxCoeff(), 1e-300);
  for (Index i = 0; i < diagonal.size(); ++i) {
    if (!(diagonal(i) > 1e-8 * largest(i))) diagonal(i) = largest(i);
    if (!(diagonal(i) > 1e-30 * all)) diagonal(i) = all;
  }
  return diagonal;
}

ScaledPencil scale_pencil(const QuadraticPencil& pencil, double scale) {
  ScaledPencil scaled{pencil, calc_sizes(pencil, scale).cwiseSqrt().cwiseInverse(), scale};
  double factor = 1;
  for (auto* A : {&scaled.pencil.K, &scaled.pencil.B, &scaled.pencil.M}) {
    for (Index row = 0; row < A->outerSize(); ++row)
      for (ComplexSparse::InnerIterator it(*A, row); it; ++it)
        it.valueRef() *= factor * scaled.S(row) * scaled.S(it.col());
    factor *= scale;
  }
  return scaled;
}

VectorXcd make_random(Index n, unsigned seed) {
  std::mt19937 random(seed);
  VectorXcd x(n);
  for (auto& value : x) value = static_cast<double>(random()) / 4294967296.0 - 0.5;
  return x;
}

/// (A - σ E)⁻¹ E of the linearization A = [0 I; -K -B], E = [I 0; 0 M] on [x; λ x]: eigenvalues 1 / (λ - σ). If
/// `transposed`, of the pencil with transposed matrices, by the same factor.
class ShiftedOperator {
 public:
  ShiftedOperator(const QuadraticPencil& pencil, Complex sigma, const linear::ComplexLu& factor, bool transposed)
      : M_(pencil.M), B_sigma_(pencil.B + sigma * pencil.M), sigma_(sigma), factor_(factor), transposed_(transposed) {
    if (!transposed) return;
    M_ = ComplexSparse(M_.transpose());
    B_sigma_ = ComplexSparse(B_sigma_.transpose());
  }

  /// Columns of W are [x; λ x].
  MatrixXcd apply(const Eigen::Ref<const MatrixXcd>& W) const {
    const Index n = M_.rows();
    const MatrixXcd right = -(M_ * W.bottomRows(n) + B_sigma_ * W.topRows(n));
    MatrixXcd result(2 * n, W.cols());
    result.topRows(n) = factor_.solve(right, transposed_);
    result.bottomRows(n) = W.topRows(n) + sigma_ * result.topRows(n);
    return result;
  }
  Index size() const { return 2 * M_.rows(); }

 private:
  ComplexSparse M_, B_sigma_;
  Complex sigma_;
  const linear::ComplexLu& factor_;
  bool transposed_;
};

struct RitzPairs {
  VectorXcd theta;
  MatrixXcd W;
  int num_applied = 0;
};

RitzPairs solve_dense(const ShiftedOperator& op) {
  const auto form = calc_schur(op.apply(MatrixXcd::Identity(op.size(), op.size())));
  RitzPairs pairs;
  pairs.theta = form.T.diagonal();
  pairs.W = form.Z * calc_triangular_vectors(form.T, form.T.rows());
  pairs.num_applied = static_cast<int>(op.size());
  return pairs;
}

/// Krylov-Schur (Stewart, SIAM J. Matrix Anal. Appl. 23 (2001) 601): thick restarts until `is_enough` accepts the
/// leading converged eigenvalues θ.
RitzPairs solve_krylov(const ShiftedOperator& op, int num_wanted, int max_restarts,
                       const std::function<bool(const VectorXcd&)>& is_enough) {
  const Index size = op.size();
  Index m = std::min<Index>(size, std::max(2 * num_wanted + 10, num_wanted + 40));
  MatrixXcd V(size, m + 1), H = MatrixXcd::Zero(m + 1, m);
  // Two applications remove what lies in the null space of the mass matrix.
  VectorXcd start = op.apply(op.apply(make_random(size, 7)));
  V.col(0) = start / start.norm();
  RitzPairs pairs;
  pairs.num_applied = 2;
  Index kept = 0;
  for (int restart = 0; restart < max_restarts; ++restart) {
    for (Index j = kept; j < m; ++j) {
      VectorXcd w = op.apply(V.col(j));
      ++pairs.num_applied;
      const double before = w.norm();
      for (int pass = 0; pass < 2; ++pass) {
        const VectorXcd h = V.leftCols(j + 1).adjoint() * w;
        w.noalias() -= V.leftCols(j + 1) * h;
        H.col(j).head(j + 1) += h;
      }
      double length = w.norm();
      if (!(length > 1e-14 * before)) {  // an invariant subspace: continues with another direction
        w = make_random(size, 11 + static_cast<unsigned>(j));
        for (int pass = 0; pass < 2; ++pass)
          w.noalias() -= V.leftCols(j + 1) * (V.leftCols(j + 1).adjoint() * w).eval();
        V.col(j + 1) = w.normalized();
        length = 0;
      } else {
        V.col(j + 1) = w / length;
      }
      H(j + 1, j) = length;
    }
    const auto form = calc_schur(H.topRows(m));
    const Eigen::RowVectorXcd coupling = H.row(m) * form.Z;
    const MatrixXcd Y = calc_triangular_vectors(form.T, m);
    Index converged = 0;
    while (converged < m &&
           std::abs((coupling * Y.col(converged)).value()) <= kRitzTolerance * std::abs(form.T(converged, converged)))
      ++converged;
    const VectorXcd theta = form.T.diagonal();
    const bool is_done = is_enough(theta.head(converged)) || m == size;
    if (is_done || restart + 1 == max_restarts) {
      const Index count = m == size ? m : converged;
      pairs.theta = theta.head(count);
      pairs.W = V.leftCols(m) * (form.Z * Y.leftCols(count));
      if (is_done) return pairs;
      break;
    }
    // Eigenvalues that are not wanted (real, or mirrored) may fill the subspace: it grows with them.
    if (converged > m / 2 && m < size) {
      const Index larger = std::min(size, m + std::max<Index>(m / 2, 20));
      V.conservativeResize(Eigen::NoChange, larger + 1);
      V.col(larger) = V.col(m);
      const Index old = std::exchange(m, larger);
      kept = std::min(old - 1, converged + (old - converged) / 2);
      const MatrixXcd W = V.leftCols(old) * form.Z.leftCols(kept);
      V.leftCols(kept) = W;
      V.col(kept) = V.col(larger);
    } else {
      kept = std::min(m - 1, converged + (m - converged) / 2);
      const MatrixXcd W = V.leftCols(m) * form.Z.leftCols(kept);
      V.leftCols(kept) = W;
      V.col(kept) = V.col(m);
    }
    H = MatrixXcd::Zero(m + 1, m);
    H.topLeftCorner(kept, kept) = form.T.topLeftCorner(kept, kept);
    H.row(kept).head(kept) = coupling.head(kept);
  }
  throw ComputationError("modal.complex-convergence", {},
                         "only " + std::to_string(pairs.theta.size()) + " complex eigenvalues converged",
                         "give a shift near the wanted eigenvalues on EIGC, or ask for fewer modes");
}

/// A factor at the first shift at which the pencil is regular; `sigma` is that shift.
std::unique_ptr<linear::ComplexLu> factor_pencil(const ScaledPencil& scaled, const std::vector<Complex>& shifts,
                                                 Complex& sigma,
                                                 const std::function<std::string(Index)>& name_unknown) {
  const Index n = scaled.pencil.size();
  const VectorXcd probe = make_random(n, 20);
  Index worst = -1;
  for (const Complex shift : shifts) {
    sigma = shift / scaled.scale;
    const auto Q = scaled.pencil.calc_matrix(sigma);
    auto factor = std::make_unique<linear::ComplexLu>(Q, scaled.pencil.is_symmetric);
    if (factor->is_singular()) continue;
    const VectorXcd x = factor->solve(probe);
    if (x.allFinite() && x.norm() < kSingularGrowth * probe.norm()) return factor;
    if (x.allFinite()) x.cwiseAbs().maxCoeff(&worst);
  }
  if (worst < 0) {  // exact zero pivots: an empty row names the unknown
    VectorXd sums = VectorXd::Zero(n);
    const auto Q = scaled.pencil.calc_matrix(Complex(0.3, 0.7));
    for (Index row = 0; row < n; ++row)
      for (ComplexSparse::InnerIterator it(Q, row); it; ++it) sums(row) += std::abs(it.value());
    sums.minCoeff(&worst);
  }
  throw ComputationError("modal.singular-pencil", {},
                         "the matrix λ² M + λ B + K is singular at every λ; " + name_unknown(worst) + " moves freely",
                         "give this dof stiffness, damping or mass, or constrain it");
}

bool is_oscillatory(Complex lambda) { return lambda.imag() > kRealPart * std::abs(lambda); }

/// At λ = 0 the three terms vanish together: returns K x relative to the diagonal, which is 1 in the scaled pencil.
double calc_residual(const QuadraticPencil& pencil, Complex lambda, const VectorXcd& x) {
  if (lambda == 0.0) return (pencil.K * x).norm() / x.norm();
  const VectorXcd k = pencil.K * x, b = lambda * (pencil.B * x), m = lambda * lambda * (pencil.M * x);
  const double size = k.norm() + b.norm() + m.norm();
  return size > 0 ? (k + b + m).norm() / size : 0;
}

/// x = -Q(σ)⁻¹ (λ - σ) (B + (λ + σ) M) x holds for a pair. From an approximate shape it removes the part of eigenvalues
/// farther from σ: round-off of a Schur form in stiff shapes, of which a soft one has large forces. Returns the
/// residual and leaves shapes that do not gain.
double refine_shape(const QuadraticPencil& pencil, const linear::ComplexLu& factor, Complex sigma, Complex lambda,
                    Eigen::Ref<VectorXcd> x) {
  double residual = calc_residual(pencil, lambda, x);
  for (int pass = 0; pass < 2 && residual > kRefined; ++pass) {
    const VectorXcd right = (sigma - lambda) * (pencil.B * x + (lambda + sigma) * (pencil.M * x));
    VectorXcd trial = factor.solve(right);
    trial.normalize();
    const double of_trial = calc_residual(pencil, lambda, trial);
    if (!(of_trial < residual)) break;
    x = trial;
    residual = of_trial;
  }
  return residual;
}

/// Left vectors in the order of `pairs`: those of the transposed pencil with the same eigenvalue.
MatrixXcd match_left(const ComplexPairs& pairs, const RitzPairs& left, Complex sigma) {
  const Index n = pairs.X.rows();
  MatrixXcd Y = MatrixXcd::Zero(n, pairs.lambda.size());
  std::vector<bool> is_used(static_cast<std::size_t>(left.theta.size()), false);
  for (Index j = 0; j < pairs.lambda.size(); ++j) {
    Index best = -1;
    double distance = 0;
    for (Index k = 0; k < left.theta.size(); ++k) {
      if (is_used[static_cast<std::size_t>(k)] || left.theta(k) == 0.0) continue;
      const double d = std::abs(sigma + 1.0 / left.theta(k) - pairs.lambda(j));
      if (best >= 0 && d >= distance) continue;
      best = k;
      distance = d;
    }
    if (best < 0) continue;
    is_used[static_cast<std::size_t>(best)] = true;
    Y.col(j) = left.W.col(best).head(n);
  }
  return Y;
}

double calc_biorthogonality(const QuadraticPencil& pencil, const ComplexPairs& pairs) {
  const Index m = pairs.lambda.size();
  if (m < 2) return 0;
  const MatrixXcd M = pairs.Y.transpose() * (pencil.M * pairs.X), B = pairs.Y.transpose() * (pencil.B * pairs.X);
  const double largest = pairs.lambda.cwiseAbs().maxCoeff();
  double worst = 0;
  const auto term = [&](Index i, Index j) { return std::abs((pairs.lambda(i) + pairs.lambda(j)) * M(i, j) + B(i, j)); };
  for (Index i = 0; i < m; ++i)
    for (Index j = 0; j < m; ++j) {
      if (i == j || std::abs(pairs.lambda(i) - pairs.lambda(j)) < kSameEigenvalue * largest) continue;
      const double size = std::sqrt(term(i, i) * term(j, j));
      if (size > 0) worst = std::max(worst, term(i, j) / size);
    }
  return worst;
}

/// The pairs with Im λ ≥ 0 in their order; `lambda` in the units of the scaled pencil.
ComplexPairs choose_pairs(const ScaledPencil& scaled, const RitzPairs& ritz, Complex sigma,
                          const linear::ComplexLu& factor, const SolverOptions& options) {
  const Index n = scaled.pencil.size();
  ComplexPairs pairs;
  struct Item {
    Complex lambda;
    VectorXcd x;
    double residual;
  };
  std::vector<Item> items;
  const double largest = ritz.theta.size() > 0 ? ritz.theta.cwiseAbs().maxCoeff() : 0;
  for (Index j = 0; j < ritz.theta.size(); ++j) {
    if (!(std::abs(ritz.theta(j)) > 1e-15 * largest)) continue;
    Complex lambda = sigma + 1.0 / ritz.theta(j);
    VectorXcd x = ritz.W.col(j).head(n);
    if (std::abs(lambda) * scaled.scale < options.zero) lambda = 0;
    const double residual = refine_shape(scaled.pencil, factor, sigma, lambda, x);
    if (residual > (std::abs(ritz.theta(j)) > kFar * largest ? kNoPair : kMaxFarResidual)) continue;
    if (std::abs(lambda.imag()) <= kRealPart * std::abs(lambda)) lambda.imag(0);
    if (lambda.imag() < 0) {
      ++pairs.num_mirrored;
      continue;
    }
    items.push_back({lambda, std::move(x), residual});
  }
  // |Im λ| of multiple eigenvalues differs in round-off only.
  std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    if (std::abs(a.lambda.imag() - b.lambda.imag()) > 1e-11 * (a.lambda.imag() + b.lambda.imag()))
      return a.lambda.imag() < b.lambda.imag();
    return a.lambda.real() > b.lambda.real();
  });
  if (options.num_modes > 0) {
    // The nearest to the shift, as many oscillating ones as wanted; real ones no farther than these.
    std::vector<double> distances;
    for (const auto& item : items)
      if (is_oscillatory(item.lambda)) distances.push_back(std::abs(item.lambda - sigma));
    std::sort(distances.begin(), distances.end());
    if (distances.size() > static_cast<std::size_t>(options.num_modes)) {
      const double farthest = distances[static_cast<std::size_t>(options.num_modes) - 1] * (1 + 1e-12);
      std::erase_if(items, [&](const Item& item) { return std::abs(item.lambda - sigma) > farthest; });
      // A multiple eigenvalue at that distance is cut to the number.
      auto surplus =
          std::count_if(items.begin(), items.end(), [](const Item& item) { return is_oscillatory(item.lambda); }) -
          options.num_modes;
      std::erase_if(items, [&](const Item& item) {
        return is_oscillatory(item.lambda) && std::abs(item.lambda - sigma) > farthest * (1 - 1e-9) && surplus-- > 0;
      });
    }
  }
  const auto m = static_cast<Index>(items.size());
  pairs.lambda.resize(m);
  pairs.residual.resize(m);
  pairs.X.resize(n, m);
  for (Index j = 0; j < m; ++j) {
    const auto& item = items[static_cast<std::size_t>(j)];
    pairs.lambda(j) = item.lambda;
    pairs.residual(j) = item.residual;
    pairs.X.col(j) = item.x;
  }
  return pairs;
}

}  // namespace

ComplexPairs solve_pencil(const QuadraticPencil& pencil, const SolverOptions& options,
                          const std::function<std::string(Index)>& name_unknown) {
  const auto scaled = scale_pencil(pencil, options.scale);
  Complex sigma = 0;
  const auto factor = factor_pencil(scaled, options.shifts, sigma, name_unknown);
  const bool is_dense = pencil.size() <= options.max_dense || options.num_modes == 0;
  const auto is_enough = [&](const VectorXcd& theta) {
    const auto count = std::count_if(theta.begin(), theta.end(), [&](Complex t) {
      const Complex lambda = sigma + 1.0 / t;
      return is_oscillatory(lambda) && std::abs(lambda) * scaled.scale >= options.zero;
    });
    return count >= options.num_modes + 1;
  };
  const auto solve = [&](bool transposed) {
    const ShiftedOperator op(scaled.pencil, sigma, *factor, transposed);
    return is_dense ? solve_dense(op) : solve_krylov(op, 2 * options.num_modes + 2, options.max_restarts, is_enough);
  };
  const auto ritz = solve(false);
  auto pairs = choose_pairs(scaled, ritz, sigma, *factor, options);
  pairs.num_iterations = ritz.num_applied;
  if (pairs.residual.size() > 0 && pairs.residual.maxCoeff() > kMaxResidual)
    throw ComputationError("modal.complex-convergence", {},
                           "a pair of complex eigenvalue and shape leaves a residual above 1e-5",
                           "give EIGC a shift nearer to the wanted eigenvalues; look for terms of extreme size");
  if (pencil.is_symmetric) {
    pairs.Y = pairs.X;
  } else {
    const auto left = solve(true);
    pairs.num_iterations += left.num_applied;
    pairs.Y = match_left(pairs, left, sigma);
  }
  pairs.biorthogonality = calc_biorthogonality(scaled.pencil, pairs);
  pairs.X = scaled.S.asDiagonal() * pairs.X;
  pairs.Y = scaled.S.asDiagonal() * pairs.Y;
  pairs.lambda *= scaled.scale;
  pairs.shift = sigma * scaled.scale;
  pairs.is_dense = is_dense;
  pairs.num_entries = factor->num_entries();
  return pairs;
}

}  // namespace bough::modal::complex_modes
