#include "solver/loops/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "solver/tree/body_sizes.hpp"

namespace bough::solver {

namespace {

constexpr double kClosed = 1e-12;
/// Gaps, relative, up to which the present coordinates of the closing hinges are near: no other start is searched, of
/// which a hinge with free rotations has 27.
constexpr double kNearGap = 1e-3;
constexpr int kMaxSteps = 100, kMaxStarts = 24;
constexpr double kDependent = 1e-8;  // of the largest singular value
/// Factor between the costs of two priorities: a coordinate of the higher one moves only if the others cannot close.
constexpr double kPreference = 1e5;

// The size of a step that counts as 1: a radian, the size of the bodies, a deflection of a hundredth of it or a
// rotation of a hundredth of a radian. A mode in twist has no more than rounding errors of translations.
VectorXd calc_step_sizes(const Tree& tree) {
  const VectorXd sizes = calc_body_sizes(tree);
  const double length = sizes.size() > 0 ? sizes.maxCoeff() : 1;
  VectorXd size = VectorXd::Ones(tree.num_u);
  for (const TreeBody& tb : tree.bodies) {
    VectorXd q = VectorXd::Zero(tb.num_hinge_q());
    tb.hinge->set_neutral(q.data());
    HingeMotion motion;
    tb.hinge->calc_position(q.data(), motion);
    for (int i = 0; i < tb.num_hinge_u(); ++i) {
      if (motion.H.col(i).tail<3>().isZero(0)) size[tb.u_offset + i] = length;
    }
    for (int j = 0; j < tb.num_modes(); ++j) {
      double largest = 0;
      for (const Node& node : tb.body.nodes())
        if (node.is_material) largest = std::max({largest, node.phi.col(j).norm(), length * node.psi.col(j).norm()});
      if (largest > 0) size[tb.eta_dot_offset() + j] = 0.01 * length / largest;
    }
  }
  return size;
}

// Step sizes of the coordinates that may move; zero for the others.
VectorXd mask(const VectorXd& size, const std::vector<AssemblyPriority>& priority, AssemblyPriority last) {
  VectorXd chosen = size;
  for (size_t row = 0; row < priority.size(); ++row) {
    if (priority[row] > last) chosen[static_cast<Eigen::Index>(row)] = 0;
  }
  return chosen;
}

// Step sizes as weights: larger is cheaper.
VectorXd weigh(const VectorXd& size, const std::vector<AssemblyPriority>& priority, AssemblyPriority last) {
  VectorXd chosen = mask(size, priority, last);
  for (size_t row = 0; row < priority.size(); ++row) {
    if (priority[row] < last) chosen[static_cast<Eigen::Index>(row)] *= kPreference;
  }
  return chosen;
}

// x = size · (G size)⁺ b, column by column
MatrixXd solve_least(const MatrixXd& G, const VectorXd& size, const MatrixXd& b) {
  // Nothing can move, or nothing is asked for.
  if (G.size() == 0) return MatrixXd::Zero(size.size(), b.cols());
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> factor;
  factor.setThreshold(kDependent);
  factor.compute(G * size.asDiagonal());
  return size.asDiagonal() * MatrixXd(factor.solve(b));
}

class Positions {
 public:
  Positions(const Loops& loops, const Tree& tree, double t, TreeData& tree_data, LoopData& data)
      : loops_(loops), tree_(tree), t_(t), tree_data_(tree_data), data_(data) {}

  double calc(const VectorXd& q) {
    calc_position(tree_, t_, q, tree_data_);
    calc_closure_positions(loops_, tree_, tree_data_, data_);
    double sum = 0;
    for (const LoopBlock& block : data_.blocks) {
      for (const int i : block.constraints) sum += std::pow(calc_gap(loops_, data_, i), 2);
    }
    return std::sqrt(sum);
  }

  /// Where a pose is far from that of its closing hinge there may be several nearest ones.
  void find_starts(const VectorXd& q) {
    calc_position(tree_, t_, q, tree_data_);
    for (const LoopBlock& block : data_.blocks) {
      for (const int i : block.constraints) {
        const Constraint& c = loops_[i];
        ConstraintData& d = data_[i];
        if (!c.closure) continue;
        calc_relative_position(tree_, tree_data_, c.parent_marker, c.child_marker, d.state, d.relative);
        c.closure->find_start(d.relative.R, d.relative.p, d.state.q.data());
      }
    }
  }

  /// size: of steps; weight: as weigh gives it.
  bool solve(const VectorXd& size, const VectorXd& weight, VectorXd& q) {
    double gap = calc(q);
    for (int i = 0; i < kMaxSteps && gap > 1e-15; ++i) {
      const std::vector<int> rows = list_position_rows(loops_, data_);
      const MatrixXd G = calc_dense_rows(loops_, tree_, tree_data_, data_)(rows, Eigen::all);
      const VectorXd step = solve_least(G, weight, -get_gaps(loops_, data_)(rows));
      double largest = 0;  // in step sizes
      for (Eigen::Index r = 0; r < size.size(); ++r)
        largest = std::max(largest, size[r] > 0 ? std::abs(step[r]) / size[r] : 0);
      double by = std::min(1.0, largest > 0 ? 0.5 / largest : 1.0);
      const LoopData before = data_;
      bool is_better = false;
      for (; by > 1e-6 && !is_better; by /= 2) {
        data_ = before;
        VectorXd moved = q;
        displace(tree_, by * step, moved);
        const double found = calc(moved);
        is_better = found < (1 - 0.1 * by) * gap;
        if (!is_better) continue;
        q = moved;
        gap = found;
      }
      if (!is_better) {
        data_ = before;
        break;
      }
    }
    calc(q);
    return calc_largest_position_error(loops_, data_) <= kClosed;
  }

 private:
  const Loops& loops_;
  const Tree& tree_;
  double t_;
  TreeData& tree_data_;
  LoopData& data_;
};

}  // namespace

Assembly assemble_positions(const Loops& loops, const Tree& tree, double t,
                            const std::vector<AssemblyPriority>& priority, Eigen::Ref<VectorXd> q, TreeData& tree_data,
                            LoopData& data) {
  Positions positions(loops, tree, t, tree_data, data);
  const VectorXd sizes = calc_step_sizes(tree), given = q;
  if (!(positions.calc(given) <= kNearGap)) positions.find_starts(given);
  const LoopData start = data;
  Assembly found;
  VectorXd best = given;
  double min_gap = positions.calc(given);
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> any(-1, 1);
  // A stretched mechanism does not know to which side to bend: the later starts are off a little, then more.
  for (int k = 0; k < kMaxStarts && !found.is_closed; ++k) {
    for (const AssemblyPriority last : {AssemblyPriority::Free, AssemblyPriority::Given, AssemblyPriority::Modal}) {
      if (k > 0 && last == AssemblyPriority::Modal) continue;
      const VectorXd size = mask(sizes, priority, last);
      data = start;
      VectorXd trial = given;
      if (k > 0) {
        const double off = 2.0 * k / kMaxStarts;
        const VectorXd step =
            VectorXd::NullaryExpr(size.size(), [&](Eigen::Index r) { return off * any(engine) * size[r]; });
        displace(tree, mask(step, priority, AssemblyPriority::Given), trial);
        positions.find_starts(trial);
      }
      found.is_closed = positions.solve(size, weigh(sizes, priority, last), trial);
      const double gap = positions.calc(trial);
      if (gap < min_gap || found.is_closed) {
        min_gap = gap;
        best = trial;
      }
      if (found.is_closed) break;
    }
  }
  q = best;
  positions.calc(q);
  found.gap = calc_largest_position_error(loops, data, &found.worst);
  return found;
}

Assembly assemble_rates(const Loops& loops, const Tree& tree, const std::vector<AssemblyPriority>& priority,
                        Eigen::Ref<MatrixXd> u, TreeData& tree_data, LoopData& data) {
  const MatrixXd G = calc_dense_rows(loops, tree, tree_data, data);
  const VectorXd sizes = calc_step_sizes(tree);
  Assembly found;
  // Gaps are relative to the largest rate of the column.
  Eigen::RowVectorXd scale = u.colwise().lpNorm<Eigen::Infinity>().cwiseMax(1e-300);
  if (G.size() > 0) scale *= G.cwiseAbs().maxCoeff();
  const auto judge = [&](const MatrixXd& rates) {
    const VectorXd rows = ((G * rates).cwiseAbs() * scale.cwiseInverse().asDiagonal()).rowwise().maxCoeff();
    Eigen::Index largest = 0;
    found.gap = rows.size() > 0 ? rows.maxCoeff<Eigen::PropagateNaN>(&largest) : 0;
    found.is_closed = found.gap <= kClosed;
    int at = 0;
    for (const LoopBlock& block : data.blocks) {
      for (const int i : block.constraints) {
        if (largest >= at && largest < at + loops[i].num_rows()) found.worst = i;
        at += loops[i].num_rows();
      }
    }
  };
  judge(u);
  for (const AssemblyPriority last : {AssemblyPriority::Free, AssemblyPriority::Given, AssemblyPriority::Modal}) {
    if (found.is_closed) break;
    const VectorXd size = weigh(sizes, priority, last);
    MatrixXd rates = u;
    for (int k = 0; k < 2; ++k) rates += solve_least(G, size, -(G * rates));
    judge(rates);
    if (found.is_closed) u = rates;
  }
  return found;
}

namespace {

// Columns reduced to echelon form: few components each.
void reduce_columns(Matrix6Xd& w) {
  int done = 0;
  for (int r = 0; r < 6 && done < w.cols(); ++r) {
    Eigen::Index pivot = 0;
    if (w.row(r).tail(w.cols() - done).cwiseAbs().maxCoeff(&pivot) < 1e-6) continue;
    w.col(done).swap(w.col(done + pivot));
    w.col(done) /= w(r, done);
    for (int c = 0; c < w.cols(); ++c) {
      if (c != done) w.col(c) -= w(r, c) * Vector6d(w.col(done));
    }
    ++done;
  }
  w = (w.array().abs() < 1e-6).select(0.0, w);
}

}  // namespace

std::vector<Redundancy> find_redundancies(const Loops& loops, const Tree& tree,
                                          const std::vector<AssemblyPriority>& priority, const TreeData& tree_data,
                                          const LoopData& data) {
  const VectorXd size = mask(calc_step_sizes(tree), priority, AssemblyPriority::Modal);
  const MatrixXd G = calc_dense_rows(loops, tree, tree_data, data) * size.asDiagonal();
  std::vector<Redundancy> found;
  MatrixXd basis(tree.num_u, 0);  // of the rows so far, orthonormal
  int at = 0;
  for (const LoopBlock& block : data.blocks) {
    for (const int i : block.constraints) {
      const int n = loops[i].num_rows();
      const MatrixXd own = G.middleRows(at, n);
      at += n;
      MatrixXd rest = own - (own * basis) * basis.transpose();
      rest -= (rest * basis) * basis.transpose();
      Eigen::JacobiSVD<MatrixXd> svd;
      if (rest.cols() == 0) rest = MatrixXd::Zero(n, 1);  // nothing moves: every row is redundant
      svd.compute(rest, Eigen::ComputeFullU | Eigen::ComputeThinV);
      const double largest = own.norm();
      int rank = 0;
      while (rank < svd.singularValues().size() && svd.singularValues()[rank] > kDependent * largest) ++rank;
      basis.conservativeResize(Eigen::NoChange, basis.cols() + rank);
      if (rank > 0) basis.rightCols(rank) = svd.matrixV().leftCols(rank);
      if (rank == n) continue;
      Redundancy r;
      r.constraint = i;
      r.wrenches = Matrix6Xd::Zero(6, n - rank);
      if (loops[i].closure)
        r.wrenches = data[i].own.W.leftCols(n) * svd.matrixU().rightCols(n - rank);
      else
        r.wrenches(0, 0) = 1;
      reduce_columns(r.wrenches);
      found.push_back(std::move(r));
    }
  }
  return found;
}

}  // namespace bough::solver
