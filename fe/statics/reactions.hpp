#pragma once
/// \file Forces of constraints of any motion.
#include "fe/model/model.hpp"

namespace bough::fe {

/// Forces of the single-point constraints of the residual K u - F (of a mode K φ - λ M φ): T_fixedᵀ of it, on the g-set
/// in basic axes.
VectorXd calc_reactions(const Model& model, const VectorXd& residual);

}  // namespace bough::fe
