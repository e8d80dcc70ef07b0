#pragma once
/// \file Matrices whose rows belong to nodes of two each.
#include <memory>
#include <utility>
#include <vector>

#include "fe/linear/symmetric_matrix.hpp"

namespace bough::linear {

/// Assembles A [n x n], n even, with rows 2i and 2i + 1 as one group of the elimination order.
inline SymmetricMatrix assemble_in_pairs(PetscMat A, int n) {
  check_petsc(MatAssemblyBegin(A.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(A.get(), MAT_FINAL_ASSEMBLY));
  std::vector<int> start;
  for (int i = 0; i <= n; i += 2) start.push_back(i);
  const SymmetricMatrix result(std::move(A));
  result.row_order().groups = std::make_shared<const std::vector<int>>(std::move(start));
  return result;
}

}  // namespace bough::linear
