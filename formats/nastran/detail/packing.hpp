#pragma once
/// \file The lines of a deck as bytes, so that one process reads the files and others take what it read.
#include <string>

#include "base/diagnostic.hpp"
#include "formats/nastran/detail/lines.hpp"

namespace bough::nastran::detail {

/// For a process of the same build on the same kind of machine: numbers are copied as they lie in memory.
std::string pack(const Source& source, const Diagnostics& diagnostics);
/// The source; what `pack` was given is added to `diagnostics`.
Source unpack(std::string bytes, Diagnostics& diagnostics);

}  // namespace bough::nastran::detail
