#include "base/words.hpp"

namespace bough {

std::string count(std::size_t number, const std::string& noun) {
  if (number == 1) return "1 " + noun;
  const bool is_y = noun.ends_with('y');
  return std::to_string(number) + " " + (is_y ? noun.substr(0, noun.size() - 1) + "ies" : noun + "s");
}

}  // namespace bough
