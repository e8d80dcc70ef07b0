#pragma once
/// \file Dimension scales of HDF5 ("HDF5 Dimension Scale Specification", The HDF Group, 2005): what the rows of an
/// array stand at, for programs that look for it (h5py's `dims`, netCDF, xarray). The library's own H5DS functions
/// write the list of a scale's users anew for each of them, which is n² for n channels; here all are known beforehand.
#include <string>
#include <vector>

#include "formats/hdf5/detail/handle.hpp"

namespace bough::hdf5 {

/// Makes the dataset `scale` the scale of the first dimension of the datasets `users`, whose ranks are 1 or more; false
/// where an attribute cannot be written. An attribute holds 64 kB: beyond some thousand users each still names the
/// scale, while the scale's own list is left out.
bool attach_scale(hid_t file, const std::string& scale, const std::vector<std::string>& users);

}  // namespace bough::hdf5
