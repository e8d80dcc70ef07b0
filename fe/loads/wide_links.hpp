#pragma once
/// \file Links whose second order would fill K_G: those over more than kMaxLinkDofs dofs.
#include <cstddef>

#include "base/diagnostic.hpp"
#include "formats/records/deck.hpp"

namespace bough::fe {

/// An RBE3 over more g-dofs than this makes a dense block of K_G of that size: on the g-set, for files, where nothing
/// is of low rank (wide_part.hpp), assemble_geometric_stiffness() leaves it out.
inline constexpr std::size_t kMaxLinkDofs = 3000;

/// Reports fe.wide-link (warning) for every such RBE3.
void report_wide_links(const records::Deck& deck, Diagnostics& diagnostics);

}  // namespace bough::fe
