#pragma once
/// \file The kinds of the f-dofs.
#include "fe/linear/row_kinds.hpp"
#include "fe/model/model.hpp"

namespace bough::fe {

/// Kinds of all f-dofs (num_fdofs), in their order.
linear::RowKinds list_row_kinds(const Model& model);
/// Kinds of the f-dofs `fdofs`.
linear::RowKinds list_row_kinds(const Model& model, const std::vector<int>& fdofs);

}  // namespace bough::fe
