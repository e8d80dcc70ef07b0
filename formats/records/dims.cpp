#include "formats/records/dims.hpp"

#include <charconv>
#include <sstream>

#include "base/platform.hpp"

namespace bough::records {

std::optional<std::array<double, 3>> parse_dims(const std::string& text) {
  std::array<double, 3> all{};
  double sign = 1;
  std::string spaced;
  for (const char c : text) spaced += c == '/' ? std::string(" / ") : std::string(1, c);
  std::istringstream words(spaced);
  std::string word;
  while (words >> word) {
    if (word == "/") {
      sign = -1;
      continue;
    }
    double power = sign;
    if (const auto hat = word.find('^'); hat != std::string::npos) {
      double value = 0;
      const auto [end, failed] = platform::read_number(word.data() + hat + 1, word.data() + word.size(), value);
      if (failed != std::errc() || end != word.data() + word.size()) return {};
      power = sign * value;
      word.resize(hat);
    }
    if (word == "1") continue;
    if (word == "M")
      all[0] += power;
    else if (word == "L")
      all[1] += power;
    else if (word == "T")
      all[2] += power;
    else if (word == "F")
      all[0] += power, all[1] += power, all[2] -= 2 * power;
    else
      return {};
  }
  return all;
}

}  // namespace bough::records
