#pragma once
/// \file export --to sid, mbdyn and flat: a flexible body in the file of another program or host.
#include <string>

#include <vector>

#include "base/diagnostic.hpp"
#include "formats/export/csv.hpp"

namespace bough::analysis {

struct BodyExportOptions {
  std::string inertia = "6x1";
  std::string ge_order = "mode";
  int digits = 17;
};

/// Returns true for sid, mbdyn and flat.
bool is_body_format(const std::string& format);
/// Throws InputError "cli.no-export" for a file that is no flexible body.
std::string make_body_text(const std::string& file, const std::string& format, const BodyExportOptions& options,
                           Diagnostics& diagnostics);

/// Modes files and flexible bodies.
bool has_shapes(const std::string& format);
/// A row per mode: number, frequency, eigenvalue, modal mass, effective masses; of buckling the load factors.
std::vector<exports::CsvColumn> read_mode_columns(const std::string& file, const std::string& format,
                                                  Diagnostics& diagnostics);
/// id, x, y, z of every node, then six columns for each mode: mode_001_x ... mode_001_rz.
std::vector<exports::CsvColumn> read_shape_columns(const std::string& file, const std::string& format,
                                                   Diagnostics& diagnostics);

}  // namespace bough::analysis
