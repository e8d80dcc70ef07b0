#pragma once
/// \file Where things are in a results file; shared by its writer and its reader.
#include <cstdint>
#include <cstring>
#include <map>

#include "formats/records/results.hpp"

namespace bough::hdf5 {

inline constexpr const char* kResultsFormat = "bough-results";
inline constexpr const char* kChecksum = "checksum";
/// Root attribute: samples that every channel has for certain.
inline constexpr const char* kNumSamples = "num_samples";

/// Attribute of a checkpoint, next to kNumSamples: number of events before it.
inline constexpr const char* kNumEvents = "num_events";
/// Root attribute: seconds from the start of the run to its end, all its parts.
inline constexpr const char* kWallTime = "wall_time";
/// Attribute of /energy.
inline constexpr const char* kEnergyError = "energy_error";

/// FNV-1a over the bytes of a checkpoint: tells a whole one from one that a kill cut in the middle. Its memory in the
/// order of the names; parts without numbers are not in the file.
inline std::int64_t calc_checksum(const records::Checkpoint& checkpoint) {
  std::uint64_t hash = 14695981039346656037ull;
  auto add = [&](double x) {
    unsigned char bytes[sizeof x];
    std::memcpy(bytes, &x, sizeof x);
    for (const unsigned char b : bytes) hash = (hash ^ b) * 1099511628211ull;
  };
  add(checkpoint.time);
  for (const double x : checkpoint.state) add(x);
  std::map<std::string, const Eigen::VectorXd*> parts;
  for (const auto& [name, values] : checkpoint.memory) parts[name] = &values;
  for (const auto& [name, values] : parts) {
    for (const double x : *values) add(x);
  }
  return static_cast<std::int64_t>(hash);
}

}  // namespace bough::hdf5
