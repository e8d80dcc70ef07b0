#pragma once
/// \file Size of a model.
#include "fe/model/model.hpp"

namespace bough::fe {

/// Diagonal [L] of the box around the grids, along the basic axes; 0 without grids.
double calc_model_size(const Model& model);

}  // namespace bough::fe
