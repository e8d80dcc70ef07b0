#pragma once
#include <functional>
#include <string>

namespace bough::analysis {

/// Writes to a temporary file and renames: the file appears whole or not at all. Throws ComputationError("cli.write").
void write_text_file(const std::string& path, const std::string& text);

/// Lets `write` make a file under the name that it gets, next to `path`, and gives it the name `path` when it is whole.
/// A failure removes it, leaves an old file as it was, and names `path` in its messages.
void write_whole(const std::string& path, const std::function<void(const std::string& part)>& write);

}  // namespace bough::analysis
