#include "report/html.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/diagnostic.hpp"
#include "base/xml_text.hpp"
#include "report/thin.hpp"

namespace bough::report {

std::string format_value(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value == 0 ? 0.0 : value, digits) : "–";
}

std::string format_percent(double share) { return std::isfinite(share) ? fmt::format("{:.2f}", 100 * share) : "–"; }

HtmlTable::HtmlTable(std::string caption, std::vector<Column> columns)
    : caption_(std::move(caption)), columns_(std::move(columns)) {}

void HtmlTable::add_row(std::vector<std::string> cells) {
  BOUGH_DEMAND(cells.size() == columns_.size());
  rows_.push_back(std::move(cells));
}

std::string HtmlTable::to_html(std::size_t max_rows) const {
  const auto open = [&](std::size_t i, const char* tag) {
    return std::string("<") + tag + (columns_[i].is_text ? " class=\"text\">" : ">");
  };
  std::string html = "<div class=\"scroll\"><table><caption>" + escape_xml(caption_) + "</caption>\n<thead><tr>";
  for (std::size_t i = 0; i < columns_.size(); ++i) html += open(i, "th") + escape_xml(columns_[i].heading) + "</th>";
  html += "</tr></thead>\n<tbody>\n";
  for (std::size_t r = 0; r < std::min(max_rows, rows_.size()); ++r) {
    html += "<tr>";
    for (std::size_t i = 0; i < columns_.size(); ++i) html += open(i, "td") + escape_xml(rows_[r][i]) + "</td>";
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  if (rows_.size() > max_rows) html += make_text(fmt::format("… and {} rows more", rows_.size() - max_rows), "note");
  return html;
}

std::string make_figure(const Plot& plot, const std::string& live) {
  Plot thin = plot;
  for (auto& curve : thin.curves) curve = thin_curve(curve, 600, plot.has_log_x);
  return std::string("<figure") + (live.empty() ? "" : " class=\"live\" data-view=\"" + escape_xml(live) + "\"") +
         ">\n" + draw_svg(thin) + "</figure>\n";
}

std::string make_figure(const std::vector<Plot>& plots) {
  auto thin = plots;
  for (auto& plot : thin)
    for (auto& curve : plot.curves) curve = thin_curve(curve, 600, plot.has_log_x);
  return "<figure>\n" + draw_svg(thin) + "</figure>\n";
}

std::string make_place(const std::string& live, const std::string& without) {
  return "<figure class=\"live\" data-view=\"" + escape_xml(live) + "\"><p class=\"note\">" + escape_xml(without) +
         "</p></figure>\n";
}

std::string make_live(const std::string& live, const std::string& html) {
  return "<figure class=\"live\" data-view=\"" + escape_xml(live) + "\">" + html + "</figure>\n";
}

std::string make_text(const std::string& text, const std::string& css_class) {
  return std::string("<p") + (css_class.empty() ? "" : " class=\"" + css_class + "\"") + ">" + escape_xml(text) +
         "</p>\n";
}

Curve thin_curve(const Curve& curve, Eigen::Index max_rows, bool has_log_x) {
  const Eigen::Index n = curve.x.size();
  if (n <= max_rows || curve.markers_only) return curve;
  // Values at zero and below are not drawn in decades.
  Eigen::VectorXd x = curve.x;
  if (has_log_x && x[n - 1] > 0) {
    double smallest = x[n - 1];
    for (const double v : x)
      if (v > 0) smallest = std::min(smallest, v);
    x = x.cwiseMax(smallest).array().log10();
  }
  const auto ends = split_samples(x, max_rows / 2);
  std::vector<Eigen::Index> keep{0};
  for (std::size_t b = 0; b + 1 < ends.size(); ++b) {
    const Eigen::Index first = ends[b], last = ends[b + 1];
    Eigen::Index low = first, high = first;
    for (Eigen::Index i = first; i < last; ++i) {
      if (curve.y[i] < curve.y[low]) low = i;
      if (curve.y[i] > curve.y[high]) high = i;
      if (!std::isfinite(curve.y[i])) low = high = i;  // the gap stays
    }
    for (const Eigen::Index i : {std::min(low, high), std::max(low, high)})
      if (i > keep.back()) keep.push_back(i);
  }
  if (keep.back() != n - 1) keep.push_back(n - 1);
  Curve thin = curve;
  thin.x = curve.x(keep);
  thin.y = curve.y(keep);
  return thin;
}

}  // namespace bough::report
