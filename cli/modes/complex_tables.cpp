#include "cli/modes/complex_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/common/console.hpp"

namespace bough::cli {

using records::ComplexModesResult;
using records::RotorSpeeds;

namespace {

constexpr double kRpm = 30 / std::numbers::pi;

std::string format_rotors(const RotorSpeeds& rotors) {
  Table table{{"rotor", "grids", "elements", "mass", "polar inertia"}, {}};
  for (const auto& rotor : rotors.rotors)
    table.rows.push_back({std::to_string(rotor.id), std::to_string(rotor.num_grids), std::to_string(rotor.num_elements),
                          fmt::format("{:.6g}", rotor.mass), fmt::format("{:.6g}", rotor.polar_inertia)});
  return table.to_text() + "\n";
}

/// Modes over the speed; critical speeds; onset of instability.
std::string format_speeds(const RotorSpeeds& rotors) {
  const auto& sweep = rotors.sweep;
  std::string text;
  if (const auto end = sweep.value.size() - 1; end > 0) {
    Table table{{"branch", "Hz from", "to", "damping from", "to", "largest real", "whirl"}, {}};
    for (Eigen::Index b = 0; b < sweep.real.cols(); ++b) {
      Eigen::Index worst = 0;
      const double max_real = sweep.real.col(b).maxCoeff(&worst);
      table.rows.push_back({std::to_string(b + 1), fmt::format("{:.7g}", sweep.frequency_hz(0, b)),
                            fmt::format("{:.7g}", sweep.frequency_hz(end, b)),
                            fmt::format("{:.4g}", sweep.damping(0, b)), fmt::format("{:.4g}", sweep.damping(end, b)),
                            fmt::format("{:.3g} at {:.6g} rpm", max_real, sweep.value[worst] * kRpm),
                            records::name_whirl(sweep.whirl(end, b))});
    }
    text += fmt::format("\n{} speeds from {:.6g} to {:.6g} rpm\n", end + 1, sweep.value[0] * kRpm,
                        sweep.value[end] * kRpm) +
            table.to_text();
  }
  const auto list = [&](const char* title, const std::vector<RotorSpeeds::Point>& points, const char* number) {
    if (points.empty()) return;
    Table table{{number, "rad/T", "rpm", "Hz", "whirl"}, {}};
    for (const auto& point : points)
      table.rows.push_back({std::to_string(point.branch + 1), fmt::format("{:.8g}", point.speed),
                            fmt::format("{:.8g}", point.speed * kRpm), fmt::format("{:.7g}", point.frequency_hz),
                            records::name_whirl(point.whirl)});
    text += std::string("\n") + title + "\n" + table.to_text();
  };
  list("critical speeds: the rotor turns as fast as it whirls", rotors.critical,
       rotors.is_synchronous ? "mode" : "branch");
  for (const bool is_onset : {true, false}) {
    std::vector<RotorSpeeds::Point> points;
    std::copy_if(rotors.thresholds.begin(), rotors.thresholds.end(), std::back_inserter(points),
                 [&](const auto& point) { return point.is_onset == is_onset; });
    list(is_onset ? "stability: unstable above this speed" : "stability: stable again above this speed", points,
         "branch");
  }
  return text;
}

nlohmann::json make_json(const RotorSpeeds& rotors) {
  nlohmann::json json{{"reference", rotors.reference}, {"synchronous", rotors.is_synchronous}};
  for (const auto& rotor : rotors.rotors)
    json["rotors"].push_back({{"id", rotor.id},
                              {"grids", rotor.num_grids},
                              {"elements", rotor.num_elements},
                              {"mass", rotor.mass},
                              {"polar_inertia", rotor.polar_inertia}});
  const auto to_rows = [](const Eigen::MatrixXd& m) {
    auto rows = nlohmann::json::array();
    for (const auto& row : m.rowwise()) rows.push_back(std::vector<double>(row.begin(), row.end()));
    return rows;
  };
  const auto& sweep = rotors.sweep;
  if (sweep.value.size() > 0)
    json["campbell"] = {{"speed", std::vector<double>(sweep.value.begin(), sweep.value.end())},
                        {"real", to_rows(sweep.real)},
                        {"imag", to_rows(sweep.imag)},
                        {"frequency_hz", to_rows(sweep.frequency_hz)},
                        {"damping", to_rows(sweep.damping)},
                        {"whirl", to_rows(sweep.whirl)},
                        {"correlation", to_rows(sweep.correlation)}};
  const auto to_points = [](const std::vector<RotorSpeeds::Point>& points) {
    auto list = nlohmann::json::array();
    for (const auto& p : points)
      list.push_back({{"branch", p.branch + 1},
                      {"speed", p.speed},
                      {"rpm", p.speed * kRpm},
                      {"frequency_hz", p.frequency_hz},
                      {"whirl", p.whirl}});
    return list;
  };
  json["critical_speeds"] = to_points(rotors.critical);
  json["thresholds"] = to_points(rotors.thresholds);
  for (std::size_t k = 0; k < rotors.thresholds.size(); ++k)
    json["thresholds"][k]["onset"] = rotors.thresholds[k].is_onset;
  return json;
}

}  // namespace

std::string format_complex_modes(const ComplexModesResult& r) {
  const bool has_whirl = r.whirl.size() > 0;
  Table table{{"mode", "real", "imaginary", "Hz", "damping g", "ratio", "residual"}, {}};
  if (has_whirl) table.headings.emplace_back("whirl");
  for (Eigen::Index j = 0; j < r.eigenvalue.size(); ++j) {
    table.rows.push_back({std::to_string(j + 1), fmt::format("{:.8g}", r.eigenvalue(j).real()),
                          fmt::format("{:.8g}", r.eigenvalue(j).imag()), fmt::format("{:.7g}", r.frequency_hz(j)),
                          fmt::format("{:.6g}", r.damping(j)), fmt::format("{:.6g}", r.damping_ratio(j)),
                          fmt::format("{:.1e}", r.residual(j))});
    if (has_whirl)
      table.rows.back().push_back(r.eigenvalue(j).imag() > 0 ? records::name_whirl(r.whirl(j)) : std::string("-"));
  }
  std::string text;
  if (r.rotors)
    text +=
        format_rotors(*r.rotors) +
        (r.rotors->is_synchronous ? std::string("rotors at the frequency of each mode (synchronous): real parts "
                                                "are no measure of stability\n\n")
                                  : fmt::format("rotors at {:.8g} rpm ({:.8g} rad/T)\n\n", r.speed * kRpm, r.speed));
  text += "complex eigenvalues, imaginary part not below 0\n" + table.to_text() + "\n";
  const auto count_if = [&](const auto& is_one) {
    return std::count_if(r.eigenvalue.begin(), r.eigenvalue.end(), is_one);
  };
  // An undamped mode is unstable by round-off alone.
  const auto unstable = count_if([](std::complex<double> l) { return l.real() > 1e-9 * std::abs(l); });
  if (unstable > 0 && !(r.rotors && r.rotors->is_synchronous))
    text += fmt::format("unstable: {} of {} (real part above 0)\n", unstable, r.eigenvalue.size());
  text += fmt::format("method: {}, {} unknowns{}\n",
                      r.is_by_modes ? "on real modes (SOL 110)" : "on the full matrices (SOL 107)", r.num_unknowns,
                      r.left.empty() ? "" : ", unsymmetric");
  text += fmt::format("eigensolver: {} about {:.6g}{:+.6g}i, {} solutions with a factor of {:.3g} entries\n",
                      r.is_complete ? "Schur form, every eigenvalue," : "Krylov-Schur, the nearest", r.shift.real(),
                      r.shift.imag(), r.num_iterations, r.factor_entries);
  text +=
      fmt::format("shapes: {} (NORM = {})\n", r.norm == "MAX" ? "the largest component is 1" : "one dof is 1", r.norm);
  if (r.residual.size() > 0) text += fmt::format("largest residual: {:.1e}\n", r.residual.maxCoeff());
  if (r.biorthogonality >= 0) text += fmt::format("bi-orthogonality: {:.1e}\n", r.biorthogonality);
  if (r.rotors) text += format_speeds(*r.rotors);
  return text;
}

nlohmann::json make_json(const ComplexModesResult& r) {
  auto modes = nlohmann::json::array();
  for (Eigen::Index j = 0; j < r.eigenvalue.size(); ++j)
    modes.push_back({{"mode", j + 1},
                     {"eigenvalue", {{"real", r.eigenvalue(j).real()}, {"imag", r.eigenvalue(j).imag()}}},
                     {"frequency_hz", r.frequency_hz(j)},
                     {"damping", r.damping(j)},
                     {"damping_ratio", r.damping_ratio(j)},
                     {"residual", r.residual(j)}});
  for (Eigen::Index j = 0; j < r.whirl.size(); ++j) modes[static_cast<std::size_t>(j)]["whirl"] = r.whirl(j);
  nlohmann::json json{{"subcase", r.subcase},
                      {"solution", r.is_by_modes ? "modal" : "direct"},
                      {"method", r.method},
                      {"norm", r.norm},
                      {"symmetric", r.left.empty()},
                      {"complete", r.is_complete},
                      {"shift", {{"real", r.shift.real()}, {"imag", r.shift.imag()}}},
                      {"biorthogonality", r.biorthogonality},
                      {"modes", modes}};
  if (!r.rotors) return json;
  json["rotors"] = make_json(*r.rotors);
  if (!r.rotors->is_synchronous) json["speed"] = r.speed;
  return json;
}

}  // namespace bough::cli
