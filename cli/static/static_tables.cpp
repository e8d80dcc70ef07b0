#include "cli/static/static_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "cli/static/extremes_tables.hpp"

namespace bough::cli {

namespace {

using Eigen::VectorXd;

const std::vector<std::string> kComponents{"x", "y", "z", "rx", "ry", "rz"};

/// Largest magnitude of each component of a g-set vector: (signed value, node id).
struct Extreme {
  double value = 0;
  int id = 0;
};
std::vector<Extreme> find_maxima(const Eigen::MatrixXi& dof_map, const VectorXd& values) {
  std::vector<Extreme> maxima(6);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    auto& max_extreme = maxima[static_cast<std::size_t>(std::max(dof_map(i, 1), 1) - 1)];
    if (max_extreme.id == 0 || std::abs(values[i]) > std::abs(max_extreme.value) * (1 + 1e-9))
      max_extreme = {values[i], dof_map(i, 0)};
  }
  return maxima;
}

std::string format_maxima(const Eigen::MatrixXi& dof_map, const records::StaticSubcase& s) {
  Table table{{"largest", "displacement", "at grid", "reaction", "at grid"}, {}};
  const auto u = find_maxima(dof_map, s.displacement), r = find_maxima(dof_map, s.reaction);
  for (std::size_t c = 0; c < 6; ++c)
    table.rows.push_back({kComponents[c], fmt::format("{:.6e}", u[c].value), std::to_string(u[c].id),
                          fmt::format("{:.6e}", r[c].value), std::to_string(r[c].id)});
  return table.to_text();
}

std::string format_balance(const records::StaticSubcase& s) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  std::vector<std::pair<std::string, Vector6d>> columns{
      {"OLOAD", s.load_resultant}, {"SPCFORCE", s.reaction_resultant}, {"MPCFORCE", s.mpc_resultant}};
  if (s.inertia.size() > 0) columns.emplace_back("INERTIA", s.inertia_resultant);
  Vector6d sum = Vector6d::Zero();
  for (const auto& [name, f] : columns) sum += f;
  columns.emplace_back("sum", sum);
  Table table{{""}, {}};
  for (const auto& [name, f] : columns) table.headings.push_back(name);
  for (int i = 0; i < 6; ++i) {
    std::vector<std::string> row{std::string(i < 3 ? "F" : "M") + "xyz"[i % 3]};
    for (const auto& [name, f] : columns) row.push_back(fmt::format("{:.6e}", f[i] + 0.0));
    table.rows.push_back(std::move(row));
  }
  return "resultants about the origin\n" + table.to_text() +
         fmt::format("\nepsilon {:.3e}, strain energy {:.8g}\n", s.epsilon, s.strain_energy);
}

std::string format_support(const records::StaticSubcase& s) {
  if (s.support.empty()) return {};
  Table table{{"SUPORT", "component", "strain energy", "acceleration"}, {}};
  for (const auto& row : s.support)
    table.rows.push_back({std::to_string(row.node), std::to_string(row.component),
                          fmt::format("{:.3e}", row.strain_energy),
                          s.inertia.size() > 0 ? fmt::format("{:.6e}", row.acceleration) : ""});
  return table.to_text() + fmt::format("\nepsilon of SUPORT {:.3e}\n\n", s.support_epsilon);
}

/// Grids whose vector is not zero: six numbers each, a scalar point's in the first.
std::string format_vector(const std::string& name, const Eigen::MatrixXi& dof_map, const VectorXd& values) {
  Table table{{name, "x", "y", "z", "rx", "ry", "rz"}, {}};
  for (Eigen::Index i = 0; i < values.size();) {
    const Eigen::Index n = dof_map(i, 1) == 0 ? 1 : 6;
    if (!values.segment(i, n).isZero(0)) {
      std::vector<std::string> row{std::to_string(dof_map(i, 0))};
      for (Eigen::Index c = 0; c < 6; ++c) row.push_back(c < n ? fmt::format("{:.6e}", values[i + c] + 0.0) : "");
      table.rows.push_back(std::move(row));
    }
    i += n;
  }
  return table.to_text();
}

/// Every element, a row each.
std::string format_all(const std::string& title, const std::vector<int>& id, const std::vector<std::string>& names,
                       const Eigen::MatrixXd& values) {
  Table table{{title}, {}};
  table.headings.insert(table.headings.end(), names.begin(), names.end());
  for (Eigen::Index e = 0; e < values.rows(); ++e) {
    std::vector<std::string> row{std::to_string(id[static_cast<std::size_t>(e)])};
    for (Eigen::Index c = 0; c < values.cols(); ++c) row.push_back(fmt::format("{:.6e}", values(e, c)));
    table.rows.push_back(std::move(row));
  }
  return table.to_text();
}

/// One row per component: those of several points (Nx@1, Nx@2, ...) share the row of their name.
std::string format_extremes(const std::string& title, const std::vector<int>& id, const std::vector<std::string>& names,
                            const Eigen::MatrixXd& values) {
  Table table{{title, "smallest", "element", "largest", "element"}, {}};
  std::vector<std::pair<std::string, std::vector<Eigen::Index>>> groups;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const std::string name = names[c].substr(0, names[c].find('@'));
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == name; });
    auto& columns = same == groups.end() ? groups.emplace_back(name, std::vector<Eigen::Index>{}).second : same->second;
    columns.push_back(static_cast<Eigen::Index>(c));
  }
  for (const auto& [name, columns] : groups) {
    Extreme min_extreme, max_extreme;
    for (const auto column : columns) {
      // Positions are searched in few columns only: this is slower than the search for the extreme values.
      const auto all = values.col(column);
      const double min = all.minCoeff(), max = all.maxCoeff();
      Eigen::Index at = 0;
      if (min_extreme.id == 0 || !(min >= min_extreme.value)) {
        const double value = all.minCoeff(&at);
        min_extreme = {value, id[static_cast<std::size_t>(at)]};
      }
      if (max_extreme.id == 0 || !(max <= max_extreme.value)) {
        const double value = all.maxCoeff(&at);
        max_extreme = {value, id[static_cast<std::size_t>(at)]};
      }
    }
    table.rows.push_back({name, fmt::format("{:.6e}", min_extreme.value), std::to_string(min_extreme.id),
                          fmt::format("{:.6e}", max_extreme.value), std::to_string(max_extreme.id)});
  }
  return table.to_text();
}

std::string format_elements(const records::ElementForces& block, bool full) {
  Eigen::MatrixXd values(block.force.rows(), block.force.cols() + 1);
  values << block.force, block.strain_energy;
  auto names = block.components;
  names.emplace_back("strain energy");
  return full ? format_all(block.card, block.id, names, values) : format_extremes(block.card, block.id, names, values);
}

std::string format_stresses(const records::ElementStresses& block, const char* what, bool full) {
  const std::string title = block.card + " " + what;
  return full ? format_all(title, block.id, block.components, block.stress)
              : format_extremes(title, block.id, block.components, block.stress);
}

/// Grid by grid, with the sum.
std::string format_grid_forces(const std::vector<records::GridForce>& forces) {
  if (forces.empty()) return {};
  Table table{{"grid", "source", "x", "y", "z", "rx", "ry", "rz"}, {}};
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  const auto add = [&](int node, const std::string& source, const Eigen::Matrix<double, 6, 1>& f) {
    std::vector<std::string> row{std::to_string(node), source};
    for (int c = 0; c < 6; ++c) row.push_back(fmt::format("{:.6e}", f[c] + 0.0));
    table.rows.push_back(std::move(row));
  };
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const auto& f = forces[i];
    add(f.node, f.element > 0 ? fmt::format("{} {}", f.source, f.element) : f.source, f.force);
    sum += f.force;
    if (i + 1 < forces.size() && forces[i + 1].node == f.node) continue;
    add(f.node, "sum", sum);
    sum.setZero();
  }
  return "forces on grids\n" + table.to_text() + "\n";
}

nlohmann::json list_maxima(const std::vector<Extreme>& maxima) {
  auto list = nlohmann::json::array();
  for (std::size_t c = 0; c < maxima.size(); ++c)
    list.push_back({{"component", kComponents[c]}, {"value", maxima[c].value}, {"grid", maxima[c].id}});
  return list;
}

/// The largest magnitude of each component over the elements.
nlohmann::json list_stress_maxima(const records::ElementStresses& block) {
  auto list = nlohmann::json::array();
  for (std::size_t c = 0; c < block.components.size(); ++c) {
    Eigen::Index e = 0;
    const auto column = block.stress.col(static_cast<Eigen::Index>(c));
    column.cwiseAbs().maxCoeff(&e);
    list.push_back(
        {{"component", block.components[c]}, {"value", column[e]}, {"element", block.id[static_cast<std::size_t>(e)]}});
  }
  return list;
}

}  // namespace

std::string format_static(const Eigen::MatrixXi& dof_map, const records::StaticSubcase& s, bool full) {
  std::string text = fmt::format("subcase {}{}: LOAD {}, SPC {}, MPC {}{}\n\n", s.id,
                                 s.label.empty() ? "" : " (" + s.label + ")", s.load_set, s.spc_set, s.mpc_set,
                                 s.temperature_set ? fmt::format(", TEMPERATURE {}", s.temperature_set) : "");
  text += format_maxima(dof_map, s) + "\n" + format_balance(s) + "\n" + format_support(s);
  if (full) {
    text += format_vector("displacement", dof_map, s.displacement) + "\n";
    text += format_vector("load", dof_map, s.load) + "\n";
    text += format_vector("reaction", dof_map, s.reaction) + "\n";
  }
  for (const auto& block : s.elements) text += format_elements(block, full) + "\n";
  for (const auto& block : s.stresses) text += format_stresses(block, "stress", full) + "\n";
  for (const auto& block : s.strains) text += format_stresses(block, "strain", full) + "\n";
  return text + format_margins(s.margins) + format_grid_forces(s.grid_forces);
}

nlohmann::json to_json(const Eigen::MatrixXi& dof_map, const records::StaticSubcase& s, bool full) {
  nlohmann::json json{{"id", s.id},
                      {"label", s.label},
                      {"load_set", s.load_set},
                      {"spc_set", s.spc_set},
                      {"mpc_set", s.mpc_set},
                      {"temperature_set", s.temperature_set},
                      {"strain_energy", s.strain_energy},
                      {"epsilon", s.epsilon},
                      {"max_displacement", list_maxima(find_maxima(dof_map, s.displacement))},
                      {"max_reaction", list_maxima(find_maxima(dof_map, s.reaction))},
                      {"resultants",
                       {{"load", to_json_list(s.load_resultant)},
                        {"reaction", to_json_list(s.reaction_resultant)},
                        {"mpc_force", to_json_list(s.mpc_resultant)}}}};
  for (const auto& row : s.support)
    json["support"].push_back({{"grid", row.node},
                               {"component", row.component},
                               {"strain_energy", row.strain_energy},
                               {"acceleration", row.acceleration}});
  if (!s.support.empty()) json["support_epsilon"] = s.support_epsilon;
  if (s.inertia.size() > 0) json["resultants"]["inertia"] = to_json_list(s.inertia_resultant);
  for (const auto& f : s.grid_forces)
    json["grid_forces"].push_back(
        {{"grid", f.node}, {"source", f.source}, {"element", f.element}, {"force", to_json_list(f.force)}});
  for (const auto& block : s.stresses) json["max_stress"][block.card] = list_stress_maxima(block);
  for (const auto& block : s.strains) json["max_strain"][block.card] = list_stress_maxima(block);
  if (!s.margins.empty()) json["margins"] = to_json(s.margins);
  if (!full) return json;
  if (s.inertia.size() > 0) json["inertia"] = to_json_list(s.inertia);
  json["dof_map"] = nlohmann::json::array();
  for (Eigen::Index i = 0; i < dof_map.rows(); ++i) json["dof_map"].push_back({dof_map(i, 0), dof_map(i, 1)});
  json["displacement"] = to_json_list(s.displacement);
  json["load"] = to_json_list(s.load);
  json["reaction"] = to_json_list(s.reaction);
  json["mpc_force"] = to_json_list(s.mpc_force);
  for (const auto& block : s.elements)
    json["elements"][block.card] = {{"id", block.id},
                                    {"components", block.components},
                                    {"force", to_json(block.force)},
                                    {"strain_energy", to_json_list(block.strain_energy)}};
  for (const auto& block : s.stresses)
    json["stresses"][block.card] = {
        {"id", block.id}, {"components", block.components}, {"stress", to_json(block.stress)}};
  for (const auto& block : s.strains)
    json["strains"][block.card] = {
        {"id", block.id}, {"components", block.components}, {"strain", to_json(block.stress)}};
  return json;
}

}  // namespace bough::cli
