#include "formats/nastran/detail/sections.hpp"

#include <array>
#include <utility>

namespace bough::nastran::detail {
namespace {

constexpr std::array<std::pair<std::string_view, int>, 22> shapes{{
    {"ROD", 1},   {"TUBE", 2}, {"TUBE2", 2}, {"I", 6},    {"CHAN", 4},  {"T", 4}, {"BOX", 4},   {"BAR", 2},
    {"CROSS", 4}, {"H", 4},    {"T1", 4},    {"I1", 4},   {"CHAN1", 4}, {"Z", 4}, {"CHAN2", 4}, {"T2", 4},
    {"BOX1", 6},  {"HEXA", 3}, {"HAT", 4},   {"HAT1", 5}, {"DBOX", 10}, {"L", 4},
}};

}  // namespace

int get_num_dimensions(std::string_view shape) {
  for (const auto& [name, count] : shapes)
    if (name == shape) return count;
  return 0;
}

std::vector<std::string> get_shapes() {
  std::vector<std::string> names;
  for (const auto& [name, count] : shapes) names.emplace_back(name);
  return names;
}

}  // namespace bough::nastran::detail
