#pragma once
/// \file Check that a model with a prestress does not buckle under it.
#include "fe/matrices/system.hpp"

namespace bough::fe {

/// Assembles and factors K with K_G0 of the prestress. `is_free`: the SPC sets are ignored; then the check holds a
/// statically determinate support. Reports fe.preload-tips (warning) if only rigid-body motions of a free body have
/// negative stiffness. \return K and, if it is definite, its LLᵀ; nullptr without a prestress or free dofs.
/// \throws ComputationError "fe.preload-buckles". Collective.
std::shared_ptr<const CheckedStiffness> check_preload(const Model& model, bool is_free, Diagnostics& diagnostics);

}  // namespace bough::fe
