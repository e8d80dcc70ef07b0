#pragma once
/// \file Random numbers by counting: the number at (seed, stream, index) depends on nothing else, so that a run that is
/// resumed draws what the unbroken one would have drawn.
#include <cstdint>
#include <string>

namespace bough::solver {

/// Philox 2x64 with ten rounds (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC11), then Box and
/// Muller: normal, mean 0, deviation 1.
double calc_normal(std::uint64_t seed, std::uint64_t stream, std::uint64_t index);
/// FNV-1a, for a stream's number from its name.
std::uint64_t calc_stream(const std::string& name);

}  // namespace bough::solver
