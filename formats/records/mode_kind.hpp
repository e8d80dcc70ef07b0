#pragma once
/// \file The words for kinds of modes, in files, tables and Python.
#include <array>

#include "formats/records/flex_body.hpp"

namespace bough::records {

/// Returns "normal", "constraint", "attachment" or "residual".
inline const char* get_name(ModeKind kind) {
  constexpr std::array kNames{"normal", "constraint", "attachment", "residual"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace bough::records
