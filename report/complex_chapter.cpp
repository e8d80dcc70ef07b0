#include "report/complex_chapter.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "report/drawing.hpp"
#include "report/html.hpp"
#include "report/pole_plot.hpp"
#include "report/shape_plot.hpp"

namespace bough::report {

namespace {

constexpr Eigen::Index kMaxShapePictures = 6;
constexpr double kMaxResidual = 1e-5;  ///< of the solver
/// An undamped mode is unstable by round-off alone.
constexpr double kUnstable = 1e-9;

/// Shapes in turn real and imaginary part: u = Re φ cos ωt - Im φ sin ωt.
Drawing make_complex_drawing(const records::ComplexModesResult& modes) {
  std::vector<Eigen::MatrixXd> parts;
  for (const auto& phi : modes.phi) {
    Eigen::MatrixXd both(6, 2 * phi.cols());
    for (Eigen::Index j = 0; j < phi.cols(); ++j) {
      both.col(2 * j) = phi.col(j).real();
      both.col(2 * j + 1) = phi.col(j).imag();
    }
    parts.push_back(std::move(both));
  }
  auto drawing = make_drawing(modes.mesh, modes.node_id, modes.node_xyz, parts);
  if (drawing.shapes.size() % 2 != 0) drawing.shapes.pop_back();
  drawing.num_dropped = static_cast<int>(modes.eigenvalue.size()) - static_cast<int>(drawing.shapes.size() / 2);
  return drawing;
}

std::string make_pole_table(const records::ComplexModesResult& r) {
  std::vector<HtmlTable::Column> columns{{"mode"},           {"real part [1/T]"}, {"imaginary part [1/T]"},
                                         {"frequency [Hz]"}, {"damping g"},       {"damping ratio %"},
                                         {"residual"}};
  if (r.whirl.size() > 0) columns.push_back({"whirl", true});
  HtmlTable table("", std::move(columns));
  for (Eigen::Index j = 0; j < r.eigenvalue.size(); ++j) {
    std::vector<std::string> row{std::to_string(j + 1),
                                 format_value(r.eigenvalue[j].real(), 8),
                                 format_value(r.eigenvalue[j].imag(), 8),
                                 format_value(r.frequency_hz[j], 7),
                                 format_value(r.damping[j]),
                                 format_value(100 * r.damping_ratio[j], 5),
                                 format_value(r.residual[j], 2)};
    if (r.whirl.size() > 0) row.push_back(r.eigenvalue[j].imag() > 0 ? records::name_whirl(r.whirl[j]) : "");
    table.add_row(row);
  }
  return table.to_html();
}

}  // namespace

Chapter make_chapter(const records::ComplexModesResult& r, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts) {
  Chapter chapter;
  chapter.kind = "complex modes";
  chapter.title = file;
  chapter.facts = facts;
  const auto n = r.eigenvalue.size();
  chapter.facts.emplace_back("modes", std::to_string(n));
  chapter.facts.emplace_back("solution", r.is_by_modes ? "on real modes (SOL 110)" : "on the full matrices (SOL 107)");
  chapter.facts.emplace_back("matrices", r.left.empty() ? "symmetric" : "not symmetric");
  Eigen::Index num_unstable = 0, min_mode = -1;
  for (Eigen::Index j = 0; j < n; ++j) {
    if (r.eigenvalue[j].real() > kUnstable * std::abs(r.eigenvalue[j])) ++num_unstable;
    if (r.eigenvalue[j].imag() > 0 && (min_mode < 0 || r.damping_ratio[j] < r.damping_ratio[min_mode])) min_mode = j;
  }
  if (!r.rotors || !r.rotors->is_synchronous)
    chapter.checks.push_back({"unstable modes", std::to_string(num_unstable),
                              num_unstable > 0 ? Verdict::Warning : Verdict::Good, "real part above 0"});
  if (n > 0) {
    const double worst = r.residual.maxCoeff();
    chapter.checks.push_back({"largest residual", format_value(worst, 2),
                              worst > kMaxResidual ? Verdict::Bad : Verdict::Good, "below 1e-5"});
  }
  if (r.biorthogonality >= 0)
    chapter.checks.push_back({"bi-orthogonality", format_value(r.biorthogonality, 2), Verdict::None, ""});
  if (min_mode >= 0)
    chapter.highlights.push_back(
        {"lowest damping ratio", format_value(100 * r.damping_ratio[min_mode], 4) + " %",
         fmt::format("mode {} at {} Hz", min_mode + 1, format_value(r.frequency_hz[min_mode], 5))});
  const auto drawing = make_complex_drawing(r);
  const auto num_drawn = static_cast<Eigen::Index>(drawing.shapes.size() / 2);
  if (num_drawn > 0) {
    std::string pictures;
    for (Eigen::Index j = 0; j < std::min(num_drawn, kMaxShapePictures); ++j)
      pictures += "<figure>" +
                  draw_shape(drawing, static_cast<int>(2 * j),
                             fmt::format("mode {}: {} Hz, ζ {}, real part", j + 1, format_value(r.frequency_hz[j], 5),
                                         format_value(r.damping_ratio[j], 3))) +
                  "</figure>\n";
    std::string html = make_live("modes", pictures);
    html += make_text("In motion the points follow the phase of the complex shape, without its decay.", "note");
    if (drawing.num_dropped > 0)
      html += make_text(
          fmt::format("To keep the page small it has the shapes of the first {} of {} modes.", num_drawn, n), "note");
    chapter.add_panel("shapes", "Complex shapes", html);
    chapter.data = nlohmann::json{{"frequency", std::vector<double>(r.frequency_hz.begin(), r.frequency_hz.end())},
                                  {"kinds", std::vector<std::string>(static_cast<std::size_t>(n), "normal")},
                                  {"buckling", false},
                                  {"complex", true},
                                  {"drawing", nlohmann::json::parse(to_json_text(drawing))}}
                       .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  if (n > 0) {
    records::LinearModel poles;
    poles.poles.real = r.eigenvalue.real();
    poles.poles.imag = r.eigenvalue.imag();
    poles.poles.frequency_hz = r.frequency_hz;
    poles.poles.damping = r.damping_ratio;
    chapter.add_panel("poles", "Poles", make_figure(make_pole_plot({{"", &poles}})));
    chapter.add_panel("table", "Eigenvalues and damping", make_pole_table(r));
  }
  return chapter;
}

}  // namespace bough::report
