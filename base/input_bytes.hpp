#pragma once
/// \file Bytes of input files, read once in a call of the program.
#include <cstddef>
#include <memory>
#include <string>

namespace bough {

/// Returns the bytes of a file; null if it is no regular file or cannot be read.
///
/// While a FileRoles lives, the bytes are kept, and a file that has not changed since is not opened again: its kind,
/// its content and its hash are those of one reading. Calls note_input.
std::shared_ptr<const std::string> read_input(const std::string& path);

/// Returns the first bytes of a file, at most `size`; none if it is no regular file or cannot be read.
///
/// While a FileRoles lives, a file of at most 512 MiB without zero bytes in its first 4096 is a text: all of it is
/// read and kept as by read_input, whose call may follow. Other files are opened for their first bytes alone.
std::string read_input_head(const std::string& path, std::size_t size);

/// Returns the bytes that read_input keeps of a file that has not changed since; null if it keeps none.
std::shared_ptr<const std::string> find_input(const std::string& path);

/// Number of files that read_input has opened in this process.
std::size_t count_opened_inputs();

namespace detail {

/// Begins to keep inputs, in addition to those that are kept.
void begin_keeping_inputs();
/// Drops the inputs that were kept since the last call of begin_keeping_inputs.
void end_keeping_inputs();

}  // namespace detail

}  // namespace bough
