#include "fe/model/row_kinds.hpp"

#include <numeric>

namespace bough::fe {

linear::RowKinds list_row_kinds(const Model& model, const std::vector<int>& fdofs) {
  linear::RowKinds kinds;
  kinds.reserve(fdofs.size());
  for (const int f : fdofs) {
    const int component = model.describe_fdof(f).second;
    kinds.push_back(component == 0   ? linear::RowKind::Scalar
                    : component <= 3 ? linear::RowKind::Translation
                                     : linear::RowKind::Rotation);
  }
  return kinds;
}

linear::RowKinds list_row_kinds(const Model& model) {
  std::vector<int> all(static_cast<std::size_t>(model.num_fdofs()));
  std::iota(all.begin(), all.end(), 0);
  return list_row_kinds(model, all);
}

}  // namespace bough::fe
