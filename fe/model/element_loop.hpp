#pragma once
/// \file The loop over the elements of a model: all of them or those of this rank, by one thread or by two.
#include <cstddef>
#include <optional>
#include <utility>

#include "fe/linear/threads.hpp"
#include "fe/model/model.hpp"

namespace bough::fe {

/// Elements [first, last) of model.elements().
struct ElementRange {
  int first = 0, last = 0;

  /// Returns true if the index `e` is in the range.
  bool contains(int e) const { return e >= first && e < last; }
};

/// The range of all elements, on every rank.
ElementRange get_all_elements(const Model& model);
/// The elements that this rank adds to sums over ranks.
ElementRange get_own_elements(const Model& model);

/// Calls visit(e, element) in the order of the deck.
template <class Visit>
void visit_elements(const Model& model, const ElementRange& range, const Visit& visit) {
  for (int e = range.first; e < range.last; ++e) visit(e, *model.elements()[static_cast<std::size_t>(e)]);
}

/// Calls visit(half, e, element): two threads take half 0 and half 1 of the range where each has at least
/// `min_of_thread` elements (fewer take less time than the start of a thread); else half 0 is the whole range.
template <class Visit>
void visit_elements_by_halves(const Model& model, const ElementRange& range, int min_of_thread, const Visit& visit) {
  linear::do_halves(range.last - range.first, min_of_thread, [&](int from, int to) {
    const std::size_t half = from == 0 ? 0 : 1;
    visit_elements(model, {range.first + from, range.first + to},
                   [&](int e, const Element& element) { visit(half, e, element); });
  });
}

/// Returns the sum that make() starts, after sum.add(e, element) for each element. Two threads sum halves as above, and
/// the first takes the second by sum.merge(second).
template <class Make>
auto sum_over_elements(const Model& model, const ElementRange& range, int min_of_thread, const Make& make) {
  auto sum = make();
  std::optional<decltype(sum)> second;
  linear::do_halves(range.last - range.first, min_of_thread, [&](int from, int to) {
    auto& own = from == 0 ? sum : second.emplace(make());
    visit_elements(model, {range.first + from, range.first + to},
                   [&](int e, const Element& element) { own.add(e, element); });
  });
  if (second) sum.merge(std::move(*second));
  return sum;
}

}  // namespace bough::fe
