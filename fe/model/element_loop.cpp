#include "fe/model/element_loop.hpp"

#include "fe/linear/petsc.hpp"

namespace bough::fe {

ElementRange get_all_elements(const Model& model) { return {0, static_cast<int>(model.elements().size())}; }

ElementRange get_own_elements(const Model& model) {
  const linear::MpiWorld world = linear::initialize_petsc();
  const auto num = static_cast<long long>(model.elements().size());
  return {static_cast<int>(num * world.rank / world.size), static_cast<int>(num * (world.rank + 1) / world.size)};
}

}  // namespace bough::fe
