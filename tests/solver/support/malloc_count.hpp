#pragma once
/// \file Calls of malloc in this program so far: Eigen's, the library's and SUNDIALS' (glibc, no sanitizer).
namespace bough::solver::testing {

/// -1 when this build cannot count.
long get_malloc_count();

}  // namespace bough::solver::testing
