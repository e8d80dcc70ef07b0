#pragma once
/// \file Where the membrane's and the plate's dofs stand among u v w θx θy θz of the corners. Internal.
#include <array>

namespace bough::fe::shell {

template <int N>
constexpr auto kMembrane = [] {
  std::array<int, 3 * N> at{};
  for (int i = 0; i < N; ++i) at[3 * i] = 6 * i, at[3 * i + 1] = 6 * i + 1, at[3 * i + 2] = 6 * i + 5;
  return at;
}();
template <int N>
constexpr auto kPlate = [] {
  std::array<int, 3 * N> at{};
  for (int i = 0; i < 3 * N; ++i) at[i] = 6 * (i / 3) + 2 + i % 3;
  return at;
}();

}  // namespace bough::fe::shell
