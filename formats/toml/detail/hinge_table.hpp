#pragma once
/// \file [[hinge]] of a system file.
#include "formats/records/system_spec.hpp"
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// Kinds of the coordinates (q) and rates (u) of a hinge, in the order of the file: 'a' angle, 'l' length,
/// 'q' quaternion component.
struct HingeCoordinates {
  records::HingeType type;
  std::string q, u;
};
/// Coordinates of a type; those of a gimbal or a general hinge are in its own keys. An unknown type has none.
HingeCoordinates list_coordinates(const std::string& type, const std::string& rotations,
                                  const std::string& translations);

/// One hinge. Lists have as many entries as the hinge has coordinates ("toml.wrong-length"), one number of stiffness or
/// damping stands for all; degrees become radians ("toml.no-angle" where the hinge has no angle).
records::HingeRecord read_hinge(const Fields& table, Diagnostics& diagnostics);

}  // namespace bough::toml_files
