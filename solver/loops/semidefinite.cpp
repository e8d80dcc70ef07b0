#include "solver/loops/semidefinite.hpp"

#include <cmath>
#include <numeric>

namespace bough::solver {

void SemidefiniteFactor::resize(int size) {
  L_ = R_ = MatrixXd::Zero(size, size);
  scale_ = x_ = y_ = VectorXd::Zero(size);
  order_.resize(static_cast<size_t>(size));
  rank_ = 0;
}

void SemidefiniteFactor::compute(const MatrixXd& A) {
  const int n = size();
  const double largest = n > 0 ? A.diagonal().maxCoeff() : 0;
  for (int i = 0; i < n; ++i) scale_[i] = A(i, i) > 1e-24 * largest ? 1 / std::sqrt(A(i, i)) : 0;
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) L_(i, j) = scale_[i] * A(i, j) * scale_[j];
  }
  std::iota(order_.begin(), order_.end(), 0);
  for (rank_ = 0; rank_ < n; ++rank_) {
    const int k = rank_;
    int pivot = k;
    for (int i = k + 1; i < n; ++i) {
      if (L_(i, i) > L_(pivot, pivot)) pivot = i;
    }
    if (!(L_(pivot, pivot) > kLeastShare)) break;
    if (pivot != k) {  // exchange rows and columns of the lower triangle
      std::swap(order_[static_cast<size_t>(k)], order_[static_cast<size_t>(pivot)]);
      for (int j = 0; j < k; ++j) std::swap(L_(k, j), L_(pivot, j));
      for (int i = k + 1; i < pivot; ++i) std::swap(L_(i, k), L_(pivot, i));
      for (int i = pivot + 1; i < n; ++i) std::swap(L_(i, k), L_(i, pivot));
      std::swap(L_(k, k), L_(pivot, pivot));
    }
    L_(k, k) = std::sqrt(L_(k, k));
    for (int i = k + 1; i < n; ++i) L_(i, k) /= L_(k, k);
    for (int j = k + 1; j < n; ++j) {
      for (int i = j; i < n; ++i) L_(i, j) -= L_(i, k) * L_(j, k);
    }
  }
  if (rank_ < n) orthogonalize();
}

// Gram and Schmidt's way, twice.
void SemidefiniteFactor::orthogonalize() {
  const int n = size();
  R_.setZero();
  for (int j = 0; j < rank_; ++j) {
    L_.col(j).head(j).setZero();
    for (int twice = 0; twice < 2; ++twice) {
      for (int i = 0; i < j; ++i) {
        const double share = L_.col(i).dot(L_.col(j));
        R_(i, j) += share;
        L_.col(j).head(n) -= share * L_.col(i);
      }
    }
    R_(j, j) = L_.col(j).norm();
    L_.col(j) /= R_(j, j);
  }
}

void SemidefiniteFactor::solve(Eigen::Ref<VectorXd> b) {
  const int n = size(), r = rank_;
  for (int i = 0; i < n; ++i) x_[i] = scale_[order_[static_cast<size_t>(i)]] * b[order_[static_cast<size_t>(i)]];
  if (r == n) {
    for (int i = 0; i < n; ++i) x_[i] = (x_[i] - L_.row(i).head(i).dot(x_.head(i))) / L_(i, i);
    for (int i = n - 1; i >= 0; --i)
      x_[i] = (x_[i] - L_.col(i).segment(i + 1, n - 1 - i).dot(x_.segment(i + 1, n - 1 - i))) / L_(i, i);
  } else {
    for (int j = 0; j < r; ++j) y_[j] = L_.col(j).dot(x_);
    for (int i = r - 1; i >= 0; --i)
      y_[i] = (y_[i] - R_.row(i).segment(i + 1, r - 1 - i).dot(y_.segment(i + 1, r - 1 - i))) / R_(i, i);
    for (int i = 0; i < r; ++i) y_[i] = (y_[i] - R_.col(i).head(i).dot(y_.head(i))) / R_(i, i);
    x_.setZero();
    for (int j = 0; j < r; ++j) x_ += y_[j] * L_.col(j);
  }
  for (int i = 0; i < n; ++i) b[order_[static_cast<size_t>(i)]] = scale_[order_[static_cast<size_t>(i)]] * x_[i];
}

}  // namespace bough::solver
