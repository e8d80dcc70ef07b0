#include "bough/fe/elements/section_library.hpp"

#include <cmath>
#include <map>
#include <numbers>

namespace bough::fe {
namespace {

using Dims = std::vector<double>;
constexpr double kPi = std::numbers::pi;

struct Shape {
  int num_dims;
  bool (*fits)(const Dims& d);              ///< beyond every dimension being positive
  LibrarySection (*calc)(const Dims& d);
};

/// Saint-Venant torsion of a solid a x b rectangle, b <= a (Roark, Formulas for Stress and Strain, table 10.1 case 4).
double calc_rectangle_torsion(double p, double q) {
  const double a = std::max(p, q) / 2, b = std::min(p, q) / 2;
  return a * b * b * b * (16.0 / 3 - 3.36 * b / a * (1 - std::pow(b / a, 4) / 12));
}

LibrarySection calc_rod(const Dims& d) {
  LibrarySection s;
  const double r = d[0];
  s.A = kPi * r * r;
  s.I1 = s.I2 = kPi * std::pow(r, 4) / 4;
  s.J = 2 * s.I1;
  s.k1 = s.k2 = 0.9;
  return s;
}

LibrarySection calc_tube(const Dims& d) {
  LibrarySection s;
  s.A = kPi * (d[0] * d[0] - d[1] * d[1]);
  s.I1 = s.I2 = kPi / 4 * (std::pow(d[0], 4) - std::pow(d[1], 4));
  s.J = 2 * s.I1;
  s.k1 = s.k2 = 0.5;
  return s;
}

LibrarySection calc_bar(const Dims& d) {
  LibrarySection s;
  s.A = d[0] * d[1];
  s.I1 = d[0] * std::pow(d[1], 3) / 12;
  s.I2 = d[1] * std::pow(d[0], 3) / 12;
  s.J = calc_rectangle_torsion(d[0], d[1]);
  s.k1 = s.k2 = 5.0 / 6;
  return s;
}

const std::map<std::string, Shape>& get_shapes() {
  static const std::map<std::string, Shape> shapes = {
      {"ROD", {1, [](const Dims&) { return true; }, calc_rod}},
      {"TUBE", {2, [](const Dims& d) { return d[1] < d[0]; }, calc_tube}},
      {"BAR", {2, [](const Dims&) { return true; }, calc_bar}},
  };
  return shapes;
}

}  // namespace

int get_num_dimensions(const std::string& shape) {
  const auto it = get_shapes().find(shape);
  return it == get_shapes().end() ? 0 : it->second.num_dims;
}

std::vector<std::string> list_section_shapes() {
  std::vector<std::string> names;
  for (const auto& [name, shape] : get_shapes()) names.push_back(name);
  return names;
}

std::optional<LibrarySection> calc_library_section(const std::string& shape, const std::vector<double>& dims,
                                                   std::string* problem) {
  const auto it = get_shapes().find(shape);
  if (it == get_shapes().end()) {
    *problem = "has the unknown section shape " + shape;
    return std::nullopt;
  }
  if (static_cast<int>(dims.size()) != it->second.num_dims) {
    *problem = "gives " + std::to_string(dims.size()) + " dimensions to a " + shape + ", expected " +
               std::to_string(it->second.num_dims);
    return std::nullopt;
  }
  for (double d : dims) {
    if (d > 0) continue;
    *problem = "has a dimension of " + shape + " that is not positive";
    return std::nullopt;
  }
  if (!it->second.fits(dims)) {
    *problem = "has dimensions of " + shape + " that do not fit each other";
    return std::nullopt;
  }
  return it->second.calc(dims);
}

}  // namespace bough::fe
