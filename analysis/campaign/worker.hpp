#pragma once
/// \file A process that takes case after case: MPI and PETSc start once, the commands run in it.
#include <functional>

#include "analysis/campaign/batch_outcome.hpp"

namespace bough::analysis {

/// Runs a command line, its words without the program's name; returns the exit code.
using RunCommand = std::function<int(const std::vector<std::string>& words)>;

/// Does a case in its folder below `folder`, emptied first: files, steps (what step k prints goes to step-k.out and
/// step-k.err), outputs.
BatchOutcome run_case(const BatchPlan& plan, const BatchCase& one, const std::filesystem::path& folder,
                      const RunCommand& run);

/// The error that the last step of the case in `here` printed; empty without any.
std::string find_printed_error(const BatchPlan& plan, const std::filesystem::path& here);

/// Reads case numbers, one a line, from the socket `fd`, answers each with the outcome as a line of JSON; 0 when the
/// other side has closed it. `may_leave`: the steps may write outside the case's folder.
int serve_cases(const BatchPlan& plan, const std::filesystem::path& folder, int fd, bool may_leave,
                const RunCommand& run);

}  // namespace bough::analysis
