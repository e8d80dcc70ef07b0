#include "fe/linear/subdomains.hpp"

#include <metis.h>

#include <algorithm>
#include <functional>
#include <new>
#include <numeric>
#include <utility>

#include "fe/linear/low_rank_sum.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/part_factor.hpp"
#include "fe/linear/ranks.hpp"

namespace bough::fe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rows between, whose dense block every rank holds twice and works on for n³ operations: 256 MB, two seconds.
constexpr PetscInt kMostRowsBetween = 4000;
/// Of all rows, where they are too many to cost nothing.
constexpr double kMostShare = 0.03;
constexpr PetscInt kFewBetween = 1000;

/// The graph of row groups, neighbours without the group itself.
struct GroupGraph {
  std::vector<idx_t> start{0}, neighbours, weight;
  idx_t size() const { return static_cast<idx_t>(weight.size()); }
};

std::vector<int> list_group_of(const std::vector<PetscInt>& group_start) {
  std::vector<int> group_of(static_cast<std::size_t>(group_start.back()));
  for (std::size_t g = 0; g + 1 < group_start.size(); ++g)
    std::fill(group_of.begin() + group_start[g], group_of.begin() + group_start[g + 1], static_cast<int>(g));
  return group_of;
}

/// Concatenated on the first rank.
std::vector<int> collect(const std::vector<int>& own, const MpiWorld& world) {
  const int num = static_cast<int>(own.size());
  std::vector<int> nums(static_cast<std::size_t>(world.size)), starts(nums.size(), 0), all;
  MPI_Gather(&num, 1, MPI_INT, nums.data(), 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (world.rank == 0) {
    std::partial_sum(nums.begin(), nums.end() - 1, starts.begin() + 1);
    all.resize(static_cast<std::size_t>(starts.back() + nums.back()));
  }
  MPI_Gatherv(own.data(), num, MPI_INT, all.data(), nums.data(), starts.data(), MPI_INT, 0, PETSC_COMM_WORLD);
  return all;
}

/// From the rows that each rank holds, on the first; groups begin anew with the rows of a rank.
GroupGraph build_group_graph(Mat A, Mat B, const std::vector<PetscInt>& group_start, const MpiWorld& world) {
  const std::vector<int> group_of = list_group_of(group_start);
  PetscInt first = 0, last = 0, num = 0;
  check_petsc(MatGetOwnershipRange(A, &first, &last));
  const PetscInt* columns = nullptr;
  const int num_groups = static_cast<int>(group_start.size()) - 1;
  std::vector<int> degree, neighbours, mark(static_cast<std::size_t>(num_groups), -1);
  for (int g = 0; g < num_groups; ++g) {
    if (group_start[g] < first || group_start[g] >= last) continue;
    const std::size_t before = neighbours.size();
    mark[g] = g;
    for (PetscInt row = group_start[g]; row < group_start[g + 1]; ++row)
      for (Mat matrix : {A, B}) {
        check_petsc(MatGetRow(matrix, row, &num, &columns, nullptr));
        for (PetscInt k = 0; k < num; ++k)
          if (const int other = group_of[columns[k]]; mark[other] != g) mark[other] = g, neighbours.push_back(other);
        check_petsc(MatRestoreRow(matrix, row, &num, &columns, nullptr));
      }
    degree.push_back(static_cast<int>(neighbours.size() - before));
  }
  degree = collect(degree, world);
  GroupGraph graph;
  graph.neighbours = collect(neighbours, world);
  if (world.rank != 0) return graph;
  for (int g = 0; g < num_groups; ++g) {
    graph.start.push_back(graph.start.back() + degree[g]);
    graph.weight.push_back(group_start[g + 1] - group_start[g]);
  }
  return graph;
}

/// The part of every group, `num_parts` for those between: of an edge between two parts the end in the higher one, so
/// that one line along a cut is enough. Empty where METIS gives none or a part has no inner group.
std::vector<idx_t> cut(GroupGraph& graph, idx_t num_parts) {
  idx_t num = graph.size(), constraints = 1, edges = 0, options[METIS_NOPTIONS];
  std::vector<idx_t> home(static_cast<std::size_t>(num));
  METIS_SetDefaultOptions(options);
  if (num < num_parts || graph.neighbours.empty() ||
      METIS_PartGraphRecursive(&num, &constraints, graph.start.data(), graph.neighbours.data(), graph.weight.data(),
                               nullptr, nullptr, &num_parts, nullptr, nullptr, options, &edges,
                               home.data()) != METIS_OK)
    return {};
  std::vector<idx_t> part = home;
  for (idx_t g = 0; g < num; ++g)
    for (idx_t k = graph.start[g]; k < graph.start[g + 1]; ++k)
      if (home[graph.neighbours[k]] < home[g]) part[g] = num_parts;
  std::vector<char> has_inner(static_cast<std::size_t>(num_parts) + 1, 0);
  for (const idx_t p : part) has_inner[p] = 1;
  if (std::any_of(has_inner.begin(), has_inner.end() - 1, [](char has) { return has == 0; })) return {};
  return part;
}

/// The rows of the groups of this rank's part in the order of a nested dissection.
std::vector<PetscInt> order_inner(const SubdomainMatrix& A, const std::vector<PetscInt>& inner,
                                  const std::vector<int>& group_of) {
  std::vector<idx_t> start{0}, neighbours, weight, first_row;
  std::vector<idx_t> vertex(inner.size());
  for (std::size_t i = 0; i < inner.size(); ++i) {
    if (i == 0 || group_of[inner[i]] != group_of[inner[i - 1]]) weight.push_back(0), first_row.push_back(i);
    ++weight.back();
    vertex[i] = static_cast<idx_t>(weight.size()) - 1;
  }
  std::vector<idx_t> mark(weight.size(), -1);
  for (std::size_t v = 0; v < weight.size(); ++v) {
    mark[v] = static_cast<idx_t>(v);
    for (idx_t i = first_row[v]; i < first_row[v] + weight[v]; ++i)
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(A.rows(), i); entry; ++entry) {
        if (entry.col() >= static_cast<Index>(inner.size())) continue;
        const idx_t other = vertex[static_cast<std::size_t>(entry.col())];
        if (mark[other] != static_cast<idx_t>(v)) mark[other] = static_cast<idx_t>(v), neighbours.push_back(other);
      }
    start.push_back(static_cast<idx_t>(neighbours.size()));
  }
  std::vector<idx_t> rank(weight.size()), inverse(weight.size());
  std::iota(rank.begin(), rank.end(), 0);
  idx_t num = static_cast<idx_t>(weight.size()), options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  if (!neighbours.empty() && METIS_NodeND(&num, start.data(), neighbours.data(), weight.data(), options, rank.data(),
                                          inverse.data()) != METIS_OK)
    std::iota(rank.begin(), rank.end(), 0);
  std::vector<PetscInt> rows;
  for (const idx_t v : rank)
    for (idx_t i = first_row[v]; i < first_row[v] + weight[v]; ++i) rows.push_back(inner[static_cast<std::size_t>(i)]);
  return rows;
}

bool are_all(bool is_fine) {
  int all = is_fine ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  return all == 1;
}

/// What one rank has no memory for ends all of them, with the same words.
void do_on_all(const std::function<void()>& act) {
  std::optional<ComputationError> failure;
  try {
    act();
  } catch (const ComputationError& error) {
    failure = error;
  } catch (const std::bad_alloc&) {
    failure = make_out_of_memory();
  }
  if (!are_all(!failure)) throw failure ? *failure : make_out_of_memory();
}

}  // namespace

MatrixXd Subdomains::take_own(const Eigen::Ref<const MatrixXd>& X) const {
  MatrixXd own(num_own(), X.cols());
  for (Index c = 0; c < X.cols(); ++c)
    for (PetscInt i = 0; i < num_own(); ++i) own(i, c) = X(get_row(i), c);
  return own;
}

MatrixXd Subdomains::replicate(const MatrixXd& own) const {
  MatrixXd X = MatrixXd::Zero(size, own.cols());
  for (Index c = 0; c < own.cols(); ++c)
    for (PetscInt i = 0; i < num_own(); ++i) X(get_row(i), c) = own(i, c);
  sum_over_ranks(X);
  return X;
}

std::optional<Subdomains> find_subdomains(Mat A, Mat B, PetscInt least) {
  const MpiWorld world = initialize_petsc();
  Subdomains result;
  check_petsc(MatGetSize(A, &result.size, nullptr));
  if (world.size == 1 || result.size < least || find_low_rank(A) || find_low_rank(B)) return std::nullopt;
  const std::vector<PetscInt> group_start = get_row_groups(A);
  if (group_start.size() < 2) return std::nullopt;
  const int num_groups = static_cast<int>(group_start.size()) - 1;
  std::vector<idx_t> part;
  {
    GroupGraph graph = build_group_graph(A, B, group_start, world);
    if (world.rank == 0) part = cut(graph, world.size);
  }
  int is_cut = part.empty() ? 0 : 1;
  MPI_Bcast(&is_cut, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (is_cut == 0) return std::nullopt;
  part.resize(static_cast<std::size_t>(num_groups));
  MPI_Bcast(part.data(), num_groups, MPI_INT, 0, PETSC_COMM_WORLD);
  for (int g = 0; g < num_groups; ++g)
    for (PetscInt row = group_start[g]; row < group_start[g + 1]; ++row)
      if (part[g] == world.rank)
        result.inner.push_back(row);
      else if (part[g] == world.size)
        result.between.push_back(row);
  const auto between = static_cast<long long>(result.between.size());
  if (between > kMostRowsBetween || (between > kFewBetween && static_cast<double>(between) > kMostShare * result.size))
    return std::nullopt;
  result.first_shared = static_cast<PetscInt>(between * world.rank / world.size);
  result.num_shared = static_cast<PetscInt>(between * (world.rank + 1) / world.size) - result.first_shared;
  result.inner = order_inner(SubdomainMatrix(A, result), result.inner, list_group_of(group_start));
  return result;
}

SubdomainMatrix::SubdomainMatrix(Mat A, const Subdomains& domains) : domains_(domains) {
  std::vector<PetscInt> rows = domains.inner;
  rows.insert(rows.end(), domains.between.begin(), domains.between.end());
  std::vector<int> order(rows.size()), place(rows.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return rows[a] < rows[b]; });
  std::vector<PetscInt> ascending;
  for (const int i : order) ascending.push_back(rows[i]);
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
  PetscIs wanted;
  const auto n = static_cast<PetscInt>(rows.size());
  check_petsc(ISCreateGeneral(PETSC_COMM_SELF, n, ascending.data(), PETSC_COPY_VALUES, wanted.out()));
  IS is = wanted.get();
  Mat* sub = nullptr;
  check_petsc(MatCreateSubMatrices(A, 1, &is, &is, MAT_INITIAL_MATRIX, &sub));
  rows_.resize(n, n);
  PetscInt num = 0;
  const PetscInt* columns = nullptr;
  const PetscScalar* values = nullptr;
  MatInfo info;
  check_petsc(MatGetInfo(sub[0], MAT_LOCAL, &info));
  rows_.reserve(static_cast<Index>(info.nz_used));
  std::vector<std::pair<int, double>> entries;
  for (PetscInt i = 0; i < n; ++i) {
    check_petsc(MatGetRow(sub[0], place[i], &num, &columns, &values));
    entries.clear();
    for (PetscInt k = 0; k < num; ++k) entries.emplace_back(order[columns[k]], values[k]);
    check_petsc(MatRestoreRow(sub[0], place[i], &num, &columns, &values));
    std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    rows_.startVec(i);
    for (const auto& [column, value] : entries) rows_.insertBack(i, column) = value;
  }
  rows_.finalize();
  check_petsc(MatDestroySubMatrices(1, &sub));
  // Nothing of A couples inner rows of two ranks: each of its entries is with one rank, those of A_ss with all.
  const Index n_p = domains.num_inner(), n_s = domains.num_between();
  const double between = static_cast<double>(rows_.bottomRightCorner(n_s, n_s).eval().nonZeros());
  double held = static_cast<double>(rows_.nonZeros()) - between;
  MPI_Allreduce(MPI_IN_PLACE, &held, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  check_petsc(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
  BOUGH_DEMAND(n_p + n_s == n && held + between == info.nz_used);
}

MatrixXd SubdomainMatrix::multiply(const Eigen::Ref<const MatrixXd>& X) const {
  const Index n_p = domains_.num_inner(), n_s = domains_.num_between(), m = X.cols();
  const Index first = domains_.first_shared, num = domains_.num_shared;
  MatrixXd X_s = MatrixXd::Zero(n_s, m);
  X_s.middleRows(first, num) = X.bottomRows(num);
  sum_over_ranks(X_s);
  MatrixXd Y(n_p + num, m), Y_s(n_s, m);
  const int *start = rows_.outerIndexPtr(), *column = rows_.innerIndexPtr();
  const double* value = rows_.valuePtr();
  constexpr Index kAtOnce = 4;
  for (Index c = 0; c < m; c += kAtOnce) {
    const Index sides = std::min(kAtOnce, m - c);
    const double *x[kAtOnce], *x_s[kAtOnce];
    for (Index r = 0; r < kAtOnce; ++r) {
      x[r] = X.data() + (c + std::min(r, sides - 1)) * X.outerStride();
      x_s[r] = X_s.data() + (c + std::min(r, sides - 1)) * n_s;
    }
    double sum[kAtOnce];
    for (Index i = 0; i < n_p + n_s; ++i) {
      std::fill(sum, sum + kAtOnce, 0.0);
      for (int k = start[i]; k < start[i + 1]; ++k) {
        const Index j = column[k];
        if (j < n_p)
          for (Index r = 0; r < kAtOnce; ++r) sum[r] += value[k] * x[r][j];
        else if (i < n_p || (j - n_p >= first && j - n_p < first + num))  // A_ss is shared out by columns
          for (Index r = 0; r < kAtOnce; ++r) sum[r] += value[k] * x_s[r][j - n_p];
      }
      for (Index r = 0; r < sides; ++r) (i < n_p ? Y(i, c + r) : Y_s(i - n_p, c + r)) = sum[r];
    }
  }
  sum_over_ranks(Y_s);
  Y.bottomRows(num) = Y_s.middleRows(first, num);
  return Y;
}

SubdomainFactor::SubdomainFactor(Mat A, const Subdomains& domains)
    : domains_(domains), part_(std::make_unique<PartFactor>()) {
  const MpiWorld world = initialize_petsc();
  std::vector<PetscInt> own(domains.inner.size()), between(domains.between.size());
  std::iota(own.begin(), own.end(), 0);
  std::iota(between.begin(), between.end(), domains.num_inner());
  VectorXd delta;
  bool is_fine = false;
  {
    const SubdomainMatrix matrix(A, domains);
    const auto& rows = matrix.rows();
    const MatrixRows as_rows{rows.outerIndexPtr(), rows.innerIndexPtr(), rows.valuePtr()};
    do_on_all([&] {
      delta = calc_row_sums(as_rows, between, static_cast<PetscInt>(rows.rows()));
      is_fine = part_->analyse(as_rows, std::move(own), between, delta, world.size);
    });
  }
  if (!are_all(is_fine)) return;
  // Ranks of one machine share its memory.
  double need[2] = {static_cast<double>(domains.num_inner() + domains.num_between()), part_->num_entries()};
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(PETSC_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  MPI_Allreduce(MPI_IN_PLACE, need, 2, MPI_DOUBLE, MPI_SUM, machine);
  MPI_Comm_free(&machine);
  do_on_all([&] {
    release_freed_memory();
    require_memory(need[0], need[1], calc_free_memory());
  });
  do_on_all([&] {
    is_fine = part_->factor();
    if (is_fine) L_ = part_->calc_schur();
  });
  if (!are_all(is_fine)) return;
  sum_alike(L_);
  L_.diagonal() -= world.size * delta;
  is_definite_ = are_all(factor_dense(L_));
}

SubdomainFactor::~SubdomainFactor() = default;

MatrixXd SubdomainFactor::solve(const Eigen::Ref<const MatrixXd>& B) const {
  const Index n_p = domains_.num_inner(), n_s = domains_.num_between();
  const Index first_own = domains_.first_shared, num_own = domains_.num_shared;
  MatrixXd X(B.rows(), B.cols()), carried;
  for (Index first = 0; first < B.cols(); first += kManySides) {
    const Index m = std::min(kManySides, B.cols() - first);
    const auto B_block = B.middleCols(first, m);
    auto X_block = X.middleCols(first, m);
    part_->forward(B_block, carried);
    MatrixXd X_s = -carried.topRows(m).transpose();
    X_s.middleRows(first_own, num_own) += B_block.bottomRows(num_own);
    sum_over_ranks(X_s);
    solve_dense(L_, X_s);
    X_block.bottomRows(num_own) = X_s.middleRows(first_own, num_own);
    MatrixXd x_s = MatrixXd::Zero(carried.rows(), n_s);
    x_s.topRows(m) = X_s.transpose();
    part_->backward(x_s, X_block.topRows(n_p));
  }
  return X;
}

}  // namespace bough::fe
