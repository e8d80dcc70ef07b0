#pragma once
/// \file Loops for processors with AVX2 and for all others: templates on the numbers in a register, of which one is
/// compiled with BOUGH_AVX2 and taken if platform::has_avx2().

#include "base/platform.hpp"

namespace bough::linear {

/// W numbers side by side.
template <int W>
struct Register;
template <>
struct Register<4> {
  using type = double __attribute__((vector_size(32)));
};
template <>
struct Register<2> {
  using type = double __attribute__((vector_size(16)));
};

}  // namespace bough::linear
