#include "formats/report/linear_chapter.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/report/html.hpp"
#include "formats/report/pack.hpp"

namespace bough::report {

namespace {

using nlohmann::json;

constexpr std::size_t kMostPictures = 6;

std::string make_poles(const records::LinearModel& model) {
  Plot plot{"Poles and zeros", "real part [1/T]", "imaginary part [1/T]", {}, 0, 0};
  plot.curves.push_back({"poles", model.poles.real, model.poles.imag, true});
  if (model.zeros_real.size() > 0) plot.curves.push_back({"zeros", model.zeros_real, model.zeros_imag, true});
  HtmlTable table("Poles", {{"real"}, {"imaginary"}, {"frequency [1/T]"}, {"damping %"}, {"coordinate", true}});
  for (Eigen::Index i = 0; i < model.poles.real.size(); ++i)
    table.add_row({format_value(model.poles.real[i]), format_value(model.poles.imag[i]),
                   format_value(model.poles.frequency_hz[i]), format_value(100 * model.poles.damping[i], 4),
                   model.poles.mode[static_cast<std::size_t>(i)]});
  std::string html = make_figure(plot, "poles") + table.to_html(400);
  if (model.has_zeros && model.zeros_real.size() > 0) {
    HtmlTable zeros("Transmission zeros", {{"real"}, {"imaginary"}});
    for (Eigen::Index i = 0; i < model.zeros_real.size(); ++i)
      zeros.add_row({format_value(model.zeros_real[i]), format_value(model.zeros_imag[i])});
    html += zeros.to_html(400);
  }
  return html;
}

std::string make_bode(const records::LinearModel& model, const FrequencyResponse& response) {
  std::string html = "<div class=\"live\" data-view=\"bode\">\n";
  // The axes of static pictures are linear: the logarithm is drawn.
  const Eigen::VectorXd decades = response.frequency.array().log10();
  for (std::size_t p = 0; p < std::min(kMostPictures, response.pairs.size()); ++p) {
    const auto& pair = response.pairs[p];
    const std::string name = model.outputs.name[static_cast<std::size_t>(pair.output)] + " over " +
                             model.inputs.name[static_cast<std::size_t>(pair.input)];
    html += make_figure(
        {name, "log10 of the frequency [1/T]", "magnitude [dB]", {{"", decades, pair.decibel, false}}, 0, 0});
  }
  html += "</div>\n";
  const auto all = static_cast<std::size_t>(model.inputs.size()) * static_cast<std::size_t>(model.outputs.size());
  if (all > response.pairs.size())
    html += make_text(fmt::format("The first {} of {} pairs.", response.pairs.size(), all), "note");
  return html;
}

json to_list(const Eigen::VectorXd& values) {
  json list = json::array();
  for (const double v : values) list.push_back(std::isfinite(v) ? json(v) : json());
  return list;
}

}  // namespace

Chapter make_chapter(const records::LinearModel& model, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts) {
  Chapter chapter{"linear model", file, facts, {}, {}, {}, {}};
  int unstable = 0;
  double worst = 0, largest = 0;
  for (Eigen::Index i = 0; i < model.poles.real.size(); ++i)
    largest = std::max(largest, std::hypot(model.poles.real[i], model.poles.imag[i]));
  for (const double re : model.poles.real)
    if (re > 1e-6 * largest) {
      ++unstable;
      worst = std::max(worst, re);
    }
  chapter.checks.push_back({"poles in the right half plane", std::to_string(unstable),
                            unstable > 0 ? Verdict::Warning : Verdict::Good,
                            unstable > 0 ? "largest real part " + format_value(worst, 4) : ""});
  chapter.checks.push_back({"estimated relative error of A and C", format_value(model.error, 2),
                            model.error > 1e-5 ? Verdict::Warning : Verdict::Good, ""});
  chapter.checks.push_back({"rate of change |u̇| at the point", format_value(model.residual, 3), Verdict::None,
                            "0 at rest and in a steady spin"});
  chapter.add_panel("poles", "Poles and zeros", make_poles(model));
  const auto response = calc_frequency_response(model);
  if (!response.pairs.empty()) chapter.add_panel("bode", "Bode", make_bode(model, response));
  for (const auto& [id, title, signals] :
       {std::tuple("states", "States", &model.states), std::tuple("inputs", "Inputs", &model.inputs),
        std::tuple("outputs", "Outputs", &model.outputs)}) {
    HtmlTable table("", {{"number"}, {"name", true}, {"dims", true}});
    for (int i = 0; i < signals->size(); ++i)
      table.add_row({std::to_string(i + 1), signals->name[static_cast<std::size_t>(i)],
                     signals->dims[static_cast<std::size_t>(i)]});
    chapter.add_panel(
        id, title,
        "<details><summary>" + std::to_string(signals->size()) + "</summary>\n" + table.to_html(400) + "</details>\n");
  }
  json pairs = json::array();
  for (const auto& pair : response.pairs)
    pairs.push_back({{"output", model.outputs.name[static_cast<std::size_t>(pair.output)]},
                     {"input", model.inputs.name[static_cast<std::size_t>(pair.input)]},
                     {"decibel", pack_doubles(pair.decibel)},
                     {"degrees", pack_doubles(pair.degrees)}});
  chapter.data = json{
      {"poles",
       {{"real", to_list(model.poles.real)},
        {"imag", to_list(model.poles.imag)},
        {"frequency", to_list(model.poles.frequency_hz)},
        {"damping", to_list(model.poles.damping)},
        {"mode", model.poles.mode}}},
      {"zeros", {{"real", to_list(model.zeros_real)}, {"imag", to_list(model.zeros_imag)}}},
      {"frequency", pack_doubles(response.frequency)},
      {"pairs",
       pairs}}.dump(-1, ' ', false, json::error_handler_t::replace);
  return chapter;
}

}  // namespace bough::report
