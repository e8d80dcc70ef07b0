#pragma once
/// \file A deck for the viewer of the page.
#include <nlohmann/json.hpp>
#include <string>

#include "base/diagnostic.hpp"

namespace bough::cli {

/// Drawing, elements, symbols, cards of a deck; arrays packed as report/pack.hpp does. Messages of reading go
/// to `diagnostics`. \throws InputError of files that are no deck.
nlohmann::json make_deck_answer(const std::string& file, Diagnostics& diagnostics);

}  // namespace bough::cli
