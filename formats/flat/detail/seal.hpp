#pragma once
/// \file The last line of a flat file: its checksum.
#include <string>
#include <string_view>

namespace bough::flat::detail {

inline constexpr std::size_t kSealSize = 21;  ///< "end ", sixteen hexadecimal digits, a line feed

/// Returns the last line of a file that begins with `bytes`: FNV-1a, 64 bits.
/// Source: draft-eastlake-fnv, http://www.isthe.com/chongo/tech/comp/fnv.
std::string make_seal(std::string_view bytes);

}  // namespace bough::flat::detail
