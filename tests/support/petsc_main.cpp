#include <gtest/gtest.h>

#include "fe/linear/petsc.hpp"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  bough::linear::initialize_petsc();
  return RUN_ALL_TESTS();
}
