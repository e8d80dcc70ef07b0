#include <fmt/format.h>

#include <cmath>

#include "cli/common/console.hpp"
#include "cli/compare/compare_report.hpp"

namespace bough::cli {

namespace {

using analysis::PairReport;
using analysis::RefinementReport;
using analysis::SingleReport;

std::string percent(double fraction, int digits = 2) {
  return std::isnan(fraction) ? "-" : fmt::format("{:.{}f}", 100 * fraction, digits);
}
std::string number(double value) { return std::isnan(value) ? "-" : fmt::format("{:.6g}", value + 0.0); }
std::string difference(double value) { return std::isnan(value) ? "-" : fmt::format("{:.2e}", value); }

std::string format_captured(const SingleReport& r) {
  std::string text = "\ncaptured by the modes so far, exact integrals: Γ0 Γ0ᵀ -> m, Γ1 Γ1ᵀ -> J about Bo\n";
  Table table{{"mode", "Hz", "m x %", "m y %", "m z %", "J x %", "J y %", "J z %"}, {}};
  const auto& exact = r.check.captured[2].fraction;
  for (int j = 0; j < r.num_modes(); ++j) {
    std::vector<std::string> row{std::to_string(j + 1), number(r.frequency_hz[j])};
    for (int a = 0; a < 6; ++a) row.push_back(percent(exact(j, a), 3));
    table.rows.push_back(row);
  }
  text += table.to_text() + "\nwith all modes, by method\n";
  Table total{{"method", "m x %", "m y %", "m z %", "J x %", "J y %", "J z %"}, {}};
  for (std::size_t m = 0; m < modal::kNumMethods; ++m) {
    if (!r.check.has[m]) continue;
    std::vector<std::string> row{modal::kMethodNames[m]};
    for (int a = 0; a < 6; ++a) row.push_back(percent(r.check.captured[m].fraction(r.num_modes() - 1, a), 4));
    total.rows.push_back(row);
  }
  return text + total.to_text();
}

std::string describe(const std::string& letter, const std::string& file, const modal::ModalModel& m) {
  return fmt::format("{}  {}: mass {:.8g}, centre of mass ({:.6g}, {:.6g}, {:.6g}), {} nodes, {} modes\n", letter, file,
                     m.mass, m.cg.x() + 0.0, m.cg.y() + 0.0, m.cg.z() + 0.0, m.node_id.size(), m.num_modes());
}

std::string format_pairs(const PairReport& r) {
  const std::string unit = r.a.is_buckling ? "factor" : "Hz";
  Table table{{"A", unit, "B", unit, "difference %", "MAC", "in span"}, {}};
  if (r.mass_mac) table.headings.push_back("MAC by mass");
  std::vector<bool> used(static_cast<std::size_t>(r.b.num_modes()));
  std::size_t next = 0;
  for (int i = 0; i < r.a.num_modes(); ++i) {
    const double hz = r.a.frequency_hz[i];
    if (next >= r.pairs.size() || r.pairs[next].a != i) {
      table.rows.push_back({std::to_string(i + 1), number(hz), "-"});
      continue;
    }
    const auto& p = r.pairs[next++];
    used[static_cast<std::size_t>(p.b)] = true;
    const double other = r.b.frequency_hz[p.b];
    table.rows.push_back({std::to_string(i + 1), number(hz), std::to_string(p.b + 1), number(other),
                          hz != 0 ? fmt::format("{:+.4f}", 100 * (other / hz - 1)) : "-", fmt::format("{:.6f}", p.mac),
                          fmt::format("{:.6f}", p.in_span)});
    if (r.mass_mac) table.rows.back().push_back(fmt::format("{:.6f}", (*r.mass_mac)(p.a, p.b)));
  }
  for (int j = 0; j < r.b.num_modes(); ++j)
    if (!used[static_cast<std::size_t>(j)])
      table.rows.push_back({"-", "", std::to_string(j + 1), number(r.b.frequency_hz[j])});
  return "\n" + table.to_text();
}

std::string format_effective_mass(const PairReport& r) {
  if (r.a.effective_mass.rows() == 0 || r.b.effective_mass.rows() == 0 || r.pairs.empty()) return {};
  Table table{{"effective mass %", "", "x", "y", "z", "rx", "ry", "rz"}, {}};
  const auto add = [&](const modal::ModalModel& m, int mode, const std::string& letter, const std::string& name) {
    std::vector<std::string> row{name, letter};
    for (int a = 0; a < 6; ++a)
      row.push_back(m.rigid[a] > 0 ? percent(m.effective_mass(mode, a) / m.rigid[a], 3) : "-");
    table.rows.push_back(row);
  };
  for (const auto& p : r.pairs) {
    add(r.a, p.a, "A", fmt::format("mode {}", p.a + 1));
    add(r.b, p.b, "B", fmt::format("{}", p.b + 1));
  }
  return "\n" + table.to_text();
}

std::string format_bodies(const PairReport& r) {
  std::string text;
  const auto& c = *r.bodies;
  Table integrals{{"A", "B", "integrals", "Γ0", "Γ1", "Γ2", "Γ3", "Γ4"}, {}};
  for (std::size_t i = 0; i < r.pairs.size(); ++i)
    for (std::size_t m = 0; m < modal::kNumMethods; ++m) {
      if (!c.has[m]) continue;
      std::vector<std::string> row{std::to_string(r.pairs[i].a + 1), std::to_string(r.pairs[i].b + 1),
                                   modal::kMethodNames[m]};
      for (int k = 0; k < modal::kNumIntegrals; ++k)
        row.push_back(difference(c.difference[m](static_cast<Eigen::Index>(i), k)));
      integrals.rows.push_back(row);
    }
  if (!integrals.rows.empty())
    text += "\nrelative difference of the mass integrals, B with the sign of A and about its origin\n" +
            integrals.to_text();
  Table stiffness{{"K_G of", "|A|", "|B|", "relative difference"}, {}};
  for (const auto& d : c.stiffness)
    stiffness.rows.push_back({d.load.substr(0, 40), number(d.norm_a), number(d.norm_b), difference(d.difference)});
  if (!stiffness.rows.empty()) text += "\n" + stiffness.to_text();
  Table energy{{"strain energy of third order", "|A|", "|B|", "relative difference"}, {}};
  for (const auto& d : c.energy)
    energy.rows.push_back({d.load, number(d.norm_a), number(d.norm_b), difference(d.difference)});
  if (!energy.rows.empty()) text += "\n" + energy.to_text();
  if (!c.energy_note.empty()) text += "\n" + c.energy_note + "\n";
  return text;
}

}  // namespace

std::string format_report(const SingleReport& r) {
  std::string text = fmt::format("body \"{}\": mass integrals by method; differences from the exact set\n", r.name);
  Table table{{"mode", "Hz", "", "lumped", "consistent", "exact", "lumped diff", "consistent diff"}, {}};
  for (int j = 0; j < r.num_modes(); ++j)
    for (int k = 0; k < modal::kNumIntegrals; ++k) {
      std::vector<std::string> row{k == 0 ? std::to_string(j + 1) : "", k == 0 ? number(r.frequency_hz[j]) : "",
                                   "|Γ" + std::to_string(k) + "|"};
      for (std::size_t m = 0; m < modal::kNumMethods; ++m)
        row.push_back(r.check.has[m] ? number(r.check.norm[m](j, k)) : "-");
      for (std::size_t m = 0; m + 1 < modal::kNumMethods; ++m)
        row.push_back(r.check.has[m] ? difference(r.check.difference[m](j, k)) : "-");
      table.rows.push_back(row);
    }
  if (r.num_modes() == 0 || !r.check.has[2]) return text;
  return text + table.to_text() + format_captured(r);
}

std::string format_report(const PairReport& r) {
  std::string text = describe("A", r.file_a, r.a) + describe("B", r.file_b, r.b);
  text +=
      fmt::format("{} nodes in common: {} by id, {} by place", r.match.pairs.size(), r.match.by_id, r.match.by_place);
  if (!r.match.offset.isZero(0))
    text += fmt::format(", B's places are A's + ({:.6g}, {:.6g}, {:.6g})", r.match.offset.x(), r.match.offset.y(),
                        r.match.offset.z());
  text += "\n" + format_pairs(r) + format_effective_mass(r);
  if (r.bodies) text += format_bodies(r);
  return text;
}

std::string format_report(const RefinementReport& r) {
  std::string text;
  for (std::size_t i = 0; i < 3; ++i)
    text +=
        fmt::format("{}  {}: mean element size {:.6g}\n", static_cast<char>('A' + i), r.files[i], r.element_size[i]);
  Table table{{"mode", "", "A", "B", "C", "order", "extrapolated"}, {}};
  int last = 0;
  for (const auto& row : r.rows) {
    table.rows.push_back({row.mode == last ? "" : std::to_string(row.mode), row.quantity,
                          fmt::format("{:.10g}", row.value[0]), fmt::format("{:.10g}", row.value[1]),
                          fmt::format("{:.10g}", row.value[2]),
                          std::isnan(row.order) ? "-" : fmt::format("{:.2f}", row.order),
                          std::isnan(row.extrapolated) ? "-" : fmt::format("{:.10g}", row.extrapolated)});
    last = row.mode;
  }
  return text + "\n" + table.to_text();
}

}  // namespace bough::cli
