#pragma once

namespace bough::cli {

/// Under a limit of the address space (ulimit -v): linear algebra on one thread, and its work space set aside before
/// the work begins, because OpenBLAS waits without end for memory that it does not get. Throws ComputationError
/// "cli.no-memory" when there is not enough to start with. Starts the program again when the threads are there already.
void prepare_for_memory_limit(char** arguments);
/// Takes the work space of BLAS now, if the address space is limited; it stays for later products. Throws
/// "cli.no-memory".
void set_work_space_aside();

}  // namespace bough::cli
