#pragma once
/// \file Check of the available memory before a computation.
#include <string>

namespace bough::linear {

/// Bytes that this process may still take: of the system (free, in caches that it gives up, swapped), below a limit of
/// its address space (ulimit -v) and of its control groups (version 2). Infinity where the system tells none of them.
double calc_free_memory();

/// Bytes in a unit that a person reads: "31 GB", "1.4 GB", "240 MB".
std::string format_bytes(double bytes);

/// Bytes of a supernodal LLᵀ whose columns hold the given number of entries: supernodes are merged, which adds a tenth
/// or two, and one front more is worked on.
double calc_factor_bytes(double num_entries);

/// Throws ComputationError "fe.out-of-memory" where a factor of that size needs more than `free_bytes`.
void require_memory(double num_equations, double num_entries, double free_bytes);

/// Returns free pages, which the C library keeps, to the system before the step with the largest memory.
void release_freed_memory();

}  // namespace bough::linear
