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

BOUGH_KERNELS_OF(narrow, Narrow);

TEST(Kernels, AreTheSameForNarrowRegisters) { compare_kernels_with_eigen<Narrow>(); }

}  // namespace
}  // namespace bough::solver::testing
