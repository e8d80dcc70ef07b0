#pragma once
/// \file Commands of TREETOPS (NASA-CR-202063, section 2) and what replaces them here.
#include <string>
#include <string_view>

namespace bough::analysis {

/// The command line or the word of `bough edit` that replaces `word`, in any case, as advice; empty for other words.
std::string find_successor(std::string_view word);

}  // namespace bough::analysis
