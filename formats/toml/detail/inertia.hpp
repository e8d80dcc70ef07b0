#pragma once
/// \file The inertia of a rigid body: three moments, six components or three rows.
#include "formats/toml/detail/fields.hpp"

namespace bough::toml_files {

/// The tensor about the centre of mass; zero if the key is missing. Reports toml.wrong-length, toml.bad-value.
Eigen::Matrix3d read_inertia(const Fields& table, Diagnostics& diagnostics);

}  // namespace bough::toml_files
