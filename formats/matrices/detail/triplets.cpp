#include "formats/matrices/detail/triplets.hpp"

#include <algorithm>
#include <numeric>

namespace bough::matrices::detail {

bool Triplets::is_triangular() const {
  std::vector<std::pair<int, int>> places;
  for (std::size_t i = 0; i < row_.size(); ++i)
    if (row_[i] != column_[i]) places.emplace_back(row_[i], column_[i]);
  std::sort(places.begin(), places.end());
  const auto has_mirror = [&](const std::pair<int, int>& place) {
    return std::binary_search(places.begin(), places.end(), std::pair(place.second, place.first));
  };
  return !places.empty() && std::none_of(places.begin(), places.end(), has_mirror);
}

void Triplets::mirror(Triangle how) {
  if (how == Triangle::Both) return;
  const double re = how == Triangle::MirrorNegative ? -1 : 1, im = how == Triangle::Mirror ? 1 : -1;
  for (std::size_t i = 0, n = row_.size(); i < n; ++i)
    if (row_[i] != column_[i]) add(column_[i], row_[i], re * value_[i], im * imaginary_[i]);
}

void Triplets::renumber(const std::vector<int>& row_of, const std::vector<int>& column_of) {
  for (auto& row : row_) row = row_of[static_cast<std::size_t>(row)];
  for (auto& column : column_) column = column_of[static_cast<std::size_t>(column)];
}

void Triplets::compress(int num_rows, int num_cols, bool is_complex, Matrix& matrix) const {
  const auto row = [this](std::size_t i) { return static_cast<std::size_t>(row_[i]); };
  std::vector<std::size_t> begin(static_cast<std::size_t>(num_rows) + 1, 0), order(row_.size());
  for (std::size_t i = 0; i < row_.size(); ++i) ++begin[row(i) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  auto next = begin;
  for (std::size_t i = 0; i < row_.size(); ++i) order[next[row(i)]++] = i;

  auto& out = matrix.values;
  out = {};
  matrix.is_complex = is_complex;
  matrix.imaginary.clear();
  out.num_rows = num_rows;
  out.num_cols = num_cols;
  out.indptr.reserve(begin.size());
  out.indptr.push_back(0);
  for (std::size_t r = 0; r < static_cast<std::size_t>(num_rows); ++r) {
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin[r]),
               last = order.begin() + static_cast<std::ptrdiff_t>(begin[r + 1]);
    std::stable_sort(first, last, [this](std::size_t a, std::size_t b) { return column_[a] < column_[b]; });
    for (auto i = first; i != last;) {
      const int column = column_[*i];
      double re = 0, im = 0;
      for (; i != last && column_[*i] == column; ++i) {
        re += value_[*i];
        im += imaginary_[*i];
      }
      if (re == 0 && im == 0) continue;
      out.indices.push_back(column);
      out.data.push_back(re);
      if (is_complex) matrix.imaginary.push_back(im);
    }
    out.indptr.push_back(static_cast<int>(out.indices.size()));
  }
}

}  // namespace bough::matrices::detail
