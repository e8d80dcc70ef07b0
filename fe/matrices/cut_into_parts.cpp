/// Whether a model is made by parts, and by which; here because wide constraints decide it too.
#include <algorithm>

#include "fe/linear/petsc.hpp"
#include "fe/matrices/wide_part.hpp"
#include "fe/model/builder.hpp"

namespace bough::fe {

void ModelBuilder::cut_into_parts() {
  const MpiWorld world = options_.by_parts ? initialize_petsc() : MpiWorld();
  if (world.size == 1 || options_.prestress || model_.subcase_.nsm != 0) return;
  if (!deck_.aset.empty() || !deck_.omit.empty() || !deck_.qset.empty()) return;
  // Sums over wide constraints are made of whole models (wide_part.hpp); an oblique AUTOSPC may make one wider yet.
  const auto most = static_cast<std::size_t>(get_max_dense_terms()) / 3;
  if (std::any_of(equations_.begin(), equations_.end(), [&](const auto& e) { return e.terms.size() > most; })) return;
  home_ = cut_nodes(deck_, model_, static_cast<int>(model_.nodes_.size()), equations_, is_fixed_, world.size);
}

}  // namespace bough::fe
