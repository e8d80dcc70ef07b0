#pragma once
/// \file Named arrays of export: MATLAB and OUTPUT4 files of Bough's HDF5 files.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/export/reduced_solid.hpp"

namespace bough::analysis {

/// Writes the MATLAB file of a flexible body, modes, matrices or results file. Throws "cli.no-export".
void export_mat(const std::string& file, const std::string& output, Diagnostics& diagnostics);

/// The text of the OUTPUT4 file of a flexible body, modes or matrices file. Throws "cli.no-export".
std::string make_op4(const std::string& file, Diagnostics& diagnostics);

/// "cli.no-export": the file is of a kind that has no export to `format`.
[[noreturn]] void refuse_export(const std::string& file, const std::string& format, const std::string& expected);

/// The sets of mass integrals that the body has, by name.
std::vector<std::pair<std::string, const records::MassIntegrals*>> list_integrals(const records::FlexBody& body);

/// Nothing for a body of normal modes; the warning "export.no-frames" for one whose constraint modes do not fit.
std::optional<exports::ReducedSolid> find_solid(const records::FlexBody& body, const std::string& file,
                                                Diagnostics& diagnostics);

/// Converts an index of Eigen to an index of std containers; i >= 0.
inline std::size_t to_size(Eigen::Index i) { return static_cast<std::size_t>(i); }

}  // namespace bough::analysis
