#include "solver/sensors/noise.hpp"

#include <cmath>
#include <numbers>

namespace bough::solver {
namespace {

struct Pair {
  std::uint64_t a, b;
};

Pair calc_philox(Pair counter, std::uint64_t key) {
  for (int round = 0; round < 10; ++round) {
    __extension__ using Wide = unsigned __int128;
    const Wide product = static_cast<Wide>(0xD2B74407B1CE6E93ULL) * counter.a;
    counter = {static_cast<std::uint64_t>(product >> 64) ^ key ^ counter.b, static_cast<std::uint64_t>(product)};
    key += 0x9E3779B97F4A7C15ULL;
  }
  return counter;
}

/// In (0, 1), never an end of it.
double to_unit(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53; }

}  // namespace

double calc_normal(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  const Pair random = calc_philox({index, stream}, seed);
  return std::sqrt(-2 * std::log(to_unit(random.a))) * std::cos(2 * std::numbers::pi * to_unit(random.b));
}

std::uint64_t calc_stream(const std::string& name) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  return hash;
}

}  // namespace bough::solver
