#pragma once
/// \file Eigenpairs as the record that files and tables are made of.
#include "fe/model/model.hpp"
#include "formats/records/modes.hpp"
#include "modal/eigen.hpp"

namespace bough::modal {

/// Additional requested results of normal modes.
struct ModesExtras {
  const records::Deck* energies_of = nullptr;  ///< energies of the elements, whose properties this deck names
  int about_grid = 0;  ///< effective masses about this grid; InputError modal.unknown-grid where the model has it not
  const records::MassProperties* mass = nullptr;  ///< about the origin, where the caller has them
  bool has_shapes = true;                         ///< the shapes and what is drawn; else the record has neither
};

/// Sorts eigenvalues below zero to the front (fe.preload-tips), the others as found: the order of the record.
EigenPairs sort_negative(EigenPairs pairs);

/// Mass properties about the origin, shapes at the grids, residuals; of normal modes (not of buckling) frequencies,
/// modal and effective masses too, with the shapes' own lengths. Collective.
records::ModesResult make_modes_result(const fe::Model& model, const EigenPairs& pairs, bool buckling,
                                       const ModesExtras& extras = {});

}  // namespace bough::modal
