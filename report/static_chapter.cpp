#include "report/static_chapter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "report/drawing.hpp"
#include "report/element_fields.hpp"
#include "report/html.hpp"
#include "report/shape_plot.hpp"

namespace bough::report {

namespace {

using Eigen::Index;
using records::StaticResult;
using records::StaticSubcase;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr std::size_t kMaxSubcases = 20, kMaxTableRows = 30;
constexpr double kMaxEpsilon = 1e-6;  // as the listings of others hold it

std::string name_subcase(const StaticSubcase& s) {
  return s.label.empty() ? fmt::format("subcase {}", s.id) : fmt::format("subcase {}: {}", s.id, s.label);
}

/// Six values a grid, in order of the map; of scalar points the first.
std::vector<std::pair<int, Vector6>> gather(const StaticResult& result, const Eigen::VectorXd& values) {
  std::vector<std::pair<int, Vector6>> grids;
  for (Index i = 0; i < values.size(); ++i) {
    const int node = result.dof_map(i, 0), code = result.dof_map(i, 1);
    if (grids.empty() || grids.back().first != node) grids.emplace_back(node, Vector6::Zero());
    grids.back().second[std::clamp(code - 1, 0, 5)] = values[i];
  }
  return grids;
}

double find_largest_translation(const StaticResult& result, const StaticSubcase& s, int& grid) {
  double largest = 0;
  for (const auto& [node, value] : gather(result, s.displacement))
    if (const double size = value.head<3>().norm(); size > largest) largest = size, grid = node;
  return largest;
}

/// The rows of largest translation (or force); rows of zeros, as rounding leaves them, are no reactions.
std::string make_grid_table(const std::string& caption, const std::string& force,
                            std::vector<std::pair<int, Vector6>> grids) {
  Vector6 largest = Vector6::Zero();
  for (const auto& one : grids) largest = largest.cwiseMax(one.second.cwiseAbs());
  const double force_size = largest.head<3>().maxCoeff(), moment_size = largest.tail<3>().maxCoeff();
  const auto get_share = [&](const Vector6& v) {
    return std::max(force_size > 0 ? v.head<3>().norm() / force_size : 0,
                    moment_size > 0 ? v.tail<3>().norm() / moment_size : 0);
  };
  std::erase_if(grids, [&](const auto& one) { return get_share(one.second) < 1e-12; });
  std::stable_sort(grids.begin(), grids.end(),
                   [&](const auto& a, const auto& b) { return get_share(a.second) > get_share(b.second); });
  const bool is_force = !force.empty();
  HtmlTable table(caption, {{"grid"},
                            {is_force ? "Fx" : "x"},
                            {is_force ? "Fy" : "y"},
                            {is_force ? "Fz" : "z"},
                            {is_force ? "Mx" : "rx"},
                            {is_force ? "My" : "ry"},
                            {is_force ? "Mz" : "rz"}});
  for (const auto& [node, v] : grids) {
    std::vector<std::string> row{std::to_string(node)};
    for (const double x : v) row.push_back(format_value(x));
    table.add_row(std::move(row));
  }
  return table.empty() ? make_text(caption + ": none.") : table.to_html(kMaxTableRows);
}

/// Least and largest of each column, with the elements.
template <class Block>
std::string make_ends(const std::string& caption, const std::vector<Block>& blocks,
                      const Eigen::MatrixXd Block::*values) {
  HtmlTable table(caption,
                  {{"card", true}, {"component", true}, {"least"}, {"of element"}, {"largest"}, {"of element"}});
  for (const auto& block : blocks) {
    const Eigen::MatrixXd& m = block.*values;
    for (Index c = 0; c < m.cols(); ++c) {
      Index low = -1, high = -1;
      for (Index e = 0; e < m.rows(); ++e) {
        if (!std::isfinite(m(e, c))) continue;
        if (low < 0 || m(e, c) < m(low, c)) low = e;
        if (high < 0 || m(e, c) > m(high, c)) high = e;
      }
      if (low < 0 || (m(low, c) == 0 && m(high, c) == 0)) continue;
      const auto get_id = [&](Index e) { return std::to_string(block.id[static_cast<std::size_t>(e)]); };
      table.add_row({block.card, block.components[static_cast<std::size_t>(c)], format_value(m(low, c)), get_id(low),
                     format_value(m(high, c)), get_id(high)});
    }
  }
  return table.empty() ? "" : "<details><summary>" + caption + "</summary>\n" + table.to_html(400) + "</details>\n";
}

std::string make_margins(const StaticSubcase& s) {
  HtmlTable table("Least margins of safety", {{"card", true}, {"stress", true}, {"margin"}, {"of element"}});
  const std::array<const char*, 3> names{"tension", "compression", "shear"};
  for (const auto& block : s.margins)
    for (Index c = 0; c < block.margin.cols(); ++c) {
      Index low = -1;
      for (Index e = 0; e < block.margin.rows(); ++e)
        if (std::isfinite(block.margin(e, c)) && (low < 0 || block.margin(e, c) < block.margin(low, c))) low = e;
      if (low >= 0)
        table.add_row({block.card, names[static_cast<std::size_t>(c)], format_value(block.margin(low, c), 4),
                       std::to_string(block.id[static_cast<std::size_t>(low)])});
    }
  return table.empty() ? "" : table.to_html();
}

std::string make_sums(const StaticSubcase& s) {
  HtmlTable table("Sums about the origin, basic axes", {{"", true}, {"Fx"}, {"Fy"}, {"Fz"}, {"Mx"}, {"My"}, {"Mz"}});
  const auto add = [&](const char* name, const Vector6& v) {
    std::vector<std::string> row{name};
    for (const double x : v) row.push_back(format_value(x));
    table.add_row(std::move(row));
  };
  add("loads", s.load_resultant);
  add("single-point constraints", s.reaction_resultant);
  if (s.mpc_resultant.cwiseAbs().maxCoeff() > 0) add("multipoint constraints, rigid elements", s.mpc_resultant);
  return table.to_html();
}

std::string make_panel(const StaticResult& result, const StaticSubcase& s) {
  std::string html = make_sums(s);
  html += make_grid_table("Largest displacements, basic axes", "", gather(result, s.displacement));
  html += make_grid_table("Forces of single-point constraints", "F", gather(result, s.reaction));
  html += make_margins(s);
  html += make_ends("Forces of elements", s.elements, &records::ElementForces::force);
  html += make_ends("Stresses", s.stresses, &records::ElementStresses::stress);
  html += make_ends("Strains", s.strains, &records::ElementStresses::stress);
  return html;
}

/// Shares of the sum of all elements, those that are not drawn too.
void add_element_energies(const StaticResult& result, Drawing& drawing) {
  std::vector<int> id;
  std::map<int, Index> row_of;
  for (const auto& s : result.subcases)
    for (const auto& block : s.elements)
      for (const int element : block.id)
        if (row_of.try_emplace(element, static_cast<Index>(id.size())).second) id.push_back(element);
  if (id.empty()) return;
  Eigen::MatrixXd energy =
      Eigen::MatrixXd::Zero(static_cast<Index>(id.size()), static_cast<Index>(result.subcases.size()));
  for (std::size_t c = 0; c < result.subcases.size(); ++c)
    for (const auto& block : result.subcases[c].elements)
      for (std::size_t e = 0; e < block.id.size() && static_cast<Index>(e) < block.strain_energy.size(); ++e)
        energy(row_of.at(block.id[e]), static_cast<Index>(c)) = block.strain_energy[static_cast<Index>(e)];
  add_energies(result.mesh, id, energy, energy.colwise().sum().transpose(), drawing);
}

Drawing draw_subcases(const StaticResult& result) {
  std::map<int, Index> index_of;
  for (std::size_t i = 0; i < result.mesh.grid_id.size(); ++i)
    index_of.emplace(result.mesh.grid_id[i], static_cast<Index>(i));
  const auto cases = static_cast<Index>(result.subcases.size());
  std::vector<Eigen::MatrixXd> phi(result.mesh.grid_id.size(), Eigen::MatrixXd::Zero(6, cases));
  for (Index c = 0; c < cases; ++c) {
    const auto& u = result.subcases[static_cast<std::size_t>(c)].displacement;
    for (Index i = 0; i < u.size(); ++i) {
      const auto found = index_of.find(result.dof_map(i, 0));
      const int code = result.dof_map(i, 1);
      if (found != index_of.end() && code >= 1 && code <= 6)
        phi[static_cast<std::size_t>(found->second)](code - 1, c) = u[i];
    }
  }
  auto drawing = make_drawing(result.mesh, result.mesh.grid_id, result.mesh.grid_xyz, phi);
  add_element_energies(result, drawing);
  return drawing;
}

}  // namespace

Chapter make_chapter(const StaticResult& result, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts) {
  Chapter chapter{"static solution", file, facts, {}, {}, {}, {}};
  chapter.facts.emplace_back("subcases", std::to_string(result.subcases.size()));
  chapter.facts.emplace_back("degrees of freedom", std::to_string(result.dof_map.rows()));
  HtmlTable summary(
      "", {{"subcase"}, {"label", true}, {"largest displacement"}, {"at grid"}, {"strain energy"}, {"epsilon"}});
  double worst = 0;
  double largest_of_all = 0;
  for (const auto& s : result.subcases) {
    int grid = 0;
    const double largest = find_largest_translation(result, s, grid);
    summary.add_row({std::to_string(s.id), s.label, format_value(largest), grid > 0 ? std::to_string(grid) : "",
                     format_value(s.strain_energy), format_value(s.epsilon, 2)});
    worst = std::max(worst, s.epsilon);
    if (largest > largest_of_all) {
      largest_of_all = largest;
      chapter.highlights = {
          {"largest displacement", format_value(largest, 4), fmt::format("grid {}, {}", grid, name_subcase(s))},
          {"strain energy", format_value(s.strain_energy, 4), name_subcase(s)},
          {"epsilon", format_value(s.epsilon, 2), "work of the residual over the work of the loads"}};
    }
  }
  chapter.checks.push_back({"largest epsilon: work of the residual over the work of the loads", format_value(worst, 2),
                            worst < kMaxEpsilon ? Verdict::Good : Verdict::Warning, "below 1e-6"});
  Drawing drawing = draw_subcases(result);
  const int num_left_out = add_fields(result, drawing);
  if (!drawing.shapes.empty()) {
    std::vector<std::string> titles;
    for (const auto& s : result.subcases) titles.push_back(name_subcase(s));
    std::string html = make_live("modes", draw_shapes(drawing, titles));
    if (drawing.num_dropped > 0)
      html += make_text(fmt::format("To keep the page small it has the shapes of the first {} of {} subcases.",
                                    drawing.shapes.size(), result.subcases.size()),
                        "note");
    if (num_left_out > 0)
      html +=
          make_text(fmt::format("To keep the page small it has the colours of {} of {} columns of stresses, strains "
                                "and margins; bough export writes all for ParaView.",
                                drawing.fields.size(), drawing.fields.size() + static_cast<std::size_t>(num_left_out)),
                    "note");
    chapter.add_panel("shapes", drawing.fields.empty() ? "Deformed shapes" : "Deformed shapes and stresses", html);
    auto names = nlohmann::json::array();
    for (const auto& s : result.subcases) names.push_back(name_subcase(s));
    chapter.data = nlohmann::json{{"names", names}, {"drawing", nlohmann::json::parse(to_json_text(drawing))}}.dump(
        -1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  chapter.add_panel("summary", "Subcases", summary.to_html());
  for (std::size_t c = 0; c < std::min(kMaxSubcases, result.subcases.size()); ++c) {
    const auto& s = result.subcases[c];
    chapter.add_panel(fmt::format("subcase-{}", s.id), name_subcase(s), make_panel(result, s));
  }
  if (result.subcases.size() > kMaxSubcases)
    chapter.add_panel("others", "Others",
                      make_text(fmt::format("The first {} of {} subcases have tables of their own.", kMaxSubcases,
                                            result.subcases.size()),
                                "note"));
  return chapter;
}

}  // namespace bough::report
