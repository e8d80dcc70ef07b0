#pragma once
/// \file [[hinge]] of a system file.
#include "formats/records/system_spec.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// One hinge. Lists have as many entries as the hinge has coordinates ("toml.wrong-length"), one number of stiffness or
/// damping stands for all; degrees become radians ("toml.no-angle" where the hinge has no angle).
records::HingeRecord read_hinge(const Fields& table, Diagnostics& diagnostics);

}  // namespace bough::toml_files
