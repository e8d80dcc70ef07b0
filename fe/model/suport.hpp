#pragma once
/// \file SUPORT: the r-set. Source: MSC Nastran Quick Reference Guide, SUPORT, SUPORT1.
#include "fe/model/model.hpp"

namespace bough::fe {

/// f-dofs of SUPORT and of the SUPORT1 set of the model's subcase, ascending, each once. Reports fe.missing-set,
/// fe.missing-grid, fe.bad-component, fe.suport-not-free (fixed, dependent or omitted); a dof without stiffness, which
/// AUTOSPC holds, is left out with fe.suport-autospc (warning).
std::vector<int> find_suport(const Model& model, const records::Deck& deck, Diagnostics& diagnostics);

/// Errors of find_suport() are thrown; a note lists the dofs, which only a static solution holds.
void report_suport(const Model& model, const records::Deck& deck, Diagnostics& diagnostics);

/// "grid 3 component 2", "scalar point 3".
std::string name_suport(int grid, int component);

}  // namespace bough::fe
