#pragma once
/// \file One process that works on files of other libraries (HDF5, MATLAB), one after another, until one of them ends
/// it: a process each, as the program has it, costs a fuzzer ten times the reading.
#include "base/apart.hpp"

namespace bough::fuzz {

/// For set_apart_worker. A file that takes more than 15 ms of computing comes to no end.
Apart work_by_one_process(const std::string& path, ApartTask task, const ApartLimits& limits,
                          const std::string& library);

}  // namespace bough::fuzz
