#pragma once
/// \file One process that looks at HDF5 files, one after another, until one of them ends it: a process each, as the
/// program has it, costs a fuzzer ten times the reading.
#include "formats/hdf5/detail/inspect.hpp"

namespace bough::fuzz {

/// For hdf5::set_looker. A file that takes more than 40 ms of computing comes to no end.
hdf5::Look look_by_one_process(const std::string& path, double size);

}  // namespace bough::fuzz
