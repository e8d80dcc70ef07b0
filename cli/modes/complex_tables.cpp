#include "cli/modes/complex_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/common/console.hpp"

namespace bough::cli {

using records::ComplexModesResult;

std::string format_complex_modes(const ComplexModesResult& r) {
  Table table{{"mode", "real", "imaginary", "Hz", "damping g", "ratio", "residual"}, {}};
  for (Eigen::Index j = 0; j < r.eigenvalue.size(); ++j)
    table.rows.push_back({std::to_string(j + 1), fmt::format("{:.8g}", r.eigenvalue(j).real()),
                          fmt::format("{:.8g}", r.eigenvalue(j).imag()), fmt::format("{:.7g}", r.frequency_hz(j)),
                          fmt::format("{:.6g}", r.damping(j)), fmt::format("{:.6g}", r.damping_ratio(j)),
                          fmt::format("{:.1e}", r.residual(j))});
  std::string text = "complex eigenvalues, imaginary part not below 0\n" + table.to_text() + "\n";
  const auto count_if = [&](const auto& is_one) {
    return std::count_if(r.eigenvalue.begin(), r.eigenvalue.end(), is_one);
  };
  // An undamped mode is unstable by round-off alone.
  const auto unstable = count_if([](std::complex<double> l) { return l.real() > 1e-9 * std::abs(l); });
  if (unstable > 0) text += fmt::format("unstable: {} of {} (real part above 0)\n", unstable, r.eigenvalue.size());
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
  return {{"subcase", r.subcase},
          {"solution", r.is_by_modes ? "modal" : "direct"},
          {"method", r.method},
          {"norm", r.norm},
          {"symmetric", r.left.empty()},
          {"complete", r.is_complete},
          {"shift", {{"real", r.shift.real()}, {"imag", r.shift.imag()}}},
          {"biorthogonality", r.biorthogonality},
          {"modes", modes}};
}

}  // namespace bough::cli
