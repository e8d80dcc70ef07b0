#pragma once
/// \file Static (Guyan) reduction to the a-set: ASET, OMIT. Source: R. J. Guyan, AIAA J. 3 (1965) 380.
#include "fe/model/model.hpp"

namespace bough::fe {

/// The model with the dofs of the a-set as its f-dofs; unchanged without ASET and OMIT. Reports fe.analysis-set,
/// fe.omitted-singular, and fe.static-reduction (note). Collective; factors K_oo.
Model reduce_to_aset(Model model, const records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::fe
