#include "cli/frequency/random_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "formats/export/random_text.hpp"

namespace bough::cli {
namespace {

double get_rms(const exports::RandomOutput& output) { return output.curves->rms(output.column); }

}  // namespace

std::string format_random(const records::RandomResponse& r, std::size_t max_outputs) {
  std::string ids;
  for (const int id : r.subcases) ids += (ids.empty() ? "" : ", ") + std::to_string(id);
  std::string text = fmt::format("random {}: {} {}, {} from {:.6g} to {:.6g} Hz, spectral densities integrated by {}\n",
                                 r.set, r.subcases.size() == 1 ? "subcase" : "subcases", ids,
                                 r.hz.size() == 1 ? "1 frequency" : fmt::format("{} frequencies", r.hz.size()),
                                 r.hz.size() > 0 ? r.hz(0) : 0, r.hz.size() > 0 ? r.hz(r.hz.size() - 1) : 0,
                                 r.is_loglog ? "straight lines on logarithmic axes" : "straight lines");
  if (r.integral_error >= 0)
    text += fmt::format("modal: integral over the band, relative error {:.1e}\n", r.integral_error);
  const auto outputs = exports::list_random_outputs(r);
  for (std::size_t first = 0, last = 0; first < outputs.size(); first = last) {
    while (last < outputs.size() && outputs[last].quantity == outputs[first].quantity) ++last;
    std::vector<exports::RandomOutput> group(outputs.begin() + static_cast<std::ptrdiff_t>(first),
                                             outputs.begin() + static_cast<std::ptrdiff_t>(last));
    std::erase_if(group, [](const auto& output) { return get_rms(output) == 0; });
    std::stable_sort(group.begin(), group.end(), [](const auto& a, const auto& b) { return get_rms(a) > get_rms(b); });
    const auto left = group.size() > max_outputs ? group.size() - max_outputs : 0;
    group.resize(group.size() - left);
    const auto& quantity = outputs[first].quantity;
    const bool of_element = std::isupper(static_cast<unsigned char>(quantity[0])) != 0;
    const bool has_modal = outputs[first].curves->modal_rms.size() > 0;
    Table table{{of_element ? "element" : "grid", "component", "RMS", "N0, Hz"}, {}};
    if (has_modal) {
      table.headings.emplace_back("modal RMS");
      table.headings.emplace_back("modal N0");
    }
    for (const auto& output : group) {
      const auto& curves = *output.curves;
      table.rows.push_back({std::to_string(output.id), output.component, fmt::format("{:.6g}", get_rms(output)),
                            fmt::format("{:.6g}", curves.crossing_hz(output.column))});
      if (!has_modal) continue;
      table.rows.back().push_back(fmt::format("{:.6g}", curves.modal_rms(output.column)));
      table.rows.back().push_back(fmt::format("{:.6g}", curves.modal_crossing_hz(output.column)));
    }
    text += fmt::format("\n{}{}\n", quantity, of_element && quantity.find(':') == std::string::npos ? " forces" : "");
    text += group.empty() ? "zero throughout\n" : table.to_text();
    if (left > 0) text += fmt::format("and {} smaller; -o, --csv or --full has them\n", count(left, "output"));
  }
  if (!r.crosses.empty()) {
    Table table{{"a", "b", "covariance", "largest coherence", "at Hz"}, {}};
    for (const auto& cross : r.crosses) {
      const auto name = exports::name_cross(cross);
      Eigen::Index at = 0;
      const double coherence = cross.coherence.size() > 0 ? cross.coherence.maxCoeff(&at) : 0;
      table.rows.push_back({name.substr(0, name.find('|')), name.substr(name.find('|') + 1),
                            fmt::format("{:.6g}", cross.covariance), fmt::format("{:.4g}", coherence),
                            fmt::format("{:.6g}", r.hz.size() > 0 ? r.hz(at) : 0)});
    }
    text += "\ncross-spectral densities\n" + table.to_text();
  }
  return text;
}

nlohmann::json to_json(const records::RandomResponse& r, bool full) {
  nlohmann::json json{{"set", r.set},
                      {"subcases", r.subcases},
                      {"frequency_hz", to_json_list(r.hz)},
                      {"integration", r.is_loglog ? "loglog" : "linear"},
                      {"outputs", nlohmann::json::array()}};
  if (r.lags.size() > 0) json["lag"] = to_json_list(r.lags);
  if (r.integral_error >= 0) json["integral_error"] = r.integral_error;
  for (const auto& output : exports::list_random_outputs(r)) {
    const auto& curves = *output.curves;
    nlohmann::json one{{"name", output.name},    {"quantity", output.quantity},
                       {"id", output.id},        {"component", output.component},
                       {"rms", get_rms(output)}, {"zero_crossings_hz", curves.crossing_hz(output.column)}};
    if (curves.modal_rms.size() > 0) {
      one["modal_rms"] = curves.modal_rms(output.column);
      one["modal_zero_crossings_hz"] = curves.modal_crossing_hz(output.column);
    }
    if (full) one["psd"] = to_json_list(curves.psd.col(output.column));
    if (full && r.lags.size() > 0) one["autocorrelation"] = to_json_list(curves.autocorrelation.col(output.column));
    json["outputs"].push_back(std::move(one));
  }
  for (const auto& cross : r.crosses) {
    nlohmann::json one{{"name", exports::name_cross(cross)}, {"covariance", cross.covariance}};
    if (full) one["real"] = to_json_list(cross.psd.real());
    if (full) one["imag"] = to_json_list(cross.psd.imag());
    if (full) one["coherence"] = to_json_list(cross.coherence);
    if (full && cross.correlation.size() > 0) one["correlation"] = to_json_list(cross.correlation);
    json["crosses"].push_back(std::move(one));
  }
  return json;
}

}  // namespace bough::cli
