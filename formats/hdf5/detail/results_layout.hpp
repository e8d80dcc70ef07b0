#pragma once
/// \file Where things are in a results file; shared by its writer and its reader.
#include <cstdint>
#include <cstring>

#include <Eigen/Dense>

namespace bough::hdf5 {

inline constexpr const char* kResultsFormat = "bough-results";
inline constexpr const char* kChecksum = "checksum";
/// Root attribute: samples that every channel has for certain.
inline constexpr const char* kNumSamples = "num_samples";

/// FNV-1a over the bytes of a checkpoint: tells a whole one from one that a kill cut in the middle.
inline std::int64_t calc_checksum(double time, const Eigen::VectorXd& state) {
  std::uint64_t hash = 14695981039346656037ull;
  auto add = [&](double x) {
    unsigned char bytes[sizeof x];
    std::memcpy(bytes, &x, sizeof x);
    for (const unsigned char b : bytes) hash = (hash ^ b) * 1099511628211ull;
  };
  add(time);
  for (const double x : state) add(x);
  return static_cast<std::int64_t>(hash);
}

}  // namespace bough::hdf5
