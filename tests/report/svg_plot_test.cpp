#include <cmath>
#include <limits>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/export/csv.hpp"
#include "report/axis.hpp"
#include "report/svg_plot.hpp"
#include "tests/support/temp_folder.hpp"

namespace bough::report {
namespace {

using Eigen::VectorXd;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Csv, HeaderRowsAndEveryDigit) {
  std::ostringstream out;
  VectorXd t(3), y(3);
  t << 0, 0.1, 1.0 / 3.0;
  y << -1e-300, 12345678.9, std::nextafter(1.0, 2.0);
  exports::write_csv(out, {{"time", t}, {"tip, \"x\"", y}});
  std::istringstream in(out.str());
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "time,\"tip, \"\"x\"\"\"");
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(std::getline(in, line));
    const auto comma = line.find(',');
    // 17 significant digits bring back the very same number.
    EXPECT_EQ(std::stod(line.substr(0, comma)), t[i]);
    EXPECT_EQ(std::stod(line.substr(comma + 1)), y[i]);
  }
  EXPECT_FALSE(std::getline(in, line));
}

TEST(Axis, TicksAreRound) {
  EXPECT_THAT(make_axis(0, 20, 9, false).labels,
              ElementsAre("0", "2.5", "5.0", "7.5", "10.0", "12.5", "15.0", "17.5", "20.0"));
  EXPECT_THAT(make_axis(-0.55, 0.0, 6, false).labels,
              ElementsAre("\u22120.5", "\u22120.4", "\u22120.3", "\u22120.2", "\u22120.1", "0"));
  const Axis large = make_axis(0, 2.4e6, 5, false);
  EXPECT_EQ(large.exponent, 6);
  EXPECT_THAT(large.labels, ElementsAre("0", "0.5", "1.0", "1.5", "2.0"));
  EXPECT_EQ(make_axis(0, 3e-5, 5, false).exponent, -6);
  EXPECT_EQ(make_axis(-0.02, 0.01, 5, false).exponent, 0);
}

TEST(Axis, EveryRangeGivesTicksInsideIt) {
  for (const auto& [min, max] : {std::pair{0.0, 0.0}, std::pair{5.0, 5.0}, std::pair{-1e-12, 1e-12},
                                 std::pair{1.0, 1e12}, std::pair{-7.3, -7.2}, std::pair{1e6, 1e6 + 1}}) {
    for (const bool widen : {false, true}) {
      const Axis axis = make_axis(min, max, 7, widen);
      EXPECT_GE(axis.ticks.size(), 3u) << min;
      EXPECT_LE(axis.ticks.size(), 16u) << min;
      EXPECT_EQ(axis.ticks.size(), axis.labels.size());
      for (const double t : axis.ticks) {
        EXPECT_GE(t, axis.min - 1e-9 * (axis.max - axis.min));
        EXPECT_LE(t, axis.max + 1e-9 * (axis.max - axis.min));
      }
      EXPECT_LE(axis.min, min);
      EXPECT_GE(axis.max, max);
    }
  }
}

Curve make_curve(const std::string& label, int n, double (*f)(double)) {
  Curve curve;
  curve.label = label;
  curve.x = VectorXd::LinSpaced(n, 0, 20);
  curve.y = curve.x.unaryExpr(f);
  return curve;
}

Plot make_figure() {
  Plot plot;
  plot.title = "Tip deflection <spin-up> & \"figure 5\"";
  plot.x_label = "time, s";
  plot.y_label = "tip deflection, m";
  plot.curves = {make_curve("with geometric stiffness", 2001,
                            [](double t) { return -0.53 * std::exp(-0.1 * (t - 6.8) * (t - 6.8)); }),
                 make_curve("without", 2001, [](double t) { return -0.02 * std::exp(0.55 * t) + 0.02; })};
  Curve reference;
  reference.label = "report, digitized";
  reference.x = VectorXd::LinSpaced(8, 1, 15);
  reference.y = reference.x.unaryExpr([](double t) { return -0.53 * std::exp(-0.1 * (t - 6.8) * (t - 6.8)); });
  reference.markers_only = true;
  plot.curves.push_back(reference);
  plot.y_min = -1.2;
  plot.y_max = 0.2;
  return plot;
}

/// Coordinates of every path, in pixels.
std::vector<std::pair<double, double>> collect_points(const std::string& svg) {
  std::vector<std::pair<double, double>> points;
  const std::regex point("[ML](-?[0-9.]+) (-?[0-9.]+)");
  for (std::sregex_iterator it(svg.begin(), svg.end(), point), end; it != end; ++it) {
    points.emplace_back(std::stod((*it)[1]), std::stod((*it)[2]));
  }
  return points;
}

TEST(SvgPlot, IsWellFormedAndShowsEverything) {
  const test::TempFolder folder;
  const std::string svg = draw_svg(make_figure());
  EXPECT_EQ(
      test::run_python("-c \"import sys, xml.dom.minidom as m; m.parse(sys.argv[1])\" " + folder.write("p.svg", svg)),
      0);
  EXPECT_THAT(svg, HasSubstr("Tip deflection &lt;spin-up&gt; &amp; &quot;figure 5&quot;"));
  for (const char* text :
       {"time, s", "tip deflection, m", "with geometric stiffness", "without", "report, digitized"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
  // The reference curve is 8 circles and one in the legend.
  const std::regex circle("<circle");
  EXPECT_EQ(std::distance(std::sregex_iterator(svg.begin(), svg.end(), circle), {}), 9);
}

TEST(SvgPlot, CurvesEndAtTheFrame) {
  Plot plot = make_figure();
  plot.curves[1].y *= 1e200;
  const std::string svg = draw_svg(plot);
  for (const auto& [x, y] : collect_points(svg)) {
    EXPECT_GE(x, 0);
    EXPECT_LE(x, 900);
    EXPECT_GE(y, 0);
    EXPECT_LE(y, 560);
  }
}

TEST(SvgPlot, ClippedLineMeetsTheFrameWhereItShould) {
  Plot plot;
  Curve line;
  line.x = VectorXd::LinSpaced(2, 0, 1);
  line.y = VectorXd::LinSpaced(2, -2, 2);  // crosses y = -1 at x = 1/4 and y = 1 at x = 3/4
  plot.curves = {line};
  plot.y_min = -1;
  plot.y_max = 1;
  const auto points = collect_points(draw_svg(plot));
  // The curve is the last path before the frame: its two points lie a quarter and three quarters along.
  ASSERT_GE(points.size(), 2u);
  const auto first = points[points.size() - 2], last = points.back();
  const double left = 84, width = 790, top = 28, height = 400;
  EXPECT_NEAR(first.first, left + 0.25 * width, 0.02);
  EXPECT_NEAR(last.first, left + 0.75 * width, 0.02);
  EXPECT_NEAR(first.second, top + height, 0.02);
  EXPECT_NEAR(last.second, top, 0.02);
}

TEST(SvgPlot, LabelsOfGuidesAreCrossedByNoLine) {
  for (const double slope : {0.3, 0.9, 1.2, 3.0}) {
    Plot plot;
    plot.curves = {{"", VectorXd::LinSpaced(11, 0, 1), VectorXd::LinSpaced(11, 0, 1.1 * slope)}};
    plot.guides = {{"1/rev", VectorXd::LinSpaced(2, 0, 1), VectorXd::LinSpaced(2, 0, slope)}};
    plot.y_min = 0;
    plot.y_max = 1.5;
    const std::string svg = draw_svg(plot);
    std::smatch found;
    ASSERT_TRUE(std::regex_search(
        svg, found,
        std::regex(
            "<text x=\"([\\d.]+)\" y=\"([\\d.]+)\" font-size=\"11\"( text-anchor=\"end\")? fill=\"#777777\">1/rev")));
    const double left = 84, width = 790, top = 28, height = 400, text_width = 30;
    const double end = std::stod(found[1]), y = std::stod(found[2]);
    for (double x = found[3].matched ? end - text_width : end; x <= (found[3].matched ? end : end + text_width); x += 1)
      for (const double rise : {slope, 1.1 * slope}) {
        const double at = top + height * (1 - rise * (x - left) / width / plot.y_max);
        EXPECT_FALSE(at > y - 11 && at < y + 3 && at > top) << slope << " " << x;
      }
  }
}

TEST(SvgPlot, NanBreaksTheLineAndEmptyPlotsAreDrawn) {
  Plot plot = make_figure();
  plot.curves[0].y[1000] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(draw_svg(plot).find("nan"), std::string::npos);
  EXPECT_THAT(draw_svg(Plot{}), HasSubstr("</svg>"));
}

TEST(SvgPlot, LongHistoriesAreThinnedButKeepTheirPeak) {
  Plot plot;
  Curve curve = make_curve("long", 300001, [](double t) { return std::sin(40 * t); });
  curve.y[123456] = 5;
  plot.curves = {curve};
  const std::string svg = draw_svg(plot);
  EXPECT_LT(svg.size(), 150000u);
  double highest = 1e9;
  // Only the curve has line-to commands.
  const std::regex line_to("L-?[0-9.]+ (-?[0-9.]+)");
  for (std::sregex_iterator it(svg.begin(), svg.end(), line_to), end; it != end; ++it) {
    highest = std::min(highest, std::stod((*it)[1]));
  }
  // 5 is 4 % of the range below the upper end of the axis: margin of make_axis.
  EXPECT_NEAR(highest, 20 + 21 + 8 + 400 * 0.04 / 1.08, 1.0);
}

}  // namespace
}  // namespace bough::report
