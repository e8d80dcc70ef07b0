#pragma once
/// \file Dimension scales of HDF5 ("HDF5 Dimension Scale Specification", The HDF Group, 2005): coordinates of the
/// rows of an array, for programs that read them (h5py's `dims`, netCDF, xarray). The H5DS functions of the library
/// write the list of users again for each user, which is O(n²) for n channels; here all users are known beforehand.
#include <string>
#include <vector>

#include "formats/hdf5/detail/handle.hpp"

namespace bough::hdf5 {

/// Limit of the list of users of a scale: 16 bytes each, and 64 kB per attribute.
inline constexpr std::size_t kMaxUsers = 4000;

/// Makes the dataset `scale` the scale of the first dimension of the datasets `users`, whose ranks are 1 or more; false
/// where an attribute cannot be written. An attribute holds 64 kB: beyond some thousand users each still names the
/// scale, while the scale's own list is left out.
bool attach_scale(hid_t file, const std::string& scale, const std::vector<std::string>& users);

}  // namespace bough::hdf5
