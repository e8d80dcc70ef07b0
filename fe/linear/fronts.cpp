#include "fe/linear/fronts.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "fe/linear/dissection.hpp"
#include "fe/linear/memory_need.hpp"
#include "fe/linear/part_fronts.hpp"

namespace bough::linear {
namespace {

using Eigen::MatrixXd;

/// Separator rows (ascending) of the sum, lower triangle.
void add_between(const RowSum& sum, const std::vector<PetscInt>& between, MatrixXd& S) {
  const auto place_of = [&](PetscInt row) -> Eigen::Index {
    const auto at = std::lower_bound(between.begin(), between.end(), row);
    return at != between.end() && *at == row ? at - between.begin() : -1;
  };
  for (std::size_t j = 0; j < between.size(); ++j)
    sum.visit(between[j], [&](PetscInt column, double value) {
      if (const Eigen::Index i = place_of(column); i >= static_cast<Eigen::Index>(j))
        S(i, static_cast<Eigen::Index>(j)) += value;
    });
}

/// The parts that have rows; empty where one couples to rows of the other.
std::vector<PartFronts> analyse(const RowSum& sum, const TwoParts& cut) {
  std::vector<const std::vector<PetscInt>*> own;
  for (const auto* rows : {&cut.first, &cut.second})
    if (!rows->empty()) own.push_back(rows);
  std::vector<PartFronts> parts(own.size());
  std::vector<int> is_analyzed(own.size(), 0);
  do_all(own.size(), [&](std::size_t p) { is_analyzed[p] = parts[p].analyse(sum, *own[p], cut.between); });
  if (std::all_of(is_analyzed.begin(), is_analyzed.end(), [](int one) { return one != 0; })) return parts;
  return {};
}

/// One part: what was cut for A, B may couple.
void join(TwoParts& cut) {
  cut.first.insert(cut.first.end(), cut.second.begin(), cut.second.end());
  cut.first.insert(cut.first.end(), cut.between.begin(), cut.between.end());
  cut.second.clear();
  cut.between.clear();
}

/// -1 where a pivot is too small.
int count_of_sum(const RowSum& sum, TwoParts cut) {
  std::vector<PartFronts> parts = analyse(sum, cut);
  if (parts.empty()) {
    join(cut);
    parts = analyse(sum, cut);
  }
  const std::size_t num = parts.size();
  if (num == 0) return -1;
  double num_numbers = 0;
  for (const PartFronts& part : parts) num_numbers += part.num_numbers();
  require_memory(static_cast<double>(cut.first.size() + cut.second.size() + cut.between.size()), num_numbers,
                 calc_free_memory());

  std::vector<int> result(num, 0);
  std::vector<MatrixXd> schur(num);
  do_all(num, [&](std::size_t p) { result[p] = parts[p].count(schur[p]); });
  if (std::any_of(result.begin(), result.end(), [](int one) { return one < 0; })) return -1;
  const int negative = std::accumulate(result.begin(), result.end(), 0);
  for (std::size_t p = 1; p < num; ++p) schur[0] += schur[p];
  add_between(sum, cut.between, schur[0]);
  const int last = count_negative_of_dense(schur[0]);
  return last < 0 ? -1 : negative + last;
}

}  // namespace

std::optional<int> count_negative_by_fronts(const SymmetricMatrix& A, double factor, const SymmetricMatrix& B,
                                            PetscInt min_rows) {
  if (initialize_petsc().size > 1 || A.low_rank() || B.low_rank()) return std::nullopt;
  auto cut = find_parts(A, min_rows);
  if (!cut) return std::nullopt;
  std::sort(cut->between.begin(), cut->between.end());
  int count = -1;
  visit_rows(A.sparse(), [&](const MatrixRows& a, PetscInt rows) {
    visit_rows(B.sparse(), [&](const MatrixRows& b, PetscInt) {
      count = count_of_sum({a, b, factor, rows}, std::move(*cut));
    });
  });
  if (count < 0) return std::nullopt;
  return count;
}

}  // namespace bough::linear
