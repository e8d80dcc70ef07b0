#include "modal/block_lanczos.hpp"
#include "fe/linear/products.hpp"
#include "modal/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "fe/linear/blas.hpp"
#include "fe/linear/threads.hpp"

namespace bough::modal::detail {
namespace {

/// W -= V C.
void subtract(const Eigen::Ref<const MatrixXd>& V, const MatrixXd& C, MatrixXd& W) {
  linear::multiply_dense(false, V, -C, 1, W);
}

/// The first columns of V become V S: a few rows at a time, since a second V would be the largest thing in memory.
void turn(const MatrixXd& S, Eigen::Index size, MatrixXd& V) {
  constexpr Eigen::Index kRows = 1024;
  const auto num_blocks = static_cast<int>((V.rows() + kRows - 1) / kRows);
  linear::do_halves(num_blocks, 20, [&](int from, int to) {
    MatrixXd rows, turned;
    for (Eigen::Index first = from * kRows; first < std::min(to * kRows, V.rows()); first += kRows) {
      const auto count = std::min(kRows, V.rows() - first);
      rows = V.block(first, 0, count, size);
      turned.resize(count, S.cols());
      linear::multiply_dense(false, rows, S, 0, turned);
      V.block(first, 0, count, S.cols()) = turned;
    }
  });
}

class BlockLanczos {
 public:
  explicit BlockLanczos(BlockLanczosProblem problem);
  BlockLanczosResult run();

 private:
  /// Makes W B-orthonormal and B-orthogonal to the basis: W = V C + W_out R. Directions of W that lie in the span of
  /// the basis, by roundoff, are dropped: W may get narrower.
  void orthonormalize(MatrixXd& W, MatrixXd& C, MatrixXd& R);
  /// The principal directions of W, G = WᵀBW, at length one, those up to `floor` left out; B W and R follow. Their
  /// lengths, ascending.
  VectorXd make_unit(const MatrixXd& G, double floor, MatrixXd& W, MatrixXd& B_W, MatrixXd& R);
  /// Takes the last two blocks of the basis off W, from B W too, without a product. \return how long that was.
  double relieve(MatrixXd& W, MatrixXd& B_W, MatrixXd& C) const;
  void append(const MatrixXd& W);
  void expand();
  /// Ritz pairs of the present basis; the number of leading ones that converged.
  int calc_ritz();
  void restart();
  BlockLanczosResult finish(int converged, bool is_done);

  BlockLanczosProblem problem_;
  int width_;                  ///< columns of the start
  MatrixXd V_;                 ///< n x room; the first size_ columns are the basis
  MatrixXd T_;                 ///< Vᵀ B A⁻¹B V, room x room
  MatrixXd R_;                 ///< A⁻¹B V = V T + next_ R_ in the columns of the last block
  MatrixXd next_, B_next_;     ///< the block to append, then the last one, and B times it
  MatrixXd B_before_;          ///< B times the block before
  bool is_recurrent_ = false;  ///< A⁻¹B of the last block has nothing but roundoff of blocks before these two
  int size_ = 0, last_width_ = 0;
  double scale_ = 0;  ///< the largest ‖A⁻¹B v‖ so far: what is small is small next to it
  VectorXd theta_, error_;
  MatrixXd S_;
  int num_solves_ = 0;
};

BlockLanczos::BlockLanczos(BlockLanczosProblem problem)
    : problem_(std::move(problem)), width_(static_cast<int>(problem_.start.cols())) {
  const auto n = problem_.start.rows(), b = problem_.start.cols();
  const Eigen::Index requested = problem_.max_subspace > 0 ? problem_.max_subspace : 2 * problem_.num_wanted + 8 * b;
  const auto room = std::max(requested, problem_.num_wanted + 2 * b) + b;
  V_.resize(n, room);
  T_ = MatrixXd::Zero(room, room);
  // Through A⁻¹B once: a start outside the range of A⁻¹B stays in the vectors where B is singular.
  next_ = problem_.solve(problem_.multiply_operator ? problem_.multiply_operator(problem_.start)
                                                    : problem_.multiply_mass(problem_.start));
  problem_.start.resize(0, 0);
  ++num_solves_;
  MatrixXd C, R;
  orthonormalize(next_, C, R);
  scale_ = 0;
}

VectorXd BlockLanczos::make_unit(const MatrixXd& G, double floor, MatrixXd& W, MatrixXd& B_W, MatrixXd& R) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> gram(linear::symmetrize(G));
  const VectorXd& g = gram.eigenvalues();
  const auto dropped = (g.array() <= floor * floor).count();
  const VectorXd length = g.tail(g.size() - dropped).cwiseSqrt();
  const MatrixXd U = gram.eigenvectors().rightCols(length.size());
  const MatrixXd to_unit = U * length.cwiseInverse().asDiagonal();
  for (MatrixXd* vectors : {&W, &B_W}) {
    turn(to_unit, vectors->cols(), *vectors);
    if (dropped > 0) vectors->conservativeResize(Eigen::NoChange, length.size());
  }
  R = (length.asDiagonal() * U.transpose() * R).eval();
  return length;
}

double BlockLanczos::relieve(MatrixXd& W, MatrixXd& B_W, MatrixXd& C) const {
  const auto b = B_before_.cols(), both = b + B_next_.cols();
  const auto V = V_.middleCols(size_ - both, both);
  const MatrixXd C_near = linear::calc_inner_products(V, B_W);
  subtract(V, C_near, W);
  subtract(B_before_, C_near.topRows(b), B_W);
  subtract(B_next_, C_near.bottomRows(both - b), B_W);
  C.bottomRows(both) = C_near;
  return std::sqrt(C_near.colwise().squaredNorm().maxCoeff());
}

void BlockLanczos::orthonormalize(MatrixXd& W, MatrixXd& C, MatrixXd& R) {
  C = MatrixXd::Zero(size_, W.cols());
  R = MatrixXd::Identity(W.cols(), W.cols());
  MatrixXd B_W = problem_.multiply_mass(W);
  const bool has_known = problem_.deflate.cols() > 0;
  // Vectors that the recurrence couples come first: left in, they would carry errors of the basis into the other
  // directions, which grow by the ratio of both from block to block. Known vectors, whose θ may be much larger, are off
  // before.
  if (is_recurrent_ && has_known) {
    subtract(problem_.deflate, linear::calc_inner_products(problem_.deflate, B_W), W);
    B_W = problem_.multiply_mass(W);
  }
  const double near = is_recurrent_ ? relieve(W, B_W, C) : 0;
  const double max_ratio = is_recurrent_ ? 20 : 2;  // that a pass may subtract
  for (int pass = 0; pass < 5 && W.cols() > 0; ++pass) {
    VectorXd squares =
        VectorXd::Zero(W.cols());  // squared norms of the given W: the projected-out part plus the remainder
    if (has_known) {
      const MatrixXd D = linear::calc_inner_products(problem_.deflate, B_W);
      subtract(problem_.deflate, D, W);
      squares += D.colwise().squaredNorm().transpose();
    }
    const auto V = V_.leftCols(size_);
    const MatrixXd C_pass = linear::calc_inner_products(V, B_W);
    subtract(V, C_pass, W);
    C += C_pass * R;
    B_W.resize(0, 0);  // as large as what comes
    B_W = problem_.multiply_mass(W);
    const MatrixXd G = linear::calc_inner_products(W, B_W);
    squares += C_pass.colwise().squaredNorm().transpose() + G.diagonal();
    const double given = std::sqrt(squares.cwiseAbs().maxCoeff());
    if (pass == 0) scale_ = std::max({scale_, near, given});
    // Lengths: of the operator's result in the first pass, of unit vectors later.
    // Shorter ones are roundoff; scaled to length one, their massless part would dominate.
    const VectorXd length = make_unit(G, pass == 0 ? kDependentBlock * scale_ : kDependentColumn, W, B_W, R);
    if (length.size() == 0) break;
    // Roundoff along the basis has grown by `given` over the shortest column, that of columns among themselves by the
    // square of their ratio.
    if (given > max_ratio * length.minCoeff()) continue;
    if (length.maxCoeff() > 3 * length.minCoeff())
      make_unit(linear::calc_inner_products(W, B_W), kDependentColumn, W, B_W, R);
    break;
  }
  B_before_ = std::move(B_next_);
  B_next_ = std::move(B_W);
}

void BlockLanczos::append(const MatrixXd& W) {
  last_width_ = static_cast<int>(W.cols());
  V_.middleCols(size_, last_width_) = W;
  size_ += last_width_;
}

void BlockLanczos::expand() {
  append(next_);
  next_.resize(0, 0);
  const auto last = V_.middleCols(size_ - last_width_, last_width_);
  MatrixXd W = problem_.solve(problem_.multiply_operator ? problem_.multiply_operator(last) : B_next_);
  ++num_solves_;
  MatrixXd C;
  orthonormalize(W, C, R_);
  const int first = size_ - last_width_;
  T_.block(0, first, size_, last_width_) = C;
  T_.block(first, 0, last_width_, size_) = C.transpose();
  T_.block(first, first, last_width_, last_width_) =
      0.5 * (C.bottomRows(last_width_) + C.bottomRows(last_width_).transpose());
  next_ = std::move(W);
  is_recurrent_ = true;
}

int BlockLanczos::calc_ritz() {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(T_.topLeftCorner(size_, size_));
  const VectorXd& values = ritz.eigenvalues();
  std::vector<int> order(static_cast<std::size_t>(size_));
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) { return problem_.positive_only ? values(i) : std::abs(values(i)); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) > key(b); });
  theta_ = values(order);
  S_ = ritz.eigenvectors()(Eigen::all, order);
  const MatrixXd residual = R_ * S_.bottomRows(last_width_);
  error_ = residual.colwise().norm().transpose().cwiseQuotient(theta_.cwiseAbs());
  const int num_strict = problem_.num_wanted - problem_.num_guard;
  // Roundoff of the largest θ, which after a restart couples all of the basis to what follows.
  const double floor = kResidualFloor * scale_, max_ratio = std::min(kMaxFloor, 1000 * problem_.tolerance);
  int converged = 0;
  for (; converged < size_; ++converged) {
    const double theta = problem_.positive_only ? theta_(converged) : std::abs(theta_(converged));
    if (!(theta > 0)) break;
    const bool is_rough = converged >= num_strict && theta < (1 - kGuardGap) * std::abs(theta_(num_strict - 1));
    const double allowed =
        is_rough ? kGuardResidual * theta : std::max(problem_.tolerance * theta, std::min(floor, max_ratio * theta));
    if (next_.cols() > 0 && residual.col(converged).norm() > allowed) break;
  }
  return converged;
}

void BlockLanczos::restart() {
  // A few more than wanted: those between keep the wanted ones converging.
  const int b = width_;
  const int keep = std::min(size_ - b, problem_.num_wanted + std::max(b, (size_ - problem_.num_wanted) / 3));
  turn(S_.leftCols(keep), size_, V_);
  T_.setZero();
  T_.diagonal().head(keep) = theta_.head(keep);
  size_ = keep;
  is_recurrent_ = false;
}

BlockLanczosResult BlockLanczos::finish(int converged, bool is_done) {
  BlockLanczosResult result;
  const int size = std::min<int>(problem_.num_wanted, size_);
  result.theta = theta_.head(size);
  turn(S_.leftCols(size), size_, V_);
  V_.conservativeResize(Eigen::NoChange, size);
  result.X = std::move(V_);
  result.num_solves = num_solves_;
  result.num_converged = std::min(converged, size);
  result.is_done = is_done;
  return result;
}

BlockLanczosResult BlockLanczos::run() {
  if (next_.cols() == 0) return {VectorXd(0), MatrixXd(V_.rows(), 0), num_solves_, 0, true};  // A⁻¹B is nothing
  const int room = static_cast<int>(V_.cols()) - width_;
  int converged = 0;
  for (int restarts = 0; next_.cols() > 0; ++restarts) {
    int check = 2 * problem_.num_wanted;  // before, the Ritz values tell nothing
    while (size_ + next_.cols() <= room && next_.cols() > 0) {
      expand();
      if (size_ < check && next_.cols() > 0) continue;
      converged = std::min(calc_ritz(), problem_.num_wanted);
      if (problem_.monitor) problem_.monitor(converged, theta_, error_);
      if (converged == problem_.num_wanted || next_.cols() == 0) return finish(problem_.num_wanted, true);
      check = size_ + size_ / 32;
    }
    converged = calc_ritz();
    if (converged >= problem_.num_wanted)
      return finish(converged, true);  // of a basis too small to be looked at before
    if (restarts == problem_.max_restarts) break;
    restart();
  }
  return finish(converged, false);
}

}  // namespace

BlockLanczosResult solve_block_lanczos(BlockLanczosProblem problem) { return BlockLanczos(std::move(problem)).run(); }

}  // namespace bough::modal::detail
