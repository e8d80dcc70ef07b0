#pragma once
/// \file Files that libbough.so reads with the system file: .FLX, flat bodies, matrices in the system file itself.
#include "embed/load.hpp"

namespace bough::embed {

/// Readers of flat and .FLX bodies. They throw InputError "embed.hdf5" for HDF5 bodies, "embed.body-format" for others.
FileReaders get_file_readers();

}  // namespace bough::embed
