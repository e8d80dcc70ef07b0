#pragma once
/// \file Preload: the state of stress from which modes, statics, buckling and bodies start (docs/theory/preload.md).
#include "fe/model/model.hpp"

namespace bough::fe {

/// Load that acts before the one of the analysis.
struct Preload {
  int load = 0, temperature = 0;     ///< sets of the deck; 0: none
  Vector3d spin = Vector3d::Zero();  ///< about Bo, in basic
  std::string name;
  SourceLocation at;  ///< what asks for it
};

/// The stress of `preload` on the model of `options`: linear statics on its constraints (a determinate support where
/// ignore_spc leaves them out), on top of the prestress of the options. Throws what the solution throws.
std::shared_ptr<const Prestress> calc_prestress(const records::Deck& deck, const ModelOptions& options,
                                                const ElementFactory& elements, const Preload& preload,
                                                Diagnostics& diagnostics);

/// Computes the stress of subcase `id` with its constraints, and those of its chain of STATSUB(PRELOAD); `at`: the
/// command that requests it. Throws InputError fe.preload-subcase if a subcase is missing, has no load or names itself.
std::shared_ptr<const Prestress> calc_subcase_prestress(const records::Deck& deck, ModelOptions options,
                                                        const ElementFactory& elements, int id,
                                                        const SourceLocation& at, Diagnostics& diagnostics);
/// Stress of the preload that STATSUB of the subcase selects; nullptr: none.
std::shared_ptr<const Prestress> calc_subcase_prestress(const records::Deck& deck, const ModelOptions& options,
                                                        const records::Subcase& subcase, Diagnostics& diagnostics);

/// A structure in the deformed shape of its preload.
struct DeformedPreload {
  records::Deck deck;  ///< make_deformed_deck()
  std::shared_ptr<const Prestress> prestress;
  double max_displacement = 0;  ///< of a grid
};

/// The shape and the stress of a load under large displacements (nonlinear.hpp): the model of the deck returned with
/// its prestress is in balance with the load. Needs a preload without spin. Throws what the solution throws, and
/// InputError fe.nonlinear-preload for cards that cannot be turned.
DeformedPreload calc_nonlinear_preload(const records::Deck& deck, ModelOptions options, const Preload& preload,
                                       Diagnostics& diagnostics);
/// calc_nonlinear_preload() of subcase `id`, held as it says. Throws InputError fe.preload-subcase as
/// calc_subcase_prestress().
DeformedPreload calc_nonlinear_preload(const records::Deck& deck, ModelOptions options, int id,
                                       const SourceLocation& at, Diagnostics& diagnostics);

/// Reports fe.preload-subcase for every subcase that asks for a preload.
void check_preloads(const records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::fe
