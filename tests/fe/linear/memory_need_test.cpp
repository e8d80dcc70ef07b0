/// What a factor needs is compared with what is free, before the work begins.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include <sys/resource.h>
#include <unistd.h>

#include "base/diagnostic.hpp"
#include "fe/linear/factor.hpp"
#include "fe/linear/memory_need.hpp"

namespace bough::linear {
namespace {

TEST(MemoryNeed, IsToldWithWhatIsFree) {
  EXPECT_NO_THROW(require_memory(1e6, 1e8, 2e9));
  try {
    require_memory(3e6, 3.4e9, 12.4e9);
    FAIL() << "31 GB in 12";
  } catch (const ComputationError& error) {
    const Diagnostic& told = error.items().front();
    EXPECT_EQ(told.id, "fe.out-of-memory");
    EXPECT_EQ(told.what, "the factor of 3000000 equations needs about 31 GB, 12 GB of memory are free");
  }
}

TEST(MemoryNeed, UnitsArePlain) {
  EXPECT_EQ(format_bytes(31.4e9), "31 GB");
  EXPECT_EQ(format_bytes(1.44e9), "1.4 GB");
  EXPECT_EQ(format_bytes(240e6), "240 MB");
  EXPECT_EQ(format_bytes(2.5e12), "2.5 TB");
}

TEST(MemoryNeed, FreeMemoryIsWhatLimitsLeave) {
  const double free = calc_free_memory();
  EXPECT_GT(free, 1e6);
  const auto is_within_limit = [] {
    // Above what is taken already: under the sanitizers that is terabytes of address space.
    constexpr double kLeft = 5e7;
    double pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const double taken = pages * static_cast<double>(sysconf(_SC_PAGESIZE));
    const rlimit limit{static_cast<rlim_t>(taken + kLeft), RLIM_INFINITY};
    if (setrlimit(RLIMIT_AS, &limit) != 0) std::_Exit(2);
    const double left = calc_free_memory();
    std::_Exit(left > 0 && left < 1.1 * kLeft ? 0 : 1);
  };
  EXPECT_EXIT(is_within_limit(), testing::ExitedWithCode(0), "");
}

/// The library's own count of a factor that is known: a tridiagonal matrix has two entries a column but in the last.
TEST(MemoryNeed, EntriesOfAFactorAreThoseOfItsAnalysis) {
  if (initialize_petsc().size > 1) GTEST_SKIP() << "CHOLMOD is for one process";
  constexpr int n = 50;
  PetscMat A;
  check_petsc(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 3, nullptr, A.out()));
  for (int i = 0; i < n; ++i) {
    check_petsc(MatSetValue(A.get(), i, i, 2, INSERT_VALUES));
    for (const int j : {i - 1, i + 1})
      if (j >= 0 && j < n) check_petsc(MatSetValue(A.get(), i, j, -1, INSERT_VALUES));
  }
  check_petsc(MatAssemblyBegin(A.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(A.get(), MAT_FINAL_ASSEMBLY));
  const auto factor = SymmetricFactor::try_definite(SymmetricMatrix(std::move(A)));
  ASSERT_TRUE(factor);
  EXPECT_EQ(factor->num_entries(), 2 * n - 1);
}

}  // namespace
}  // namespace bough::linear
