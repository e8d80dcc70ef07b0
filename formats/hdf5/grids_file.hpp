#pragma once
/// \file The grids of any HDF5 file that keeps them as Bough's files do: /grids/id and /grids/xyz.
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::hdf5 {

struct GridsFile {
  std::vector<int> id;
  Eigen::MatrixXd xyz;  ///< g x 3
};

/// Empty if the file has no /grids. Throws InputError "hdf5.cannot-open", "hdf5.truncated", "hdf5.shape",
/// "hdf5.nan".
std::optional<GridsFile> read_grids(const std::string& path);
/// The root attribute `format`; empty without.
std::string read_format(const std::string& path);

}  // namespace bough::hdf5
