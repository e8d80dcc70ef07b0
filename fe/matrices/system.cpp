#include "fe/matrices/system.hpp"

namespace bough::fe {

linear::SymmetricMatrix get_stiffness(const Model& model) {
  return model.checked_stiffness() ? model.checked_stiffness()->K : assemble_stiffness(model, DofSet::Free);
}

System::System(const Model& model_in)
    : model(model_in),
      K(get_stiffness(model)),
      M(assemble_mass(model, DofSet::Free, model.mass_kind())),
      K_diagonal(linear::get_diagonal(K).cwiseAbs()),
      M_diagonal(linear::get_diagonal(M)),
      factor(model.checked_stiffness() && model.checked_stiffness()->factor ? &*model.checked_stiffness()->factor
                                                                            : nullptr) {}

}  // namespace bough::fe
