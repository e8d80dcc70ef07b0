#pragma once
/// \file The words of a line of `bough edit`.
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bough::analysis {

/// Split at blanks outside "...", '...', [...] and {...}; `#` begins a comment. A '=' with blanks around it joins its
/// two sides: `axis = [0, 0, 1]` is one word. Throws InputError "cli.edit-command" where a bracket or quote stays open.
std::vector<std::string> split_words(const std::string& line);

/// "key=value" at the first '=' outside quotes; nothing if there is none.
std::optional<std::pair<std::string, std::string>> split_assignment(const std::string& word);

/// A word without the quotes around it.
std::string strip_quotes(const std::string& word);

}  // namespace bough::analysis
