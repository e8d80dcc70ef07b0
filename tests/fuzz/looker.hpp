#pragma once
/// \file One process that works on files of other libraries (HDF5, MATLAB), one after another, until one of them ends
/// it: a process each, as the program has it, costs a fuzzer ten times the reading.
#include "base/isolated.hpp"

namespace bough::fuzz {

/// For set_isolated_runner. A file that takes more than 15 ms of computing counts as endless.
IsolatedResult work_by_one_process(const std::string& path, IsolatedTask task, const IsolationLimits& limits,
                                   const std::string& library);

}  // namespace bough::fuzz
