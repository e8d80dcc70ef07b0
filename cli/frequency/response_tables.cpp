#include "cli/frequency/response_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "formats/export/response_text.hpp"

namespace bough::cli {
namespace {

using Peak = exports::CurvePeak;

std::vector<Peak> list_peaks(const std::vector<exports::NamedCurve>& curves, const Eigen::VectorXd& x) {
  std::vector<Peak> peaks;
  for (const auto& curve : curves) {
    auto& peak = peaks.emplace_back(exports::find_peak(curve, x));
    // Over time the sign of the largest value counts.
    if (curve.imag.size() == 0 && peak.phase_deg != 0) peak.size = -peak.size;
  }
  return peaks;
}

}  // namespace

std::string format_response(const records::ResponseSubcase& s, bool is_over_time, std::size_t max_curves) {
  const auto num_residual =
      static_cast<std::size_t>(std::count(s.kind.begin(), s.kind.end(), records::ModeKind::Residual));
  const auto num = static_cast<std::size_t>(s.x.size());
  const std::string how = s.is_direct ? "direct"
                                      : fmt::format("{}{} and {}", count(s.kind.size() - num_residual, "mode"),
                                                    s.num_rigid > 0 ? fmt::format(" ({} rigid)", s.num_rigid) : "",
                                                    count(num_residual, "residual vector"));
  std::string text = fmt::format("subcase {}: {} from {:.6g} to {:.6g}{}; {}\n", s.id,
                                 is_over_time ? count(num, "time")
                                 : num == 1   ? "1 frequency"
                                              : fmt::format("{} frequencies", num),
                                 s.x.size() > 0 ? s.x(0) : 0, s.x.size() > 0 ? s.x(s.x.size() - 1) : 0,
                                 is_over_time ? "" : " Hz", how);
  if (s.is_direct)
    text += fmt::format("residual of the response {:.1e}\n", s.solution_error);
  else
    text += fmt::format("orthogonality {:.1e}, {} {:.1e}\n", s.basis_error,
                        is_over_time ? "a step against two halves" : "residual of the response", s.solution_error);
  if (s.damped_motion == "absolute") text += "SDAMPING damps the absolute motion of the modes (PARAM,ENFMOTN,ABS)\n";
  if (s.damped_motion == "relative")
    text += "SDAMPING damps the motion relative to the supports (PARAM,ENFMOTN,REL); all that is given is absolute\n";
  const auto curves = exports::list_curves(s);
  const auto peaks = list_peaks(curves, s.x);
  for (std::size_t first = 0, last = 0; first < peaks.size(); first = last) {
    while (last < peaks.size() && peaks[last].curve->quantity == peaks[first].curve->quantity) ++last;
    std::vector<Peak> group(peaks.begin() + static_cast<std::ptrdiff_t>(first),
                            peaks.begin() + static_cast<std::ptrdiff_t>(last));
    std::erase_if(group, [](const auto& p) { return p.size == 0; });
    std::stable_sort(group.begin(), group.end(),
                     [](const auto& a, const auto& b) { return std::abs(a.size) > std::abs(b.size); });
    const auto left = group.size() > max_curves ? group.size() - max_curves : 0;
    group.resize(group.size() - left);
    const bool of_element = !peaks[first].curve->quantity.empty() && std::isupper(peaks[first].curve->quantity[0]);
    Table table{{of_element ? "element" : "grid", "component", "largest", is_over_time ? "at time" : "at Hz"}, {}};
    if (!is_over_time) table.headings.push_back("phase, deg");
    for (const auto& p : group) {
      table.rows.push_back({std::to_string(p.curve->id), p.curve->component, fmt::format("{:.6g}", p.size),
                            fmt::format("{:.6g}", p.at)});
      if (!is_over_time) table.rows.back().push_back(fmt::format("{:.2f}", p.phase_deg));
    }
    const bool of_stress = peaks[first].curve->quantity.find(':') != std::string::npos;
    text += fmt::format("\n{}{}\n", peaks[first].curve->quantity, of_element && !of_stress ? " forces" : "");
    text += group.empty() ? "zero throughout\n" : table.to_text();
    if (left > 0) text += fmt::format("and {} smaller; -o, --csv or --full has them\n", count(left, "curve"));
  }
  return text;
}

nlohmann::json to_json(const records::ResponseSubcase& s, bool is_over_time, bool full) {
  nlohmann::json json{{"id", s.id}, {"num_rigid", s.num_rigid}, {"curves", nlohmann::json::array()}};
  json[is_over_time ? "time" : "frequency_hz"] = to_json_list(s.x);
  json["method"] = s.is_direct ? "direct" : "modal";
  json["modes"] = {{"frequency_hz", to_json_list(s.mode_hz)}, {"damping_ratio", to_json_list(s.damping_ratio)}};
  if (!s.damped_motion.empty()) json["modes"]["damped_motion"] = s.damped_motion;
  json["accuracy"] = {{"solution", s.solution_error}};
  if (!s.is_direct) json["accuracy"]["basis"] = s.basis_error;
  auto residual = nlohmann::json::array();
  for (const auto kind : s.kind) residual.push_back(kind == records::ModeKind::Residual);
  json["modes"]["is_residual"] = residual;
  const auto curves = exports::list_curves(s);
  for (const auto& peak : list_peaks(curves, s.x)) {
    const auto& curve = *peak.curve;
    nlohmann::json one{{"name", curve.name},           {"quantity", curve.quantity}, {"id", curve.id},
                       {"component", curve.component}, {"largest", peak.size},       {"at", peak.at}};
    if (!is_over_time) one["phase_deg"] = peak.phase_deg;
    if (full) one[is_over_time ? "value" : "real"] = to_json_list(curve.real);
    if (full && !is_over_time) one["imag"] = to_json_list(curve.imag);
    json["curves"].push_back(std::move(one));
  }
  return json;
}

}  // namespace bough::cli
