#include "fe/sections/section_library.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/diagnostic.hpp"
#include "fe/sections/section_shapes.hpp"

namespace bough::fe {
namespace {

using namespace section_shapes;

struct Shape {
  int num_dims;
  bool (*fits)(const Dims& d);  ///< beyond every dimension being positive
  LibrarySection (*calc)(const Dims& d);
};

const std::map<std::string, Shape>& get_shapes() {
  static const auto any = [](const Dims&) { return true; };
  static const std::map<std::string, Shape> shapes = {
      {"ROD", {1, any, calc_rod}},
      {"TUBE", {2, [](const Dims& d) { return d[1] < d[0]; }, [](const Dims& d) { return calc_annulus(d[0], d[1]); }}},
      {"TUBE2",
       {2, [](const Dims& d) { return d[1] <= d[0]; }, [](const Dims& d) { return calc_annulus(d[0], d[0] - d[1]); }}},
      {"BAR", {2, any, calc_bar}},
      {"HEXA", {3, [](const Dims& d) { return d[1] > 2 * d[0]; }, calc_hexa}},
      {"I",
       {6, [](const Dims& d) { return d[4] + d[5] < d[0] && d[3] < d[1] && d[3] < d[2]; },
        [](const Dims& d) { return calc_i(d[0], d[1], d[2], d[3], d[4], d[5]); }}},
      {"I1",
       {4, [](const Dims& d) { return d[2] < d[3]; },
        [](const Dims& d) {
          const double w = d[0] + d[1], t = (d[3] - d[2]) / 2;
          return calc_i(d[3], w, w, d[1], t, t);
        }}},
      {"CHAN",
       {4, [](const Dims& d) { return 2 * d[3] < d[1] && d[2] < d[0]; },
        [](const Dims& d) { return calc_channel(d[0], d[1], d[2], d[3]); }}},
      {"CHAN1",
       {4, [](const Dims& d) { return d[2] < d[3]; },
        [](const Dims& d) { return calc_channel(d[0] + d[1], d[3], d[1], (d[3] - d[2]) / 2); }}},
      {"CHAN2", {4, [](const Dims& d) { return 2 * d[0] < d[3] && d[1] < d[2]; }, calc_chan2}},
      {"T",
       {4, [](const Dims& d) { return d[2] < d[1] && d[3] < d[0]; },
        [](const Dims& d) { return calc_tee(d[0], d[1], d[2], d[3], 1); }}},
      {"T1", {4, [](const Dims& d) { return d[3] < d[0]; }, calc_t1}},
      {"T2",
       {4, [](const Dims& d) { return d[2] < d[1] && d[3] < d[0]; },
        [](const Dims& d) { return calc_tee(d[0], d[1], d[2], d[3], -1); }}},
      {"CROSS", {4, [](const Dims& d) { return d[3] < d[2]; }, calc_cross}},
      {"H", {4, [](const Dims& d) { return d[3] < d[2]; }, calc_h}},
      {"Z", {4, [](const Dims& d) { return d[2] < d[3]; }, calc_z}},
      {"L", {4, [](const Dims& d) { return d[3] < d[0] && d[2] < d[1]; }, calc_l}},
      {"BOX",
       {4, [](const Dims& d) { return 2 * d[2] < d[1] && 2 * d[3] < d[0]; },
        [](const Dims& d) { return calc_box(d[0], d[1], d[2], d[2], d[3], d[3]); }}},
      {"BOX1",
       {6, [](const Dims& d) { return d[2] + d[3] < d[1] && d[4] + d[5] < d[0]; },
        [](const Dims& d) { return calc_box(d[0], d[1], d[2], d[3], d[5], d[4]); }}},
      {"DBOX",
       {10,
        [](const Dims& d) {
          return d[3] + d[4] / 2 < d[2] && d[2] + d[4] / 2 + d[5] < d[0] && d[6] + d[7] < d[1] && d[8] + d[9] < d[1];
        },
        calc_dbox}},
      {"HAT", {4, [](const Dims& d) { return 2 * d[1] < d[0] && 2 * d[1] < d[2]; }, calc_hat}},
      {"HAT1", {5, [](const Dims& d) { return 2 * d[3] + d[4] < d[1] && d[2] < d[0] && 2 * d[3] < d[2]; }, calc_hat1}},
  };
  return shapes;
}

constexpr double kRoundTolerance = 0.01;  // of I1 = I2 and J = I1 + I2, which decks give to a few digits

bool is_near(double a, double b) { return std::abs(a - b) <= kRoundTolerance * std::max(std::abs(a), std::abs(b)); }

}  // namespace

std::vector<std::string> list_section_shapes() {
  std::vector<std::string> names;
  for (const auto& [name, shape] : get_shapes()) names.push_back(name);
  return names;
}

std::optional<LibrarySection> calc_library_section(const std::string& shape, const std::vector<double>& dims,
                                                   std::string* problem) {
  const auto it = get_shapes().find(shape);
  if (it == get_shapes().end()) {
    const std::string nearest = find_nearest(shape, list_section_shapes());
    *problem = "has the unknown section shape " + shape + (nearest.empty() ? "" : ", did you mean " + nearest);
    return std::nullopt;
  }
  if (static_cast<int>(dims.size()) != it->second.num_dims) {
    *problem = "gives " + std::to_string(dims.size()) + " dimensions to a " + shape + ", expected " +
               std::to_string(it->second.num_dims);
    return std::nullopt;
  }
  for (std::size_t k = 0; k < dims.size(); ++k) {
    if (dims[k] > 0 || (dims[k] == 0 && shape == "TUBE" && k == 1)) continue;
    *problem = "has a dimension of " + shape + " that is not positive";
    return std::nullopt;
  }
  if (!it->second.fits(dims)) {
    *problem = "has dimensions of " + shape + " that do not fit each other";
    return std::nullopt;
  }
  return it->second.calc(dims);
}

std::optional<EquivalentSection> find_equivalent_section(double A, double I1, double I2, double I12, double J) {
  using enum EquivalentSection::Kind;
  if (!(A > 0) || !std::isfinite(A)) return std::nullopt;
  const EquivalentSection circle{Circle, 2 * std::sqrt(A / std::numbers::pi), 0, 0};
  const double mean = (I1 + I2) / 2, radius = std::hypot((I1 - I2) / 2, I12);
  if (!(mean - radius > 0) || !std::isfinite(mean)) return circle;
  if (radius <= kRoundTolerance * mean && is_near(J, 2 * mean)) {
    // A = pi (R^2 - r^2), I = A (R^2 + r^2) / 4
    const double sum = 4 * mean / A, difference = A / std::numbers::pi;
    const double inner = sum - difference;
    if (inner > -kRoundTolerance * sum)
      return EquivalentSection{Ring, 2 * std::sqrt((sum + difference) / 2),
                               inner > 2 * kRoundTolerance * sum ? 2 * std::sqrt(inner / 2) : 0, 0};
  }
  // The I of bending along the axis at `angle` from y is largest there: I(angle) = mean + radius.
  const double angle = radius > 0 ? 0.5 * std::atan2(2 * I12, I1 - I2) : 0;
  return EquivalentSection{Rectangle, std::sqrt(12 * (mean + radius) / A), std::sqrt(12 * (mean - radius) / A), angle};
}

std::vector<SectionFace> list_faces(const EquivalentSection& section) {
  if (section.kind != EquivalentSection::Kind::Rectangle)
    return section_shapes::make_round_faces(section.d1 / 2, section.d2 / 2);
  const Eigen::Rotation2Dd turn(section.angle);
  const double a = section.d1 / 2, b = section.d2 / 2;
  return {{turn * Eigen::Vector2d(a, -b), turn * Eigen::Vector2d(a, b), turn * Eigen::Vector2d(-a, b),
           turn * Eigen::Vector2d(-a, -b)}};
}

}  // namespace bough::fe
