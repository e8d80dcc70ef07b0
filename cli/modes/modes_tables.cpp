#include "cli/modes/modes_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/common/solver_option.hpp"

namespace bough::cli {
namespace {

/// Number of eigenpairs, which precede the residual vectors.
Eigen::Index count_eigenpairs(const records::ModesResult& r) {
  if (r.kind.empty()) return r.residual.size();
  return std::count(r.kind.begin(), r.kind.end(), records::ModeKind::Normal);
}

}  // namespace

std::string format_modes(const records::ModesResult& r) {
  Table roots{{"mode", "eigenvalue", "rad/s", "Hz", "modal mass", "residual"}, {}};
  Table shares{{"mode", "x", "sum", "y", "sum", "z", "sum", "rx", "ry", "rz"}, {}};
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (int j = 0; j < r.eigenvalue.size(); ++j) {
    const std::string number = std::to_string(j + 1);
    roots.rows.push_back({number, fmt::format("{:.8g}", r.eigenvalue[j]),
                          fmt::format("{:.7g}", 2 * M_PI * r.frequency_hz[j]), fmt::format("{:.7g}", r.frequency_hz[j]),
                          fmt::format("{:.6g}", r.modal_mass[j]),
                          j < count_eigenpairs(r) ? fmt::format("{:.1e}", r.residual[j]) : "residual vector"});
    std::vector<std::string> row{number};
    for (int a = 0; a < 6; ++a) {
      const double total = r.mass_properties.rigid_mass(a, a);
      const double share = total > 0 ? 100 * r.effective_mass(j, a) / total : 0;
      row.push_back(fmt::format("{:.2f}", share));
      if (a < 3) row.push_back(fmt::format("{:.2f}", sum[a] += share));
    }
    shares.rows.push_back(std::move(row));
  }
  return roots.to_text() + "\neffective mass, % of the mass and of the inertia about the origin\n" + shares.to_text();
}

std::string format_buckling(const records::ModesResult& r) {
  Table table{{"mode", "load factor", "residual"}, {}};
  for (int j = 0; j < r.load_factor.size(); ++j) {
    table.rows.push_back(
        {std::to_string(j + 1), fmt::format("{:.8g}", r.load_factor[j]), fmt::format("{:.1e}", r.residual[j])});
  }
  return table.to_text();
}

std::string format_health(const records::ModesResult& r, const std::vector<modal::SolverUse>& solvers,
                          const std::string& norm, bool buckling) {
  const auto n = count_eigenpairs(r);
  std::string text = buckling ? "" : fmt::format("rigid-body modes: {}\n", r.num_rigid_modes);
  if (norm == "MAX" || norm == "POINT")
    text += fmt::format("shapes: {} (NORM = {} of the deck){}\n",
                        norm == "MAX" ? "the largest component is 1" : "one dof is 1", norm,
                        buckling ? "" : "; modal mass and stiffness go with them");
  // A missed mode is an error of modal (modal.missed-modes); others in the count are below the range or repeated.
  const char* what = buckling ? "load factors" : "eigenvalues";
  if (n == 0) return text + fmt::format("no {} in the range asked for\n", what);
  if (r.inertia_count >= 0) {
    text +=
        fmt::format("Sturm count: {} {} up to the highest, {} in the table: none missed{}\n", r.inertia_count, what, n,
                    r.inertia_count <= n ? ""
                    : buckling           ? " (the others are farther from zero, below the range or copies of the last)"
                                         : " (the others are below the range or copies of the last root)");
  } else {
    text += "Sturm count: none, or none to be trusted\n";
  }
  if (n > 0) text += fmt::format("largest residual: {:.1e}\n", r.residual.head(n).maxCoeff());
  text += fmt::format("eigensolver: {}\n", modal::describe_uses(solvers));
  return text;
}

std::string format_residual_vectors(const records::ModesResult& r, const std::vector<std::string>& loads,
                                    const std::vector<std::string>& unused) {
  if (loads.empty()) return {};
  const auto n = r.residual.size() - count_eigenpairs(r);
  auto text = fmt::format("residual vectors: {}, the last in the table, of {}\n", n, fmt::join(loads, ", "));
  if (!unused.empty())
    text += fmt::format("no residual vector of {}: the modes hold its answer\n", fmt::join(unused, ", "));
  return text;
}

namespace {

/// One object per mode: the rows of the tables.
nlohmann::json list_modes(const records::ModesResult& r, bool buckling) {
  auto modes = nlohmann::json::array();
  for (Eigen::Index j = 0; j < r.residual.size(); ++j) {
    nlohmann::json mode{{"mode", j + 1}, {"residual", r.residual(j)}};
    if (j >= count_eigenpairs(r)) mode["kind"] = "residual";
    if (buckling) {
      mode["load_factor"] = r.load_factor(j);
    } else {
      mode["eigenvalue"] = r.eigenvalue(j);
      mode["frequency_hz"] = r.frequency_hz(j);
      mode["modal_mass"] = r.modal_mass(j);
      mode["effective_mass"] = to_json_list(r.effective_mass.row(j).transpose());
    }
    modes.push_back(std::move(mode));
  }
  return modes;
}

}  // namespace

nlohmann::json make_json(const records::ModesResult& r, const std::vector<modal::SolverUse>& solvers,
                         const std::string& norm, bool buckling) {
  nlohmann::json json{{"subcase", r.subcase},
                      {"mass_properties", to_json(r.mass_properties)},
                      {"num_rigid_modes", r.num_rigid_modes},
                      {"inertia_count", r.inertia_count},
                      {"norm", norm},
                      {"solvers", to_json(solvers)},
                      {"modes", list_modes(r, buckling)},
                      {"residual", to_json_list(r.residual)}};
  if (buckling) {
    json["load_factor"] = to_json_list(r.load_factor);
    return json;
  }
  json["eigenvalue"] = to_json_list(r.eigenvalue);
  json["frequency_hz"] = to_json_list(r.frequency_hz);
  json["modal_mass"] = to_json_list(r.modal_mass);
  json["effective_mass"] = to_json(r.effective_mass);
  if (const auto& about = r.effective_mass_about; about.grid != 0)
    json["effective_mass_about"] = {
        {"grid", about.grid}, {"mass", to_json(about.mass)}, {"rigid", to_json_list(about.rigid.diagonal())}};
  if (const auto& e = r.energies; !e.empty())
    json["energies"] = {{"id", e.id},
                        {"card", e.card},
                        {"property", e.property},
                        {"strain", to_json(e.strain)},
                        {"kinetic", to_json(e.kinetic)},
                        {"total_strain", to_json_list(e.total_strain)},
                        {"total_kinetic", to_json_list(e.total_kinetic)}};
  return json;
}

std::string format_sensitivities(const analysis::ModeSensitivities& s) {
  Table table{{"mode", "Hz", "DESVAR", "label", "value", "dHz/dx", "(x/Hz) dHz/dx", "d eigenvalue/dx"}, {}};
  for (Eigen::Index j = 0; j < s.frequency_hz.size(); ++j)
    for (std::size_t v = 0; v < s.variables.size(); ++v) {
      const auto& variable = s.variables[v];
      const auto column = static_cast<Eigen::Index>(v);
      const double hz = s.frequency_hz[j], slope = s.frequency_slope_hz(j, column);
      table.rows.push_back({v == 0 ? std::to_string(j + 1) : "", v == 0 ? fmt::format("{:.6g}", hz) : "",
                            std::to_string(variable.id), variable.label, fmt::format("{:.6g}", variable.value),
                            std::isnan(slope) ? "-" : fmt::format("{:.6g}", slope),
                            std::isnan(slope) ? "-" : fmt::format("{:.6g}", variable.value / hz * slope),
                            fmt::format("{:.6g}", s.eigenvalue(j, column))});
    }
  return "\nsensitivities to the design variables\n" + table.to_text();
}

nlohmann::json make_json(const analysis::ModeSensitivities& s) {
  auto variables = nlohmann::json::array();
  for (std::size_t v = 0; v < s.variables.size(); ++v) {
    const auto column = static_cast<Eigen::Index>(v);
    variables.push_back({{"id", s.variables[v].id},
                         {"label", s.variables[v].label},
                         {"value", s.variables[v].value},
                         {"eigenvalue", to_json_list(Eigen::VectorXd(s.eigenvalue.col(column)))},
                         {"frequency_hz", to_json_list(Eigen::VectorXd(s.frequency_slope_hz.col(column)))}});
  }
  return variables;
}

}  // namespace bough::cli
