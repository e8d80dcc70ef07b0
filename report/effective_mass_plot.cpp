#include "report/effective_mass_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "report/html.hpp"

namespace bough::report {

namespace {

constexpr std::array<const char*, 6> kDirections{"x", "y", "z", "rx", "ry", "rz"};
constexpr double kLeft = 44, kTop = 34, kWidth = 560, kRight = 76, kBar = 16, kRow = 22;
constexpr double kMinShare = 1e-4;        // narrower than a line
constexpr double kMinWidthOfNumber = 20;  // px

std::string draw_axis(double height) {
  std::string svg = "<g fill=\"#555555\" text-anchor=\"middle\">\n";
  for (const int percent : {0, 25, 50, 75, 100}) {
    const double x = kLeft + kWidth * percent / 100;
    svg +=
        fmt::format("<path d=\"M{0:.1f} {1}V{2:.1f}\" stroke=\"#d9d9d9\"/><text x=\"{0:.1f}\" y=\"{3}\">{4} %</text>\n",
                    x, kTop - 6, height - 6, kTop - 12, percent);
  }
  return svg + "</g>\n";
}

/// The bar of direction k, and its sum at the end.
std::string draw_bar(const ModalModel& m, Eigen::Index k, double whole) {
  const double y = kTop + kRow * static_cast<double>(k), middle = y + kBar / 2 + 4;
  std::string svg = fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", kLeft - 8, middle,
                                kDirections[static_cast<std::size_t>(k)]);
  double sum = 0;
  for (Eigen::Index j = 0; j < m.effective_mass.rows(); ++j) {
    const double share = m.effective_mass(j, k) / whole, from = std::min(1.0, sum);
    sum += share;
    const double width = kWidth * (std::min(1.0, sum) - from), x = kLeft + kWidth * from;
    if (!(share > kMinShare)) continue;
    svg += fmt::format(
        "<rect class=\"share\" x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.3f}\" height=\"{}\" fill=\"{}\" stroke=\"#ffffff\" "
        "stroke-width=\"0.6\"><title>mode {}, {} Hz: {} % in {}</title></rect>\n",
        x, y, width, kBar, j % 2 == 0 ? "#0072B2" : "#56B4E9", j + 1, format_value(m.frequency_hz[j], 5),
        format_value(100 * share, 4), kDirections[static_cast<std::size_t>(k)]);
    if (width > kMinWidthOfNumber)
      svg +=
          fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-size=\"11\" fill=\"{}\">{}</text>\n",
                      x + width / 2, middle, j % 2 == 0 ? "#ffffff" : "#111111", j + 1);
  }
  return svg + fmt::format("<text x=\"{}\" y=\"{:.1f}\">{:.1f} %</text>\n", kLeft + kWidth + 10, middle, 100 * sum);
}

}  // namespace

std::string draw_effective_mass(const ModalModel& model) {
  if (model.effective_mass.rows() == 0 || model.effective_mass.rows() != model.frequency_hz.size()) return {};
  Eigen::Matrix<double, 6, 1> whole;
  whole << model.mass, model.mass, model.mass, model.inertia.diagonal();
  const double width = kLeft + kWidth + kRight, height = kTop + 6 * kRow + 4;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "role=\"img\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" font-size=\"12\">"
      "<title>Effective mass of the modes by direction</title>\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"#ffffff\"/>\n",
      width, height);
  svg += draw_axis(height);
  for (Eigen::Index k = 0; k < 6; ++k)
    if (whole[k] > 0) svg += draw_bar(model, k, whole[k]);
  return "<figure class=\"effective-mass\">" + svg + "</svg></figure>\n";
}

}  // namespace bough::report
