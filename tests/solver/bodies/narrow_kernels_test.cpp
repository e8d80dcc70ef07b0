// The loops as compiled for a processor without AVX2, under another name.
#include "solver/bodies/kernels.hpp"

#define BOUGH_NARROW
#define solver narrow
#include "solver/bodies/kernels.cpp"
#undef solver
#undef BOUGH_NARROW

#include "tests/solver/bodies/kernels_test.hpp"

namespace bough::solver::testing {
namespace {

struct Narrow {
  static constexpr auto multiply = narrow::multiply;
  static constexpr auto multiply_transposed = narrow::multiply_transposed;
  static constexpr auto add_product = narrow::add_product;
  static constexpr auto contract = narrow::contract;
  static constexpr auto add_scaled = narrow::add_scaled;
  static constexpr auto add_square = narrow::add_square;
  static constexpr auto factor_trapezoid = narrow::factor_trapezoid;
  static constexpr auto solve_lower = narrow::solve_lower;
  static constexpr auto solve_lower_transposed = narrow::solve_lower_transposed;
};

TEST(Kernels, AreTheSameForNarrowRegisters) { compare_kernels_with_eigen<Narrow>(); }

}  // namespace
}  // namespace bough::solver::testing
