#pragma once
/// \file Numbers as text for the report page: base64 that its script unpacks into typed arrays (web/unpack.js).
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Dense>

namespace bough::report {

/// Encodes `size` bytes in base64 (RFC 4648, with padding).
std::string encode_base64(const void* data, std::size_t size);

/// A column of samples in 24 bits each, four characters a sample: value = low + code · step, big-endian codes; code
/// kMissing stands for what is not finite. The error is at most half a step, the range / 33 554 426.
struct PackedColumn {
  static constexpr std::uint32_t kMissing = 0xFFFFFF;
  double low = 0, step = 0;
  std::string data;  ///< empty where every sample is `low`
};
/// Packs samples so that 0 stays exact for a column with both signs.
PackedColumn pack_column(const Eigen::Ref<const Eigen::VectorXd>& values);

/// Ascending indices as differences, the first from zero: `digits` characters each of base 64, most significant first.
struct PackedIndices {
  int digits = 1;
  std::string data;
};
/// Packs ascending indices in as few digits as the largest difference needs.
PackedIndices pack_ascending(const std::vector<Eigen::Index>& indices);

/// Little-endian 32-bit floats, 32-bit unsigned integers, 64-bit floats.
std::string pack_floats(const Eigen::Ref<const Eigen::VectorXd>& values);
std::string pack_indices(const std::vector<std::uint32_t>& values);
std::string pack_doubles(const Eigen::Ref<const Eigen::VectorXd>& values);
/// 16-bit integers that stand for values times 32767 / largest.
std::string pack_shorts(const Eigen::Ref<const Eigen::VectorXd>& values, double largest);

}  // namespace bough::report
