#pragma once
/// \file Lowest modes of a model by the default eigensolver.
#include "fe/model/model.hpp"
#include "modal/eigen.hpp"

namespace bough::test {

inline modal::EigenPairs solve_modes(const fe::Model& model, int num_modes, Diagnostics& diagnostics) {
  modal::EigenOptions options;
  options.num_modes = num_modes;
  return modal::calc_normal_modes(model, options, diagnostics);
}

}  // namespace bough::test
