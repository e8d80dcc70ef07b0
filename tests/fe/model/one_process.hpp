#pragma once
/// \file Large displacements, which are solved on one process (cli.nonlinear-ranks).
#include <gtest/gtest.h>

#include "fe/linear/petsc.hpp"

namespace bough::fe::test {

/// Skips its tests on several ranks.
class OneProcess : public ::testing::Test {
 protected:
  void SetUp() override {
    if (linear::initialize_petsc().size > 1) GTEST_SKIP() << "one process alone";
  }
};

/// Control of a nonlinear deck with SPC and LOAD sets 1.
inline constexpr const char* kHead = "SOL 106\nCEND\nSPC = 1\nLOAD = 1\nBEGIN BULK\n";

}  // namespace bough::fe::test
