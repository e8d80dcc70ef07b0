#pragma once
/// \file Complex modes of a deck: SOL 107 on the full matrices, SOL 110 on real modes (docs/theory/complex-modes.md).
#include <functional>

#include "formats/records/complex_modes.hpp"
#include "formats/records/deck_dynamics.hpp"
#include "modal/eigen.hpp"

namespace bough::modal::complex_modes {

struct ComplexModesOptions {
  bool is_by_modes = false;  ///< SOL 110
  int num_modes = 0;         ///< overrules ND of EIGC; 0: the deck's
  bool has_shapes = true;    ///< the mesh and the shapes are filled in
  std::function<EigenOptions(const records::DynamicSubcase&, Diagnostics&)> choose_eigen;  ///< of SOL 110
};

/// Complex modes of a subcase with its SPC, MPC, damping, K2PP, B2PP, M2PP and TFL. Errors: modal.no-complex-method
/// (neither CMETHOD nor a number of modes), modal.missing-complex-method (CMETHOD without EIGC), those of
/// collect_physical_input and response::choose_damping. Warning: modal.fewer-complex-modes.
records::ComplexModesResult solve_complex_modes(const records::DynamicDeck& deck, const fe::ModelOptions& model_options,
                                                const records::DynamicSubcase& subcase,
                                                const ComplexModesOptions& options, Diagnostics& diagnostics);

}  // namespace bough::modal::complex_modes
