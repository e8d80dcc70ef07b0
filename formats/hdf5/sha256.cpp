// SHA-256 of FIPS 180-4, section 6.2.
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>

#include "base/diagnostic.hpp"
#include "base/input_bytes.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {

namespace {

constexpr std::array<std::uint32_t, 64> kRoundConstants{
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

class Sha256 {
 public:
  /// Whole blocks of 64 bytes.
  void add_block(const unsigned char* block) {
    std::array<std::uint32_t, 64> w;
    for (std::size_t t = 0; t < 16; ++t) {
      w[t] = std::uint32_t{block[4 * t]} << 24 | std::uint32_t{block[4 * t + 1]} << 16 |
             std::uint32_t{block[4 * t + 2]} << 8 | std::uint32_t{block[4 * t + 3]};
    }
    for (std::size_t t = 16; t < 64; ++t) {
      const std::uint32_t s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ (w[t - 15] >> 3);
      const std::uint32_t s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ (w[t - 2] >> 10);
      w[t] = w[t - 16] + s0 + w[t - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = hash_;
    for (std::size_t t = 0; t < 64; ++t) {
      const std::uint32_t t1 = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) + ((e & f) ^ (~e & g)) +
                               kRoundConstants[t] + w[t];
      const std::uint32_t t2 = (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
      h = g;
      g = f;
      f = e;
      e = d + t1;
      d = c;
      c = b;
      b = a;
      a = t1 + t2;
    }
    const std::array<std::uint32_t, 8> change{a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < 8; ++i) hash_[i] += change[i];
  }

  /// The last bytes (fewer than 64), padding and length.
  std::string finish(const unsigned char* rest, std::size_t size, std::uint64_t total_bytes) {
    std::array<unsigned char, 128> block{};
    std::copy(rest, rest + size, block.begin());
    block[size] = 0x80;
    const std::size_t length = size < 56 ? 64 : 128;
    for (std::size_t i = 0; i < 8; ++i) {
      block[length - 1 - i] = static_cast<unsigned char>(total_bytes * 8 >> (8 * i));
    }
    for (std::size_t at = 0; at < length; at += 64) add_block(block.data() + at);
    std::string hex;
    for (const std::uint32_t word : hash_) {
      for (int shift = 28; shift >= 0; shift -= 4) hex += "0123456789abcdef"[word >> shift & 15];
    }
    return hex;
  }

 private:
  std::array<std::uint32_t, 8> hash_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                     0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
};

}  // namespace

std::string calc_sha256(const std::string& path) {
  if (const auto kept = find_input(path)) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(kept->data());
    const std::size_t whole = kept->size() / 64 * 64;
    Sha256 sha;
    for (std::size_t at = 0; at < whole; at += 64) sha.add_block(bytes + at);
    return sha.finish(bytes + whole, kept->size() - whole, kept->size());
  }
  std::ifstream in(path, std::ios::binary);
  std::vector<char> buffer(1 << 16);
  if (!in || (in.read(buffer.data(), 1), in.bad())) {
    throw InputError("hdf5.cannot-open", {path}, "the file cannot be opened", "check its path and permissions");
  }
  in.clear();
  in.seekg(0);
  Sha256 sha;
  std::uint64_t total = 0;
  for (;;) {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    const auto size = static_cast<std::size_t>(in.gcount());
    const auto* bytes = reinterpret_cast<const unsigned char*>(buffer.data());
    total += size;
    std::size_t at = 0;
    for (; at + 64 <= size; at += 64) sha.add_block(bytes + at);
    if (size < buffer.size()) return sha.finish(bytes + at, size - at, total);
  }
}

}  // namespace bough::hdf5
