#include "report/budget_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "base/xml_text.hpp"
#include "report/html.hpp"

namespace bough::report {

namespace {

using records::BudgetTable;
using records::PointingBudget;

constexpr double kLeft = 190, kTop = 58, kWidth = 430, kRight = 170, kBar = 16, kRow = 22, kLegend = 18;
constexpr double kMinShare = 1e-4;      // narrower than a line
constexpr double kWidthOfLetter = 6.4;  // px, for the legend
/// Okabe and Ito, as of curves; more sources begin again.
constexpr std::array<const char*, 7> kColors{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                             "#E69F00", "#56B4E9", "#555555"};

struct Segment {
  double from = 0, to = 0;  ///< of 1
  std::size_t source = 0;
  std::string title;
};

struct Bar {
  std::string label, number;  ///< left and right of it
  std::vector<Segment> segments;
};

const char* get_color(std::size_t source) { return kColors[source % kColors.size()]; }

std::string name_table(const BudgetTable& table) {
  return table.exposure > 0 ? table.weighting + ", exposure " + format_value(table.exposure, 4) : table.weighting;
}

std::string shorten(const std::string& name) { return name.size() > 27 ? name.substr(0, 26) + "…" : name; }

std::string draw_legend(const std::vector<std::string>& sources, double y) {
  std::string svg;
  double x = kLeft;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    const double width = 24 + kWidthOfLetter * static_cast<double>(sources[s].size());
    if (x > kLeft && x + width > kLeft + kWidth + kRight) {
      x = kLeft;
      y += kLegend;
    }
    svg += fmt::format(
        "<rect x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"11\" height=\"11\" fill=\"{2}\"/><text x=\"{3:.1f}\" "
        "y=\"{4:.1f}\">{5}</text>\n",
        x, y - 10, get_color(s), x + 16, y, escape_xml(sources[s]));
    x += width;
  }
  return svg;
}

/// Height of the legend [px].
double calc_legend_height(const std::vector<std::string>& sources) {
  double x = kLeft, height = kLegend;
  for (const auto& source : sources) {
    const double width = 24 + kWidthOfLetter * static_cast<double>(source.size());
    if (x > kLeft && x + width > kLeft + kWidth + kRight) {
      x = kLeft;
      height += kLegend;
    }
    x += width;
  }
  return height;
}

/// \param css_class  of the figure. \param legend  sources, empty: none.
std::string draw(const std::string& title, const std::string& css_class, const std::vector<Bar>& bars,
                 const std::vector<std::string>& legend) {
  const double width = kLeft + kWidth + kRight, bottom = kTop + kRow * static_cast<double>(bars.size());
  const double height = bottom + (legend.empty() ? 6 : 14 + calc_legend_height(legend));
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "role=\"img\" font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" font-size=\"12\">"
      "<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n<text x=\"{3}\" y=\"18\" "
      "font-size=\"14\">{2}</text>\n<g fill=\"#555555\" text-anchor=\"middle\">\n",
      width, height, escape_xml(title), 8);
  for (const int percent : {0, 25, 50, 75, 100}) {
    const double x = kLeft + kWidth * percent / 100;
    svg += fmt::format(
        "<path d=\"M{0:.1f} {1}V{2:.1f}\" stroke=\"#d9d9d9\"/><text x=\"{0:.1f}\" y=\"{3}\">{4} "
        "%</text>\n",
        x, kTop - 6, bottom, kTop - 12, percent);
  }
  svg += "</g>\n";
  for (std::size_t k = 0; k < bars.size(); ++k) {
    const double y = kTop + kRow * static_cast<double>(k), middle = y + kBar / 2 + 4;
    svg += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", kLeft - 8, middle,
                       escape_xml(shorten(bars[k].label)));
    for (const auto& part : bars[k].segments) {
      if (!(part.to - part.from > kMinShare)) continue;
      svg += fmt::format(
          "<rect class=\"part\" x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.3f}\" height=\"{}\" fill=\"{}\" "
          "stroke=\"#ffffff\" "
          "stroke-width=\"0.6\"><title>{}</title></rect>\n",
          kLeft + kWidth * part.from, y, kWidth * (part.to - part.from), kBar, get_color(part.source),
          escape_xml(part.title));
    }
    svg +=
        fmt::format("<text x=\"{}\" y=\"{:.1f}\">{}</text>\n", kLeft + kWidth + 10, middle, escape_xml(bars[k].number));
  }
  if (!legend.empty()) svg += draw_legend(legend, bottom + 18);
  return "<figure class=\"" + css_class + "\">" + svg + "</svg></figure>\n";
}

/// Segments of the sources in this order, in parts of the mean square.
std::vector<Segment> stack(const PointingBudget& budget, const BudgetTable& table, Eigen::Index output,
                           const std::vector<std::size_t>& order) {
  const double whole = table.total[output] * table.total[output];
  std::vector<Segment> segments;
  double sum = 0;
  for (const std::size_t s : order) {
    const double rms = table.rms(static_cast<Eigen::Index>(s), output), share = rms * rms / whole;
    segments.push_back({sum, sum + share, s,
                        fmt::format("{}: RMS {}, {} % of the mean square", budget.sources[s], format_value(rms, 5),
                                    format_percent(share))});
    sum += share;
  }
  return segments;
}

}  // namespace

std::string draw_budget_waterfall(const PointingBudget& budget, const BudgetTable& table, Eigen::Index output) {
  const double total = table.total[output];
  if (!(total > 0)) return {};
  std::vector<std::size_t> order(budget.sources.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto get_rms = [&](std::size_t s) { return table.rms(static_cast<Eigen::Index>(s), output); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return get_rms(a) > get_rms(b); });
  const auto segments = stack(budget, table, output, order);
  std::vector<Bar> bars;
  for (const auto& part : segments)
    bars.push_back(
        {budget.sources[part.source],
         fmt::format("{}  ({} %)", format_value(get_rms(part.source), 4), format_percent(part.to - part.from)),
         {part}});
  bars.push_back({"root of the sum of squares", format_value(total, 4), segments});
  return draw(budget.outputs.name[static_cast<std::size_t>(output)] + ", " + name_table(table) +
                  " RMS by source: parts of the mean square",
              "budget-waterfall", bars, {});
}

std::string draw_budget_shares(const PointingBudget& budget, Eigen::Index output) {
  std::vector<std::size_t> order(budget.sources.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<Bar> bars;
  for (const auto& table : budget.tables)
    if (table.total[output] > 0)
      bars.push_back(
          {name_table(table), "RMS " + format_value(table.total[output], 4), stack(budget, table, output, order)});
  if (bars.empty()) return {};
  return draw(budget.outputs.name[static_cast<std::size_t>(output)] + ", shares of the sources by weighting",
              "budget-shares", bars, budget.sources);
}

}  // namespace bough::report
