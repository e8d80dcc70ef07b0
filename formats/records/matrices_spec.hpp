#pragma once
/// \file [body.matrices] of a body file: where matrices and mode shapes of another program are.
#include <array>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::records {

/// "FILE", "FILE:NAME", or ":NAME" of the common file.
struct MatrixSource {
  std::string file;  ///< resolved
  std::string name;  ///< empty: the file's only matrix, or its only one of a usual name
  /// Returns true if no file is named.
  bool empty() const { return file.empty(); }
};

/// Axes of the rows of a grid.
enum class MatrixAxes {
  Auto,          ///< basic for Bough's own HDF5 files, displacement systems otherwise
  Displacement,  ///< CD of the deck's grids, as Nastran writes
  Basic
};

/// A K_G that another program computed for a load.
struct GeometricSource {
  std::string name;
  MatrixSource matrix;
  MatrixSource load;            ///< the load it belongs to, num_dofs x columns; may be empty
  int load_column = 1;          ///< 1-based
  int node = 0, direction = 0;  ///< or a unit load there
  int load_set = 0;             ///< or a load set of the deck
  SourceLocation at;
};

struct MatricesSpec {
  std::string file;  ///< common to the names without a file
  MatrixSource stiffness, mass, damping;
  MatrixSource modes;        ///< a matrix num_dofs x n, or an OP2 or punch file; empty: solved for
  MatrixSource check_modes;  ///< the same kinds, compared with the body's
  std::string dofs;          ///< table of node and component, a line per row; empty: the file's own, or the g-set
  std::string grids;         ///< table of id x y z, or HDF5; empty: the deck, or the stiffness file
  MatrixAxes axes = MatrixAxes::Auto;
  double mass_scale = 1;
  std::vector<int> clamped;  ///< grids held in all six components besides the deck's SPC set
  std::array<MatrixSource, kNumInertialLoads> inertial;
  std::vector<GeometricSource> geometric;
  SourceLocation at;
};

}  // namespace bough::records
