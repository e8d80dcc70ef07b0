#include "report/linear_chapter.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "formats/records/unit_names.hpp"
#include "report/bode_plot.hpp"
#include "report/html.hpp"
#include "report/label.hpp"
#include "report/pack.hpp"
#include "report/pole_plot.hpp"

namespace bough::report {

namespace {

using nlohmann::json;

constexpr std::size_t kMaxDiagrams = 6, kMaxPairs = 24;

std::string make_poles(const records::LinearModel& model) {
  Plot plot = make_pole_plot({{"", &model}});
  plot.title = "Poles and zeros";
  const records::Poles poles = round_poles(model.poles);
  const auto frequency = label_frequency(model.units.time), unit = records::name_frequency_unit(model.units.time);
  HtmlTable table("Poles", {{"real"}, {"imaginary"}, {frequency}, {"damping %"}, {"coordinate", true}});
  int num_gone = 0;
  for (Eigen::Index i = 0; i < poles.real.size(); ++i) {
    if (records::is_gone(model, i)) {
      ++num_gone;
      continue;
    }
    table.add_row({format_value(poles.real[i]), format_value(poles.imag[i]), format_value(poles.frequency_hz[i]),
                   format_value(100 * poles.damping[i], 4), poles.mode[static_cast<std::size_t>(i)]});
  }
  std::string html = make_figure(plot, "poles") + table.to_html(400);
  if (num_gone > 0)
    html += make_text(fmt::format("{} {} at z = 0: gone within a sample.", num_gone, num_gone == 1 ? "pole" : "poles"),
                      "note");
  if (!model.aliased.empty()) {
    HtmlTable aliased(
        fmt::format("Modes above the Nyquist frequency {} {}: aliased", format_value(0.5 / model.sample_time, 4), unit),
        {{"mode", true}, {frequency}, {make_label("appears at", unit)}});
    for (const auto& one : model.aliased)
      aliased.add_row({one.mode, format_value(one.frequency_hz), format_value(one.appears_at_hz)});
    html += aliased.to_html(400);
  }
  if (model.has_zeros && model.zeros_real.size() > 0) {
    HtmlTable zeros("Transmission zeros", {{"real"}, {"imaginary"}});
    for (Eigen::Index i = 0; i < model.zeros_real.size(); ++i)
      zeros.add_row({format_value(model.zeros_real[i]), format_value(model.zeros_imag[i])});
    html += zeros.to_html(400);
  }
  return html;
}

/// Diagrams of one pair, with the margins of a loop.
std::vector<Plot> make_bode_plots(const LinearFindings& findings, const BodePair& pair) {
  const auto& frequency = findings.response.frequency_hz;
  auto plots = make_bode_axes(findings.response.units.time);
  add_bode_curve(pair, frequency, "", plots);
  if (findings.has_margins) add_margins(findings.margins, pair, findings.response, plots);
  plots[0].title = pair.name;
  return plots;
}

std::string make_bode(const LinearFindings& findings, const std::vector<BodePair>& pairs) {
  const auto& response = findings.response;
  std::string html = "<div class=\"live\" data-view=\"bode\">\n";
  for (std::size_t p = 0; p < std::min(kMaxDiagrams, pairs.size()); ++p)
    html += make_figure(make_bode_plots(findings, pairs[p]));
  html += "</div>\n";
  const auto all = static_cast<std::size_t>(response.inputs.size()) * static_cast<std::size_t>(response.outputs.size());
  if (all > pairs.size()) html += make_text(fmt::format("The first {} of {} pairs.", pairs.size(), all), "note");
  return html;
}

std::string make_singular_values(const LinearFindings& findings) {
  auto plot = make_sigma_plot(findings.response, "");
  plot.title = "Singular values of the transfer matrix";
  if (plot.curves.size() > 6) plot.curves.resize(6);
  return make_figure(plot);
}

std::string make_margins(const records::Margins& m, const std::string& time) {
  HtmlTable table(
      "The loop, with negative feedback",
      {{"margin", true}, {label_frequency(time)}, {"dB or degrees"}, {make_label("delay", time.empty() ? "T" : time)}});
  for (const auto& c : m.gain)
    table.add_row({"gain", format_value(c.frequency_hz), format_value(20 * std::log10(c.margin), 5), ""});
  for (const auto& c : m.phase)
    table.add_row({"phase", format_value(c.frequency_hz), format_value(c.margin * 180 / std::numbers::pi, 5),
                   format_value(c.delay, 5)});
  return table.to_html(400);
}

std::string make_hankel(const records::Hankel& hankel) {
  HtmlTable table("", {{"number"}, {"Hankel singular value"}});
  for (Eigen::Index i = 0; i < hankel.value.size(); ++i)
    table.add_row({std::to_string(i + 1), format_value(hankel.value[i])});
  std::string html =
      "<details><summary>" + std::to_string(hankel.value.size()) + "</summary>\n" + table.to_html(400) + "</details>\n";
  if (hankel.num_left_out > 0)
    html += make_text(fmt::format("Of what decays; {} poles that do not are left out.", hankel.num_left_out), "note");
  return html;
}

/// Stability, gain, Bode diagrams, singular values, margins.
void add_response(const LinearFindings& findings, const std::vector<BodePair>& pairs, Chapter& chapter) {
  if (findings.has_margins)
    chapter.checks.push_back({"with the loop closed", findings.margins.is_stable ? "stable" : "unstable",
                              findings.margins.is_stable ? Verdict::Good : Verdict::Warning,
                              "largest real part " + format_value(findings.margins.largest_real, 4)});
  if (!pairs.empty()) {
    chapter.checks.push_back({"largest gain", findings.peak.is_finite ? format_value(findings.peak.value) : "infinite",
                              Verdict::None,
                              findings.peak.is_finite ? "at " + format_value(findings.peak.frequency_hz) + " " +
                                                            records::name_frequency_unit(findings.response.units.time)
                                                      : findings.peak.why});
    chapter.add_panel("bode", "Bode", make_bode(findings, pairs));
    chapter.add_panel("sigma", "Singular values", make_singular_values(findings));
  }
  if (findings.has_margins)
    chapter.add_panel("margins", "Margins", make_margins(findings.margins, findings.response.units.time));
}

json to_list(const Eigen::VectorXd& values) {
  json list = json::array();
  for (const double v : values) list.push_back(std::isfinite(v) ? json(v) : json());
  return list;
}

/// Every pole of the table, with its point in the plane of make_pole_plot (x, y) and its number in the model.
json list_poles(const records::LinearModel& model) {
  const auto poles = round_poles(model.poles);
  json list{{"real", json::array()},    {"imag", json::array()}, {"x", json::array()},
            {"y", json::array()},       {"mode", json::array()}, {"frequency", json::array()},
            {"damping", json::array()}, {"index", json::array()}};
  for (Eigen::Index i = 0; i < poles.real.size(); ++i) {
    if (records::is_gone(model, i)) continue;
    const std::complex<double> s(poles.real[i], poles.imag[i]);
    const auto point = model.sample_time > 0 ? records::calc_z(model, i) : s;
    for (const auto& [key, value] :
         {std::pair("real", s.real()), std::pair("imag", s.imag()), std::pair("x", point.real()),
          std::pair("y", point.imag()), std::pair("frequency", poles.frequency_hz[i]),
          std::pair("damping", poles.damping[i])})
      list[key].push_back(std::isfinite(value) ? json(value) : json());
    list["mode"].push_back(poles.mode[static_cast<std::size_t>(i)]);
    list["index"].push_back(i);
  }
  return list;
}

/// Labels, guides and notes of the plane.
json make_plane(const records::LinearModel& model) {
  const auto plot = make_pole_plot({{"", &model}});
  json guides = json::array(), notes = json::array();
  for (const auto& guide : plot.guides)
    guides.push_back({{"label", guide.label}, {"x", to_list(guide.x)}, {"y", to_list(guide.y)}});
  for (const auto& note : plot.notes) notes.push_back({{"x", note.x}, {"y", note.y}, {"text", note.text}});
  return {{"x_label", plot.x_label},
          {"y_label", plot.y_label},
          {"equal", plot.is_equal},
          {"guides", std::move(guides)},
          {"notes", std::move(notes)}};
}

/// Pairs of the interactive Bode diagrams, with the marks of their margins.
json list_pairs(const LinearFindings& findings, const std::vector<BodePair>& pairs_of) {
  json pairs = json::array();
  for (const auto& pair : pairs_of) {
    json diagrams = json::array();
    for (const auto& plot : make_bode_plots(findings, pair)) {
      json marks = json::array(), guides = json::array();
      for (const auto& curve : plot.curves)
        if (curve.markers_only)
          marks.push_back({{"label", curve.label}, {"x", to_list(curve.x)}, {"y", to_list(curve.y)}});
      for (const auto& guide : plot.guides)
        guides.push_back({{"label", guide.label}, {"x", to_list(guide.x)}, {"y", to_list(guide.y)}});
      diagrams.push_back({{"marks", std::move(marks)}, {"guides", std::move(guides)}});
    }
    pairs.push_back({{"name", pair.name},
                     {"output", findings.response.outputs.name[static_cast<std::size_t>(pair.output)]},
                     {"input", findings.response.inputs.name[static_cast<std::size_t>(pair.input)]},
                     {"decibel", pack_doubles(pair.decibel)},
                     {"degrees", pack_doubles(pair.degrees)},
                     {"diagrams", std::move(diagrams)}});
  }
  return pairs;
}

}  // namespace

Chapter make_chapter(const records::LinearModel& model, const LinearFindings& findings, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts) {
  Chapter chapter{"linear model", file, facts, {}, {}, {}, {}};
  int unstable = 0;
  double worst = 0;
  const Eigen::VectorXd doubt = calc_pole_uncertainty(model.poles, 1e-6);
  for (Eigen::Index i = 0; i < model.poles.real.size(); ++i)
    if (model.poles.real[i] > doubt[i]) {
      ++unstable;
      worst = std::max(worst, model.poles.real[i]);
    }
  chapter.checks.push_back({"poles in the right half plane", std::to_string(unstable),
                            unstable > 0 ? Verdict::Warning : Verdict::Good,
                            unstable > 0 ? "largest real part " + format_value(worst, 4) : ""});
  chapter.checks.push_back({"estimated relative error of A and C", format_value(model.error, 2),
                            model.error > 1e-5 ? Verdict::Warning : Verdict::Good, ""});
  chapter.checks.push_back({"rate of change |u̇| at the point", format_value(model.residual, 3), Verdict::None,
                            "0 at rest and in a steady spin"});
  chapter.add_panel("poles", "Poles and zeros", make_poles(model));
  const auto pairs_of = make_bode_pairs(findings.response, kMaxPairs);
  add_response(findings, pairs_of, chapter);
  if (model.hankel.value.size() > 0) chapter.add_panel("hankel", "Hankel", make_hankel(model.hankel));
  for (const auto& [id, title, signals] :
       {std::tuple("states", "States", &model.states), std::tuple("inputs", "Inputs", &model.inputs),
        std::tuple("outputs", "Outputs", &model.outputs)}) {
    HtmlTable table("", {{"number"}, {"name", true}, {model.units.empty() ? "dims" : "unit", true}});
    for (int i = 0; i < signals->size(); ++i)
      table.add_row({std::to_string(i + 1), signals->name[static_cast<std::size_t>(i)],
                     records::label_dims(signals->dims[static_cast<std::size_t>(i)], model.units)});
    chapter.add_panel(
        id, title,
        "<details><summary>" + std::to_string(signals->size()) + "</summary>\n" + table.to_html(400) + "</details>\n");
  }
  chapter.data = json{{"poles", list_poles(model)},
                      {"plane", make_plane(model)},
                      {"zeros", {{"real", to_list(model.zeros_real)}, {"imag", to_list(model.zeros_imag)}}},
                      {"frequency_unit", records::name_frequency_unit(model.units.time)},
                      {"frequency", pack_doubles(findings.response.frequency_hz)},
                      {"pairs", list_pairs(findings, pairs_of)}}
                     .dump(-1, ' ', false, json::error_handler_t::replace);
  return chapter;
}

Chapter make_chapter(const LinearFindings& findings, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts) {
  Chapter chapter{"response of a linear model", file, facts, {}, {}, {}, {}};
  const auto& response = findings.response;
  const auto pairs = make_bode_pairs(response, kMaxPairs);
  const Eigen::Index n = response.frequency_hz.size();
  chapter.facts.emplace_back(
      "frequencies",
      n == 0 ? "0" : fmt::format("{} from {:g} to {:g}", n, response.frequency_hz[0], response.frequency_hz[n - 1]));
  chapter.facts.emplace_back("inputs", fmt::format("{}", fmt::join(response.inputs.name, ", ")));
  chapter.facts.emplace_back("outputs", fmt::format("{}", fmt::join(response.outputs.name, ", ")));
  add_response(findings, pairs, chapter);
  chapter.data = json{{"frequency_unit", records::name_frequency_unit(response.units.time)},
                      {"frequency", pack_doubles(response.frequency_hz)},
                      {"pairs", list_pairs(findings, pairs)}}
                     .dump(-1, ' ', false, json::error_handler_t::replace);
  return chapter;
}

}  // namespace bough::report
