#pragma once
/// \file The words for kinds of modes, in files, tables and Python.
#include "formats/records/flex_body.hpp"

namespace bough::records {

/// Returns "normal", "constraint", "attachment" or "residual".
inline const char* get_name(ModeKind kind) {
  switch (kind) {
    case ModeKind::Normal:
      return "normal";
    case ModeKind::Constraint:
      return "constraint";
    case ModeKind::Attachment:
      return "attachment";
    case ModeKind::Residual:
      return "residual";
  }
  return "";
}

}  // namespace bough::records
