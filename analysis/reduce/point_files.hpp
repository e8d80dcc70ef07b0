#pragma once
/// \file The grids that given matrices belong to, and which dof each of their rows is.
#include <string>

#include <Eigen/Dense>

#include "formats/records/body_spec.hpp"
#include "formats/records/deck.hpp"

namespace bough::analysis {

/// Returns true if the file begins as HDF5 does.
bool is_hdf5(const std::string& path);

/// The deck's grids, constraints, loads, whatever elements it has; or the grids of a table or of an HDF5 file. Throws
/// InputError, "cli.no-grids", "cli.grids-twice" among them.
records::Deck read_points(const records::BodySpec& spec, Diagnostics& diagnostics);

/// rows x 2: node, component. Of a table of numbers or of a file that `bough matrices` wrote. Throws
/// InputError("cli.bad-table").
Eigen::MatrixXi read_dof_table(const std::string& path);
/// The list that `bough matrices` writes with its OUTPUT4 and Matrix Market files; empty without.
std::string find_dof_table(const std::string& path);

}  // namespace bough::analysis
