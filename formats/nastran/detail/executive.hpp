#pragma once
/// \file Statements of the executive control and the file management that change what Nastran computes.
#include <functional>
#include <string>
#include <string_view>

#include "formats/nastran/detail/lines.hpp"

namespace bough::nastran::detail {

/// Calls use(text, at) for each statement before CEND and BEGIN that begins with the word, with what follows it; lines
/// that end with a comma are continued.
void visit_statements(const Source& source, std::string_view word,
                      const std::function<void(const std::string& text, const records::CardLocation& at)>& use);

/// NASTRAN statements before CEND: "NASTRAN BARMASS=1, SYSTEM(304)=5" fills deck.system_cells.
void read_system_cells(const Source& source, records::Deck& deck);

}  // namespace bough::nastran::detail
