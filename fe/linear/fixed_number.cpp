#include "fe/linear/fixed_number.hpp"

#include <cstdint>

namespace bough::linear {

double calc_fixed_number(int index, int start) {
  // splitmix64, a public-domain mixer by S. Vigna.
  std::uint64_t z = (static_cast<std::uint64_t>(index) + 1) * 0x9E3779B97F4A7C15ULL +
                    static_cast<std::uint64_t>(start) * 0xD1B54A32D192ED03ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return 2.0 * (static_cast<double>(z >> 11) * 0x1p-53) - 1.0;
}

}  // namespace bough::linear
