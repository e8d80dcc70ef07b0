#pragma once
/// \file A flexible body from any file that holds one: HDF5 of `reduce`, a flat file, or .FLX, of which "panels.FLX:2"
/// is body 2.
#include <optional>
#include <string>

#include "embed/load.hpp"

namespace bough {
class Diagnostics;
struct SourceLocation;
}  // namespace bough

namespace bough::analysis {

/// Returns true if the content of the file is that of a flat body file (docs/formats/flat.md), by any name.
bool is_flat(const std::string& name);
/// Returns true if the name is one of a .FLX file, with or without the id of a body.
bool is_flx(const std::string& name);
/// The root attribute "format" of an HDF5 file; empty when there is none.
std::string read_file_format(const std::string& file);
/// The file alone, without the id of a body.
std::string get_body_path(const std::string& name);
/// Returns true if both names refer to one body of one file.
bool is_same_body(const std::string& a, const std::string& b);
/// demand_file() of the file alone.
void demand_body_file(const std::string& name);

using embed::RigidPart;

/// Adds the note "flx.not-carried" with what a .FLX leaves out, once a file. Throws what the readers throw. A body
/// whose file contains no centre of mass and no inertia has none.
records::FlexBody read_body(const std::string& name, Diagnostics& diagnostics);
/// Reads a body with its rigid part, from the file or from `given`. Throws InputError "flx.no-inertia" if neither has
/// it, "flx.two-inertias" if both have.
records::FlexBody read_moving_body(const std::string& name, Diagnostics& diagnostics,
                                   const std::optional<RigidPart>& given = {});

/// Adds export.third-order (warning) if the body has third order, which a format does not contain. \param format  "a
/// .FLX file".
void warn_of_third_order(const records::FlexBody& body, const std::string& file, const std::string& format,
                         Diagnostics& diagnostics);

}  // namespace bough::analysis
