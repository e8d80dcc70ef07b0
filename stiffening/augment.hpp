#pragma once
/// \file The model of a body with the masses of [[body.augment]].
#include "fe/matrices/system.hpp"
#include "fe/model/model.hpp"

namespace bough::stiffening {

struct Augmented {
  explicit Augmented(fe::Model model_in) : model(std::move(model_in)), system(model) {}
  const fe::Model model;
  const fe::System system;
};

}  // namespace bough::stiffening
