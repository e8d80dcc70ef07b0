#pragma once
/// \file Random numbers of a seed.
#include <random>

namespace bough::test {

template <class Engine>
class Draws {
 public:
  explicit Draws(unsigned seed) : random_(seed) {}
  /// An integer from low to high.
  int draw(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

 protected:
  Engine random_;
};

}  // namespace bough::test
