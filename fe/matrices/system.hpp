#pragma once
/// \file The matrices of a model on its f-set, assembled once and handed to all who factor or multiply them.
#include <optional>

#include "fe/linear/factor.hpp"
#include "fe/matrices/assembly.hpp"

namespace bough::fe {

/// K of the f-set before anyone asked for it, from the check that a preloaded model does not buckle
/// (statics/preload_check.cpp), and its LLᵀ where it has one.
struct CheckedStiffness {
  linear::SymmetricMatrix K;
  std::optional<linear::SymmetricFactor> factor;
};

/// K on the f-set, with K_G0 of a preloaded model: that of its check, else assembled here.
linear::SymmetricMatrix get_stiffness(const Model& model);

/// K and M (times WTMASS) of one model on its f-set; both carry the order in which they are eliminated
/// (linear/ordering.hpp), found once. Const after; `model` outlives it.
struct System {
  explicit System(const Model& model_in);
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  const Model& model;
  const linear::SymmetricMatrix K, M;
  const VectorXd K_diagonal, M_diagonal;  ///< |K_ii| and M_ii, num_fdofs, replicated
  const linear::SymmetricFactor* factor;  ///< LLᵀ of K where the check of a preload left one, else nullptr
};

}  // namespace bough::fe
