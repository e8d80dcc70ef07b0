#include "solver/statespace/blocks.hpp"

#include <algorithm>
#include <cmath>

namespace bough::statespace {
namespace {

/// Tarjan's algorithm without recursion: `path` contains the open rows, each with its next neighbour.
class Tarjan {
 public:
  explicit Tarjan(const Eigen::MatrixXd& a)
      : a_(a), n_(static_cast<int>(a.rows())), index_(size(), -1), low_(size(), 0), on_stack_(size(), false) {}

  std::vector<std::vector<int>> find() {
    for (int root = 0; root < n_; ++root) {
      if (index_[at(root)] < 0) visit(root);
    }
    return std::move(blocks_);
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  std::size_t size() const { return static_cast<std::size_t>(n_); }

  void enter(int row) {
    index_[at(row)] = low_[at(row)] = next_++;
    stack_.push_back(row);
    on_stack_[at(row)] = true;
    path_.push_back({row, 0});
  }

  void visit(int root) {
    enter(root);
    while (!path_.empty()) {
      auto& [row, column] = path_.back();
      if (column == n_) {
        leave(row);
        continue;
      }
      const int to = column++, from = row;
      if (to == from || a_(from, to) == 0) continue;
      if (index_[at(to)] < 0)
        enter(to);
      else if (on_stack_[at(to)])
        low_[at(from)] = std::min(low_[at(from)], index_[at(to)]);
    }
  }

  void leave(int row) {
    path_.pop_back();
    if (!path_.empty()) {
      int& low = low_[at(path_.back().first)];
      low = std::min(low, low_[at(row)]);
    }
    if (low_[at(row)] != index_[at(row)]) return;
    blocks_.emplace_back();
    for (int member = -1; member != row;) {
      member = stack_.back();
      stack_.pop_back();
      on_stack_[at(member)] = false;
      blocks_.back().push_back(member);
    }
    std::sort(blocks_.back().begin(), blocks_.back().end());
  }

  const Eigen::MatrixXd& a_;
  int n_, next_ = 0;
  std::vector<int> index_, low_, stack_;
  std::vector<bool> on_stack_;
  std::vector<std::pair<int, int>> path_;
  std::vector<std::vector<int>> blocks_;
};

}  // namespace

std::vector<std::vector<int>> find_blocks(const Eigen::MatrixXd& a) { return Tarjan(a).find(); }

Eigen::VectorXd balance(Eigen::MatrixXd& a) {
  const Eigen::Index n = a.rows();
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n);
  for (bool changed = true; changed;) {
    changed = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double own = std::abs(a(i, i));
      const double row = a.row(i).cwiseAbs().sum() - own, column = a.col(i).cwiseAbs().sum() - own;
      if (!(row > 0) || !(column > 0)) continue;
      const int power = static_cast<int>(std::lround(0.5 * std::log2(row / column)));
      const double by = std::ldexp(1.0, power);
      if (power == 0 || row / by + column * by > 0.95 * (row + column)) continue;
      a.row(i) /= by;
      a.col(i) *= by;
      scale[i] *= by;
      changed = true;
    }
  }
  return scale;
}

}  // namespace bough::statespace
