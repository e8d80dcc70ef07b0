#pragma once
/// \file Lines of standard input: at a terminal with history and completion where Bough was built with libedit.
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bough::cli {

/// Returns true if both standard input and output are terminals.
bool is_at_terminal();

/// Completions of the last word of a line.
using Complete = std::function<std::vector<std::string>(const std::string& line)>;

/// The next line without its end; nothing at the end of the input. The prompt is printed at a terminal only. After
/// Ctrl-C it is empty, or nothing without `complete`, and was_left() is true.
std::optional<std::string> read_line(const std::string& prompt, const Complete& complete = {});
/// Returns true if Ctrl-C ended the last read_line().
bool was_left();

}  // namespace bough::cli
