#pragma once
/// \file The kinds of the f-dofs.
#include "fe/linear/row_kinds.hpp"
#include "fe/model/model.hpp"

namespace bough::fe {

/// Of the f-dofs (num_fdofs), in their order.
RowKinds list_row_kinds(const Model& model);
/// Of these f-dofs.
RowKinds list_row_kinds(const Model& model, const std::vector<int>& fdofs);

}  // namespace bough::fe
