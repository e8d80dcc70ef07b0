#pragma once
/// \file Statements of the executive control and the file management that change what Nastran computes.
#include "formats/nastran/detail/lines.hpp"

namespace bough::nastran::detail {

/// NASTRAN statements before CEND: "NASTRAN BARMASS=1, SYSTEM(304)=5" fills deck.system_cells.
void read_system_cells(const Source& source, records::Deck& deck);

}  // namespace bough::nastran::detail
