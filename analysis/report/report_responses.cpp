#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/report/report_files.hpp"
#include "formats/export/random_text.hpp"
#include "formats/export/response_text.hpp"
#include "formats/hdf5/response_file.hpp"
#include "formats/records/mode_kind.hpp"
#include "report/html.hpp"
#include "report/random_panel.hpp"

namespace bough::analysis {

namespace {

constexpr std::size_t kMaxCurves = 6;             // of a picture
constexpr Eigen::Index kMaxPicturePoints = 4000;  // of a curve

using exports::CurvePeak;

/// Magnitude above phase, in decades; over time the curves.
std::string make_pictures(const std::vector<CurvePeak>& of, const Eigen::VectorXd& x, const std::string& quantity,
                          bool is_over_time) {
  report::Plot upper, lower;
  upper.title = quantity;
  upper.x_label = lower.x_label = is_over_time ? "time" : "frequency [Hz]";
  upper.y_label = is_over_time ? "" : "magnitude";
  lower.y_label = "phase [degrees]";
  upper.has_log_x = lower.has_log_x = !is_over_time && x.size() > 1 && x[0] > 0 && x[x.size() - 1] > 10 * x[0];
  upper.has_log_y = !is_over_time;
  for (std::size_t c = 0; c < std::min(of.size(), kMaxCurves); ++c) {
    const auto& curve = *of[c].curve;
    Eigen::VectorXd size = curve.real, phase(x.size());
    for (Eigen::Index i = 0; i < x.size() && !is_over_time; ++i) {
      std::tie(size[i], phase[i]) = exports::to_polar(curve.real[i], curve.imag[i]);
      if (i > 0) phase[i] -= 360 * std::round((phase[i] - phase[i - 1]) / 360);
    }
    upper.curves.push_back(report::thin_curve({curve.name, x, size, false}, kMaxPicturePoints, upper.has_log_x));
    if (!is_over_time)
      lower.curves.push_back(report::thin_curve({curve.name, x, phase, false}, kMaxPicturePoints, lower.has_log_x));
  }
  return report::make_figure(upper) + (is_over_time ? "" : report::make_figure(lower));
}

void add_subcase(const records::ResponseSubcase& s, bool is_over_time, const std::string& prefix,
                 report::Chapter& chapter) {
  const auto curves = exports::list_curves(s);
  for (std::size_t first = 0, last = 0; first < curves.size(); first = last) {
    while (last < curves.size() && curves[last].quantity == curves[first].quantity) ++last;
    std::vector<CurvePeak> group;
    for (auto i = first; i < last; ++i) group.push_back(exports::find_peak(curves[i], s.x));
    std::stable_sort(group.begin(), group.end(), [](const auto& a, const auto& b) { return a.size > b.size; });
    std::erase_if(group, [](const auto& one) { return one.size <= 0; });
    const auto& quantity = curves[first].quantity;
    std::vector<report::HtmlTable::Column> columns{
        {"curve", true}, {"largest magnitude"}, {is_over_time ? "at time" : "at frequency [Hz]"}};
    if (!is_over_time) columns.push_back({"phase, degrees"});
    report::HtmlTable table("Largest values", columns);
    for (const auto& one : group) {
      std::vector<std::string> row{one.curve->name, report::format_value(one.size), report::format_value(one.at)};
      if (!is_over_time) row.push_back(report::format_value(one.phase_deg, 5));
      table.add_row(std::move(row));
    }
    std::string html = group.empty() ? report::make_text("Zero throughout.")
                                     : make_pictures(group, s.x, prefix + quantity, is_over_time) + table.to_html(60);
    if (group.size() > kMaxCurves)
      html +=
          report::make_text(fmt::format("The {} largest of {} curves are drawn.", kMaxCurves, group.size()), "note");
    chapter.add_panel(fmt::format("{}-{}", quantity, s.id), prefix + quantity, html);
  }
  if (s.mode_hz.size() == 0) return;
  report::HtmlTable modes("Coordinates of the solution",
                          {{"number"}, {"frequency [Hz]"}, {"damping %"}, {"kind", true}});
  for (Eigen::Index j = 0; j < s.mode_hz.size(); ++j)
    modes.add_row({std::to_string(j + 1), report::format_value(s.mode_hz[j]),
                   s.damping_ratio.size() > j ? report::format_value(100 * s.damping_ratio[j], 4) : "",
                   static_cast<std::size_t>(j) < s.kind.size()
                       ? std::string(records::get_name(s.kind[static_cast<std::size_t>(j)]))
                       : ""});
  chapter.add_panel(fmt::format("modes-{}", s.id), prefix + "modes", modes.to_html(400));
}

/// A panel for each quantity.
void add_random(const records::RandomResponse& random, report::Chapter& chapter) {
  const auto outputs = exports::list_random_outputs(random);
  for (std::size_t first = 0, last = 0; first < outputs.size(); first = last) {
    const auto& quantity = outputs[first].quantity;
    const auto& curves = *outputs[first].curves;
    const bool has_modal = curves.modal_rms.size() > 0;
    const auto title = fmt::format("random {}: {}", random.set, quantity);
    report::RandomTable table{title, "RMS and zero crossings per unit of time (N0)", {"RMS", "N0 [Hz]"}, random.hz, {}};
    if (has_modal) {
      table.caption += ", by the output frequencies and by integration over the band";
      table.columns.insert(table.columns.end(), {"modal RMS", "modal N0 [Hz]"});
    }
    const records::RandomCurves* of = nullptr;
    Eigen::MatrixXd running;
    for (; last < outputs.size() && outputs[last].quantity == quantity; ++last) {
      const auto& output = outputs[last];
      const auto c = output.column;
      if (output.curves != of) running = records::calc_cumulative_rms(random, *(of = output.curves));
      report::RandomRow row{output.name, of->psd.col(c), running.col(c), of->rms[c], {of->rms[c], of->crossing_hz[c]}};
      if (has_modal) row.numbers.insert(row.numbers.end(), {of->modal_rms[c], of->modal_crossing_hz[c]});
      table.rows.push_back(std::move(row));
    }
    chapter.add_panel(fmt::format("random-{}-{}", random.set, quantity), title,
                      report::make_random_panel(std::move(table)));
  }
}

/// The largest difference between RMS of the output frequencies and integral over the band, of what is no round-off.
void check_random(const records::RandomResponse& random, report::Chapter& chapter) {
  constexpr double kNoise = 1e-6, kLimit = 0.01;
  double worst = -1;
  for (const auto& curves : random.curves) {
    const double largest = curves.modal_rms.size() > 0 ? curves.modal_rms.maxCoeff() : 0;
    for (Eigen::Index c = 0; c < curves.modal_rms.size(); ++c)
      if (curves.modal_rms[c] > kNoise * largest)
        worst = std::max(worst, std::abs(curves.rms[c] / curves.modal_rms[c] - 1));
  }
  if (worst >= 0)
    chapter.checks.push_back({fmt::format("random {}: RMS against the integral over the band", random.set),
                              report::format_value(100 * worst, 3) + " %",
                              worst <= kLimit ? report::Verdict::Good : report::Verdict::Warning,
                              "below 1 %: FREQ4 cards about the modes"});
}

}  // namespace

report::Chapter make_response_chapter(const std::string& file) {
  const auto response = hdf5::read_response(file);
  report::Chapter chapter;
  chapter.kind = response.is_over_time ? "transient response" : "frequency response";
  chapter.title = file;
  chapter.facts = list_facts(file);
  for (const auto& random : response.random) {
    check_random(random, chapter);
    add_random(random, chapter);
  }
  for (const auto& s : response.subcases) {
    const auto n = s.x.size();
    chapter.facts.emplace_back(
        response.subcases.size() > 1 ? fmt::format("subcase {}", s.id) : "samples",
        n == 0 ? "0"
               : fmt::format("{} from {:g} to {:g}{}", n, s.x[0], s.x[n - 1], response.is_over_time ? "" : " Hz"));
    const auto highest = s.mode_hz.size() > 0 ? s.mode_hz.maxCoeff() : 0;
    if (!response.is_over_time && n > 0)
      chapter.checks.push_back({"highest coordinate to the highest frequency",
                                report::format_value(s.x[n - 1] > 0 ? highest / s.x[n - 1] : 0, 3),
                                highest >= s.x[n - 1] ? report::Verdict::Good : report::Verdict::Warning,
                                "above 1, better 2: raise --modes or --max-hz"});
    add_subcase(s, response.is_over_time, response.subcases.size() > 1 ? fmt::format("subcase {}: ", s.id) : "",
                chapter);
  }
  return chapter;
}

}  // namespace bough::analysis
