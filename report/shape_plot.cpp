#include "report/shape_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/xml_text.hpp"

namespace bough::report {

namespace {

constexpr double kWidth = 420, kHeight = 300, kMargin = 14, kTop = 30, kAmplitude = 0.12;

/// Viridis (Smith & van der Walt 2015, CC0), five stops as in web/viewer.js.
std::string get_color(double level) {
  static constexpr std::array<std::array<double, 3>, 5> kStops{{{0.267, 0.005, 0.329},
                                                                {0.229, 0.322, 0.546},
                                                                {0.128, 0.567, 0.551},
                                                                {0.369, 0.789, 0.383},
                                                                {0.993, 0.906, 0.144}}};
  const double s = 4 * std::clamp(level, 0.0, 1.0);
  const auto i = std::min<std::size_t>(3, static_cast<std::size_t>(s));
  std::array<int, 3> color{};
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = static_cast<int>(
        std::lround(255 * (kStops[i][c] + (s - static_cast<double>(i)) * (kStops[i + 1][c] - kStops[i][c]))));
  return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
}

/// Rows: right, up and towards the eye. A flat body is seen from its side of largest area, a little turned.
Eigen::Matrix3d make_view(const Eigen::MatrixXd& xyz) {
  const Eigen::Vector3d extent = (xyz.colwise().maxCoeff() - xyz.colwise().minCoeff()).transpose();
  const bool is_in_xz = extent.y() < 0.05 * extent.norm() && extent.z() > 0.05 * extent.norm();
  const double yaw = is_in_xz ? -1.87 : -1.0, pitch = is_in_xz ? 0.2 : 0.5;
  const Eigen::Vector3d back(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch));
  const Eigen::Vector3d right(-std::sin(yaw), std::cos(yaw), 0);
  Eigen::Matrix3d view;
  view << right.transpose(), back.cross(right).transpose(), back.transpose();
  return view;
}

}  // namespace

std::string draw_shape(const Drawing& drawing, int shape, const std::string& title, double factor) {
  const Eigen::Index n = drawing.xyz.rows();
  if (n == 0) return "";
  Eigen::MatrixXd at = drawing.xyz;
  Eigen::VectorXd level = Eigen::VectorXd::Zero(n);
  const double size = (drawing.xyz.colwise().maxCoeff() - drawing.xyz.colwise().minCoeff()).norm();
  if (shape >= 0) {
    const auto& u = drawing.shapes.at(static_cast<std::size_t>(shape));
    level = u.rowwise().norm();
    if (const double largest = level.maxCoeff(); largest > 0) {
      at += (factor > 0 ? factor : kAmplitude * size / largest) * u;
      level /= largest;
    }
  }
  const Eigen::Matrix3d view = make_view(drawing.xyz);
  const Eigen::MatrixXd rest = drawing.xyz * view.transpose(), seen = at * view.transpose();
  const Eigen::Vector2d low = rest.leftCols<2>().colwise().minCoeff().cwiseMin(seen.leftCols<2>().colwise().minCoeff());
  const Eigen::Vector2d high =
      rest.leftCols<2>().colwise().maxCoeff().cwiseMax(seen.leftCols<2>().colwise().maxCoeff());
  const double width = kWidth - 2 * kMargin, height = kHeight - kTop - kMargin;
  const double scale = std::min(width / std::max(high.x() - low.x(), 1e-12 * size + 1e-300),
                                height / std::max(high.y() - low.y(), 1e-12 * size + 1e-300));
  const auto place = [&](const Eigen::MatrixXd& points, std::uint32_t k) {
    const double x = kMargin + width / 2 + scale * (points(k, 0) - (low.x() + high.x()) / 2);
    const double y = kTop + height / 2 - scale * (points(k, 1) - (low.y() + high.y()) / 2);
    return fmt::format("{:.1f} {:.1f}", x, y);
  };
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
      "role=\"img\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', "
      "sans-serif\">\n<title>{2}</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n<text x=\"{3:g}\" y=\"20\" font-size=\"14\" "
      "fill=\"#111111\">{2}</text>\n",
      kWidth, kHeight, escape_xml(title), kMargin);
  const std::size_t num_edges = drawing.edges.size() / 2, num_faces = drawing.triangles.size() / 3;
  const auto every_edge = std::max<std::size_t>(1, (num_edges + kMaxShapeEdges - 1) / kMaxShapeEdges);
  const auto draw_edges = [&](const Eigen::MatrixXd& points, const char* color, double opacity) {
    std::string path;
    for (std::size_t e = 0; e < num_edges; e += every_edge)
      path += "M" + place(points, drawing.edges[2 * e]) + "L" + place(points, drawing.edges[2 * e + 1]);
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-opacity=\"{:g}\"/>\n", path, color, opacity);
  };
  if (shape >= 0 && num_edges > 0) svg += draw_edges(rest, "#9aa3ad", 0.8);
  if (num_faces > 0 && num_faces <= kMaxShapeFaces) {
    std::vector<std::size_t> order(num_faces);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto depth = [&](std::size_t f) {
      double sum = 0;
      for (std::size_t c = 0; c < 3; ++c) sum += seen(drawing.triangles[3 * f + c], 2);
      return sum;
    };
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return depth(a) < depth(b); });
    for (const auto f : order) {
      const auto* corner = &drawing.triangles[3 * f];
      const auto color = get_color((level[corner[0]] + level[corner[1]] + level[corner[2]]) / 3);
      svg += fmt::format("<path d=\"M{}L{}L{}z\" fill=\"{}\" stroke=\"{}\" stroke-width=\"0.5\"/>\n",
                         place(seen, corner[0]), place(seen, corner[1]), place(seen, corner[2]),
                         shape >= 0 ? color : "#b9c7d6", shape >= 0 ? color : "#b9c7d6");
    }
    svg += draw_edges(seen, "#20303f", 0.35);
  } else if (num_faces > 0) {
    svg += draw_edges(seen, "#0072b2", 0.7);
  } else {
    for (std::size_t e = 0; e < num_edges; e += every_edge) {
      const auto a = drawing.edges[2 * e], b = drawing.edges[2 * e + 1];
      svg += fmt::format("<path d=\"M{}L{}\" stroke=\"{}\" stroke-width=\"2.5\" stroke-linecap=\"round\"/>\n",
                         place(seen, a), place(seen, b), shape >= 0 ? get_color((level[a] + level[b]) / 2) : "#20303f");
    }
  }
  return svg + "</svg>\n";
}

std::string draw_shapes(const Drawing& drawing, const std::vector<std::string>& titles, std::size_t max_shapes) {
  std::string html = "<div class=\"shapes\">\n";
  for (std::size_t j = 0; j < std::min({max_shapes, titles.size(), drawing.shapes.size()}); ++j)
    html += draw_shape(drawing, static_cast<int>(j), titles[j]);
  return html + "</div>\n";
}

}  // namespace bough::report
