#include "report/random_panel.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "report/html.hpp"
#include "report/label.hpp"

namespace bough::report {

std::string make_random_panel(RandomTable random) {
  constexpr std::size_t kMaxCurves = 6;             // of a picture
  constexpr Eigen::Index kMaxPicturePoints = 4000;  // of a curve
  auto& rows = random.rows;
  std::erase_if(rows, [](const RandomRow& row) { return row.rms == 0; });
  if (rows.empty()) return make_text("Zero throughout.");
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.rms > b.rms; });

  const auto& hz = random.frequency_hz;
  Plot densities, sums;
  densities.title = random.title + ", spectral density";
  sums.title = random.title + ", RMS up to each frequency";
  densities.x_label = sums.x_label = make_label("frequency", random.frequency_unit);
  densities.y_label = make_label("spectral density", "unit²/" + random.frequency_unit);
  sums.y_label = "cumulative RMS";
  densities.has_log_y = true;
  densities.has_log_x = sums.has_log_x = hz.size() > 1 && hz[0] > 0;
  for (std::size_t k = 0; k < std::min(rows.size(), kMaxCurves); ++k) {
    const auto& row = rows[k];
    const auto label = fmt::format("{}, RMS {}", row.name, format_value(row.rms, 4));
    densities.curves.push_back(thin_curve({label, hz, row.psd, false}, kMaxPicturePoints, densities.has_log_x));
    sums.curves.push_back(thin_curve({row.name, hz, row.running, false}, kMaxPicturePoints, sums.has_log_x));
  }
  std::vector<HtmlTable::Column> columns{{"output", true}};
  for (const auto& heading : random.columns) columns.push_back({heading});
  HtmlTable table(random.caption, std::move(columns));
  for (const auto& row : rows) {
    std::vector<std::string> cells{row.name};
    for (const double value : row.numbers) cells.push_back(std::isinf(value) ? "no bound" : format_value(value));
    table.add_row(std::move(cells));
  }
  std::string html = make_figure(densities) + make_figure(sums) + table.to_html(60);
  if (rows.size() > kMaxCurves)
    html += make_text(fmt::format("The {} largest of {} outputs are drawn.", kMaxCurves, rows.size()), "note");
  return html;
}

}  // namespace bough::report
