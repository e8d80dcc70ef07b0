#include "report/pack.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace bough::report {

static_assert(std::endian::native == std::endian::little, "the arrays of the page are little-endian");

namespace {

constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string encode_base64(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string text((size + 2) / 3 * 4, '=');
  std::size_t at = 0;
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t left = std::min<std::size_t>(3, size - i);
    const std::uint32_t b = static_cast<std::uint32_t>(bytes[i]) << 16 |
                            (left > 1 ? static_cast<std::uint32_t>(bytes[i + 1]) << 8 : 0U) |
                            (left > 2 ? static_cast<std::uint32_t>(bytes[i + 2]) : 0U);
    for (std::size_t k = 0; k <= left; ++k) text[at + k] = kDigits[b >> (18 - 6 * k) & 63];
    at += 4;
  }
  return text;
}

PackedColumn pack_column(const Eigen::Ref<const Eigen::VectorXd>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool has_gaps = false;
  for (const double v : values) {
    if (!std::isfinite(v)) {
      has_gaps = true;
      continue;
    }
    low = std::min(low, v);
    high = std::max(high, v);
  }
  PackedColumn packed;
  if (low > high) low = high = 0;
  packed.low = low;
  if (low == high && !has_gaps) return packed;
  // Halves first: the difference of two large numbers may overflow.
  packed.step = (high / 2 - low / 2) / ((PackedColumn::kMissing - 1) / 2.0);
  if (low < 0 && high > 0 && packed.step < 1e290) {
    // Zero stays zero: it is a whole number of steps above the minimum.
    packed.step *= 1 + 1e-6;
    packed.low = low = -packed.step * std::ceil(-low / packed.step);
  }
  std::vector<unsigned char> bytes;
  bytes.reserve(3 * static_cast<std::size_t>(values.size()));
  for (const double v : values) {
    std::uint32_t code = PackedColumn::kMissing;
    if (std::isfinite(v))
      code = packed.step > 0 ? static_cast<std::uint32_t>(std::lround((v / 2 - low / 2) / packed.step * 2)) : 0;
    for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<unsigned char>(code >> shift));
  }
  packed.data = encode_base64(bytes.data(), bytes.size());
  return packed;
}

PackedIndices pack_ascending(const std::vector<Eigen::Index>& indices) {
  Eigen::Index largest = 0, before = 0;
  for (const auto i : indices) {
    largest = std::max(largest, i - before);
    before = i;
  }
  PackedIndices packed;
  while (packed.digits < 10 && largest >> (6 * packed.digits) > 0) ++packed.digits;
  before = 0;
  for (const auto i : indices) {
    for (int k = packed.digits - 1; k >= 0; --k) packed.data += kDigits[(i - before) >> (6 * k) & 63];
    before = i;
  }
  return packed;
}

std::string pack_floats(const Eigen::Ref<const Eigen::VectorXd>& values) {
  const Eigen::VectorXf floats = values.cast<float>();
  return encode_base64(floats.data(), sizeof(float) * static_cast<std::size_t>(floats.size()));
}

std::string pack_indices(const std::vector<std::uint32_t>& values) {
  return encode_base64(values.data(), sizeof(std::uint32_t) * values.size());
}

std::string pack_doubles(const Eigen::Ref<const Eigen::VectorXd>& values) {
  const Eigen::VectorXd whole = values;
  return encode_base64(whole.data(), sizeof(double) * static_cast<std::size_t>(whole.size()));
}

std::string pack_shorts(const Eigen::Ref<const Eigen::VectorXd>& values, double largest) {
  std::vector<std::int16_t> shorts;
  shorts.reserve(static_cast<std::size_t>(values.size()));
  const double scale = largest > 0 ? 32767 / largest : 0;
  for (const double v : values)
    shorts.push_back(std::isfinite(v) ? static_cast<std::int16_t>(std::lround(v * scale)) : std::int16_t{0});
  return encode_base64(shorts.data(), sizeof(std::int16_t) * shorts.size());
}

}  // namespace bough::report
