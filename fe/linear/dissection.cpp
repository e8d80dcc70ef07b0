#include "fe/linear/dissection.hpp"

#include <algorithm>

namespace bough::fe {
namespace {

/// Rows between the parts, of all: their dense blocks are factored three times.
constexpr double kMostBetween = 0.02;

}  // namespace

std::optional<TwoParts> find_parts(Mat A, PetscInt least) {
  const auto size_of = [](const auto& rows) { return static_cast<double>(rows.size()); };
  if (get_num_threads() > 1) {
    auto two = find_two_parts(A, least);
    const double first = two ? size_of(two->first) : 0, second = two ? size_of(two->second) : 0;
    if (two && size_of(two->between) < kMostBetween * (first + second) &&
        std::min(first, second) > 0.3 * std::max(first, second))
      return two;
  }
  const PetscIs order = find_elimination_order(A, least);
  if (!order) return std::nullopt;
  PetscInt n = 0;
  const PetscInt* rows = nullptr;
  TwoParts one;
  check_petsc(ISGetSize(order.get(), &n));
  check_petsc(ISGetIndices(order.get(), &rows));
  one.first.assign(rows, rows + n);
  check_petsc(ISRestoreIndices(order.get(), &rows));
  return one;
}

}  // namespace bough::fe
