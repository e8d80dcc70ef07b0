#pragma once
/// \file Loops for processors with AVX2 and loops for all others: templates on the numbers in a register, of which
/// one is compiled with BOUGH_WIDE and taken where has_wide().

#if defined(__x86_64__) && defined(__GNUC__) && !defined(BOUGH_NARROW)
#define BOUGH_WIDE __attribute__((target("avx2,fma")))
#endif
#define BOUGH_INLINE inline __attribute__((always_inline))

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

#ifdef BOUGH_WIDE
/// Returns true if the processor has AVX2 and FMA.
inline bool has_wide() {
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
}
#endif

}  // namespace bough::linear
