#include "solver/loops/semidefinite.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace bough::solver {
namespace {

constexpr double kNoCoupling = 1e-13;

struct Elimination {  // one step: the eliminated blocks, and the remaining blocks that they couple
  std::vector<int> own;
  std::set<int> others;
};

/// Blocks in an order of least fill (Tinney's scheme 2: the fewest rows first), those with the same rows below
/// together.
std::vector<Elimination> eliminate_symbolically(const std::vector<int>& sizes, std::vector<std::set<int>> meets) {
  const int n = static_cast<int>(sizes.size());
  std::vector<Elimination> nodes;
  std::vector<int> position(static_cast<size_t>(n), -1);
  const auto count = [&](int i) {
    int rows = 0;
    for (const int k : meets[static_cast<size_t>(i)]) rows += sizes[static_cast<size_t>(k)];
    return rows;
  };
  std::set<std::pair<int, int>> queue;
  for (int i = 0; i < n; ++i) queue.insert({count(i), i});
  while (!queue.empty()) {
    const int i = queue.begin()->second;
    queue.erase(queue.begin());
    const std::set<int> others = meets[static_cast<size_t>(i)];
    for (const int k : others) queue.erase({count(k), k});
    for (const int k : others) {
      auto& own = meets[static_cast<size_t>(k)];
      own.insert(others.begin(), others.end());
      own.erase(k);
      own.erase(i);
    }
    for (const int k : others) queue.insert({count(k), k});
    position[static_cast<size_t>(i)] = static_cast<int>(nodes.size());
    nodes.push_back({{i}, others});
  }
  // A node is merged with its parent if the parent's rows contain all of its rows.
  for (size_t a = 0; a < nodes.size(); ++a) {
    if (nodes[a].others.empty()) continue;
    int next = n;
    for (const int k : nodes[a].others) next = std::min(next, position[static_cast<size_t>(k)]);
    Elimination& parent = nodes[static_cast<size_t>(next)];
    std::set<int> rest = nodes[a].others;
    for (const int k : parent.own) rest.erase(k);
    if (rest != parent.others || nodes[a].others.size() != rest.size() + parent.own.size()) continue;
    parent.own.insert(parent.own.end(), nodes[a].own.begin(), nodes[a].own.end());
    for (const int k : nodes[a].own) position[static_cast<size_t>(k)] = next;
    nodes[a].own.clear();
  }
  std::erase_if(nodes, [](const Elimination& node) { return node.own.empty(); });
  return nodes;
}

}  // namespace

void SemidefiniteFactor::arrange(const std::vector<int>& sizes, const std::vector<std::pair<int, int>>& meets) {
  const size_t n = sizes.size();
  std::vector<std::set<int>> graph(n);
  pairs.clear();
  first_.assign(1, 0);
  for (size_t i = 0; i < n; ++i) first_.push_back(first_.back() + sizes[i]);
  for (const auto& [a, b] : meets) {
    graph[static_cast<size_t>(a)].insert(b);
    graph[static_cast<size_t>(b)].insert(a);
  }
  for (int j = 0; j < static_cast<int>(n); ++j) {
    pairs.push_back({j, j, MatrixXd::Zero(sizes[static_cast<size_t>(j)], sizes[static_cast<size_t>(j)])});
    for (const int i : graph[static_cast<size_t>(j)]) {
      if (i > j) pairs.push_back({i, j, MatrixXd::Zero(sizes[static_cast<size_t>(i)], sizes[static_cast<size_t>(j)])});
    }
  }
  const std::vector<Elimination> nodes = eliminate_symbolically(sizes, graph);
  std::vector<int> owner(n);
  for (size_t f = 0; f < nodes.size(); ++f) {
    for (const int i : nodes[f].own) owner[static_cast<size_t>(i)] = static_cast<int>(f);
  }
  fronts_.assign(nodes.size(), {});
  std::vector<std::vector<int>> local(nodes.size(), std::vector<int>(n, -1));  // first local row of a block
  for (size_t f = 0; f < nodes.size(); ++f) {
    Front& front = fronts_[f];
    const auto add = [&](int i) {
      local[f][static_cast<size_t>(i)] = static_cast<int>(front.rows.size());
      for (int k = 0; k < sizes[static_cast<size_t>(i)]; ++k) front.rows.push_back(first_[static_cast<size_t>(i)] + k);
    };
    std::vector<int> own = nodes[f].own;
    std::sort(own.begin(), own.end());
    for (const int i : own) add(i);
    front.num_own = static_cast<int>(front.rows.size());
    for (const int i : nodes[f].others) add(i);
    front.F =
        MatrixXd::Zero(static_cast<Eigen::Index>(front.rows.size()), static_cast<Eigen::Index>(front.rows.size()));
    for (const int i : nodes[f].others) {
      const int at = owner[static_cast<size_t>(i)];
      front.parent = front.parent < 0 ? at : std::min(front.parent, at);
    }
  }
  start_rows_.clear();
  for (size_t f = 0; f < nodes.size(); ++f) {
    Front& front = fronts_[f];
    start_rows_.push_back(front.rows);
    if (front.parent < 0) continue;
    for (const int i : nodes[f].others) {
      for (int k = 0; k < sizes[static_cast<size_t>(i)]; ++k)
        front.to_parent.push_back(local[static_cast<size_t>(front.parent)][static_cast<size_t>(i)] + k);
    }
  }
  places_.clear();
  for (const Pair& pair : pairs) {
    const int f = std::min(owner[static_cast<size_t>(pair.i)], owner[static_cast<size_t>(pair.j)]);
    places_.push_back({f, local[static_cast<size_t>(f)][static_cast<size_t>(pair.i)],
                       local[static_cast<size_t>(f)][static_cast<size_t>(pair.j)]});
  }
  scale_ = x_ = VectorXd::Zero(first_.back());
  is_void_.assign(static_cast<size_t>(first_.back()), false);
  dependent_.reserve(static_cast<size_t>(first_.back()));
  zero_.reserve(static_cast<size_t>(first_.back()));
  rank_ = 0;
}

// A, scaled, into the fronts.
void SemidefiniteFactor::assemble() {
  double largest = 0;
  for (const Pair& pair : pairs) {
    if (pair.i == pair.j && pair.A.size() > 0) largest = std::max(largest, pair.A.diagonal().maxCoeff());
  }
  for (const Pair& pair : pairs) {
    if (pair.i != pair.j) continue;
    for (Eigen::Index k = 0; k < pair.A.rows(); ++k) {
      const Eigen::Index row = first_[static_cast<size_t>(pair.i)] + k;
      const double own = is_void_[static_cast<size_t>(row)] ? 0 : pair.A(k, k);
      scale_[row] = own > 1e-24 * largest ? 1 / std::sqrt(own) : 0;
    }
  }
  for (size_t f = 0; f < fronts_.size(); ++f) {
    fronts_[f].F.setZero();
    std::copy(start_rows_[f].begin(), start_rows_[f].end(), fronts_[f].rows.begin());
  }
  for (size_t p = 0; p < pairs.size(); ++p) {
    const Pair& pair = pairs[p];
    const Place& place = places_[p];
    MatrixXd& F = fronts_[static_cast<size_t>(place.front)].F;
    const int r0 = first_[static_cast<size_t>(pair.i)], c0 = first_[static_cast<size_t>(pair.j)];
    for (Eigen::Index c = 0; c < pair.A.cols(); ++c) {
      for (Eigen::Index r = pair.i == pair.j ? c : 0; r < pair.A.rows(); ++r) {
        const double value = scale_[r0 + r] * pair.A(r, c) * scale_[c0 + c];
        const Eigen::Index a = place.row + r, b = place.column + c;
        F(std::max(a, b), std::min(a, b)) += value;
      }
    }
  }
}

void SemidefiniteFactor::eliminate(Front& front) {
  MatrixXd& F = front.F;
  const Eigen::Index size = F.rows(), n = front.num_own;
  Eigen::Index k = 0;
  for (; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (F(i, i) > F(pivot, pivot)) pivot = i;
    }
    if (!(F(pivot, pivot) > kMinPivot)) break;
    if (pivot != k) {  // exchange rows and columns of the lower triangle
      std::swap(front.rows[static_cast<size_t>(k)], front.rows[static_cast<size_t>(pivot)]);
      for (Eigen::Index j = 0; j < k; ++j) std::swap(F(k, j), F(pivot, j));
      for (Eigen::Index i = k + 1; i < pivot; ++i) std::swap(F(i, k), F(pivot, i));
      for (Eigen::Index i = pivot + 1; i < size; ++i) std::swap(F(i, k), F(i, pivot));
      std::swap(F(k, k), F(pivot, pivot));
    }
    F(k, k) = std::sqrt(F(k, k));
    F.col(k).tail(size - k - 1) /= F(k, k);
    for (Eigen::Index j = k + 1; j < size; ++j) F.col(j).tail(size - j) -= F(j, k) * F.col(k).tail(size - j);
  }
  front.rank = static_cast<int>(k);
  if (front.parent < 0) return;
  MatrixXd& P = fronts_[static_cast<size_t>(front.parent)].F;
  for (Eigen::Index c = 0; c < size - n; ++c) {
    for (Eigen::Index r = c; r < size - n; ++r) {
      const int a = front.to_parent[static_cast<size_t>(r)], b = front.to_parent[static_cast<size_t>(c)];
      P(std::max(a, b), std::min(a, b)) += F(n + r, n + c);
    }
  }
}

void SemidefiniteFactor::compute() {
  assemble();
  rank_ = 0;
  dependent_.clear();
  zero_.clear();
  for (size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    eliminate(front);
    rank_ += front.rank;
    for (int d = front.rank; d < front.num_own; ++d) {
      if (scale_[front.rows[static_cast<size_t>(d)]] == 0 || front.F.row(d).head(front.rank).norm() < kNoCoupling)
        zero_.push_back(front.rows[static_cast<size_t>(d)]);
      else
        dependent_.emplace_back(static_cast<int>(f), d);
    }
  }
  find_null_vectors();
}

// Null vector of each dependent row: 1 in the row, and the response of the eliminated rows.
void SemidefiniteFactor::find_null_vectors() {
  const auto num = static_cast<Eigen::Index>(dependent_.size());
  if (null_.cols() != num || null_.rows() != size()) null_.resize(size(), num);
  if (num == 0) return;
  null_.setZero();
  for (Eigen::Index v = 0; v < num; ++v) {
    const auto [f, d] = dependent_[static_cast<size_t>(v)];
    auto x = null_.col(v);
    x[fronts_[static_cast<size_t>(f)].rows[static_cast<size_t>(d)]] = 1;
    for (int s = f; s >= 0; --s) {
      const Front& front = fronts_[static_cast<size_t>(s)];
      for (int k = front.rank - 1; k >= 0; --k) {
        double sum = 0;
        for (Eigen::Index i = k + 1; i < front.F.rows(); ++i)
          sum += front.F(i, k) * x[front.rows[static_cast<size_t>(i)]];
        x[front.rows[static_cast<size_t>(k)]] = -sum / front.F(k, k);
      }
    }
  }
  share_.resize(num);
  gram_.noalias() = null_.transpose() * null_;
  null_factor_.compute(gram_);
}

void SemidefiniteFactor::remove_null(VectorXd& x) {
  for (const int row : zero_) x[row] = 0;
  if (null_.cols() == 0) return;
  share_.noalias() = null_.transpose() * x;
  null_factor_.solveInPlace(share_);
  x.noalias() -= null_ * share_;
}

void SemidefiniteFactor::solve(Eigen::Ref<VectorXd> b) {
  x_ = scale_.cwiseProduct(b);
  remove_null(x_);
  for (const Front& front : fronts_) {
    for (int k = 0; k < front.rank; ++k) {
      double& own = x_[front.rows[static_cast<size_t>(k)]];
      own /= front.F(k, k);
      for (Eigen::Index i = k + 1; i < front.F.rows(); ++i)
        x_[front.rows[static_cast<size_t>(i)]] -= front.F(i, k) * own;
    }
    for (int d = front.rank; d < front.num_own; ++d) x_[front.rows[static_cast<size_t>(d)]] = 0;
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    for (int k = front->rank - 1; k >= 0; --k) {
      double& own = x_[front->rows[static_cast<size_t>(k)]];
      for (Eigen::Index i = k + 1; i < front->F.rows(); ++i)
        own -= front->F(i, k) * x_[front->rows[static_cast<size_t>(i)]];
      own /= front->F(k, k);
    }
  }
  remove_null(x_);
  b = scale_.cwiseProduct(x_);
}

}  // namespace bough::solver
