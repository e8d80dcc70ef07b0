#include "cli/common/deck_tables.hpp"

#include <map>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/rotation.hpp"
#include "cli/common/console.hpp"
#include "fe/matrices/connected_parts.hpp"
#include "fe/matrices/mass_directions.hpp"
#include "fe/sections/section_library.hpp"

namespace bough::cli {

namespace {
std::string format_rows(const Eigen::Ref<const Eigen::MatrixXd>& m) {
  std::string text;
  for (int i = 0; i < m.rows(); ++i) {
    text += "  ";
    for (int j = 0; j < m.cols(); ++j) text += fmt::format(" {:14.6e}", m(i, j) + 0.0);
    text += '\n';
  }
  return text;
}

/// Where each direction has a separate mass: three masses with their centres from the reference, as in the weight
/// table of Nastran.
std::string format_masses(const fe::GridPointWeight& w) {
  std::string text = w.S.isIdentity(0) ? "" : "  principal axes of the mass (columns)\n" + format_rows(w.S);
  Table table{{"  axis", "mass", "centre x", "y", "z"}, {}};
  for (int i = 0; i < 3; ++i) {
    std::vector<std::string> row{std::string("  ") + "xyz"[i], fmt::format("{:.8g}", w.mass[i] + 0.0)};
    for (int c = 0; c < 3; ++c) row.push_back(fmt::format("{:.8g}", w.cg(i, c) + 0.0));
    table.rows.push_back(std::move(row));
  }
  return text + table.to_text();
}
}  // namespace

std::string format_mass_properties(const records::MassProperties& p) {
  std::string text = fmt::format("mass properties about ({:g}, {:g}, {:g}), basic axes\n", p.reference.x(),
                                 p.reference.y(), p.reference.z());
  text += "  rigid mass matrix (x y z, rotations x y z)\n" + format_rows(p.rigid_mass);
  if (fe::calc_mass_difference(p.rigid_mass) > fe::kMassDifference)
    return text + format_masses(fe::calc_grid_point_weight(p.rigid_mass)) + "  inertia about the reference\n" +
           format_rows(p.inertia);
  text += fmt::format("  mass {:.8g}\n  centre of mass {:.8g} {:.8g} {:.8g}\n", p.mass, p.cg.x() + 0.0, p.cg.y() + 0.0,
                      p.cg.z() + 0.0);
  text += "  inertia about the reference\n" + format_rows(p.inertia);
  text += "  inertia about the centre of mass\n" + format_rows(analysis::calc_central_inertia(p));
  text += "  principal inertias\n" + format_rows(analysis::calc_principal_inertias(p).transpose());
  return text;
}

std::string format_weight(const fe::GridPointWeight& w) {
  std::string text = w.grid ? fmt::format("grid point weights about grid {}, before WTMASS\n", w.grid)
                            : std::string("grid point weights about the origin of basic, before WTMASS\n");
  text += "  MO\n" + format_rows(w.MO) + "  S\n" + format_rows(w.S);
  Table table{{"  axis of S", "mass", "X-C.G.", "Y-C.G.", "Z-C.G."}, {}};
  for (int i = 0; i < 3; ++i) {
    std::vector<std::string> row{std::string(1, "XYZ"[i]), fmt::format("{:.6e}", w.mass[i] + 0.0)};
    for (int c = 0; c < 3; ++c) row.push_back(fmt::format("{:.6e}", w.cg(i, c) + 0.0));
    table.rows.push_back(std::move(row));
  }
  return text + table.to_text() + "  I(S)\n" + format_rows(w.I_S) + "  I(Q)\n" + format_rows(w.I_Q.transpose()) +
         "  Q\n" + format_rows(w.Q);
}

std::string format_ground_check(const analysis::GroundChecks& ground) {
  static const char* const kNames[] = {"x", "y", "z", "rx", "ry", "rz"};
  Table table{{"ground check", "g-set", "", "n-set", "", "f-set"}, {}};
  const auto judge = [](double value) { return std::abs(value) < 1e-9 ? "pass" : "FAIL"; };
  for (int i = 0; i < 6; ++i) {
    table.rows.push_back({kNames[i], fmt::format("{:.3e}", ground.g[i]), judge(ground.g[i]),
                          fmt::format("{:.3e}", ground.n[i]), judge(ground.n[i]),
                          fmt::format("{:.3e}{}", ground.f[i], std::abs(ground.f[i]) < 1e-9 ? "" : " held")});
  }
  return table.to_text();
}

std::string format_geometry(const fe::Model& model, const records::Deck& deck) {
  const auto list = [](const std::string& what, const std::vector<std::string>& names) {
    constexpr std::size_t kShown = 10;
    std::string text = what + ": " + (names.empty() ? "none" : std::to_string(names.size()));
    for (std::size_t i = 0; i < std::min(kShown, names.size()); ++i) text += (i ? ", " : " (") + names[i];
    return text + (names.empty() ? "\n" : names.size() > kShown ? ", ...)\n" : ")\n");
  };
  std::vector<std::string> pairs, unused;
  for (const auto& [a, b] : fe::find_coincident_grids(model, fe::choose_coincidence(model)))
    pairs.push_back(fmt::format("{} and {}", a, b));
  for (int id : fe::find_unused_grids(model, deck)) unused.push_back(std::to_string(id));
  const auto parts = fe::find_connected_parts(model);
  std::vector<std::string> sizes;
  for (const auto& part : parts) sizes.push_back(std::to_string(part.nodes.size()));
  std::string text = list("connected parts, by grids and scalar points", sizes) + list("coincident grids", pairs) +
                     list("grids not used", unused);
  const auto quality = fe::find_worst_quality(model);
  if (quality.empty()) return text;
  Table table{{"shape", "count", "worst aspect", "element", "worst warp", "element", "least Jacobian", "element"}, {}};
  for (const auto& q : quality)
    table.rows.push_back({q.card, std::to_string(q.count), fmt::format("{:.3g}", q.worst.aspect),
                          std::to_string(q.aspect_id), fmt::format("{:.3g} deg", q.worst.warp_deg),
                          std::to_string(q.warp_id), fmt::format("{:.3g}", q.worst.jacobian),
                          std::to_string(q.jacobian_id)});
  return text + "\n" + table.to_text();
}

nlohmann::json make_geometry_json(const fe::Model& model, const records::Deck& deck) {
  nlohmann::json json{{"coincident_grids", fe::find_coincident_grids(model, fe::choose_coincidence(model))},
                      {"unused_grids", fe::find_unused_grids(model, deck)},
                      {"parts", nlohmann::json::array()},
                      {"quality", nlohmann::json::object()}};
  for (const auto& part : fe::find_connected_parts(model))
    json["parts"].push_back({{"points", part.nodes.size()},
                             {"first", model.node(part.nodes.front()).id},
                             {"last", model.node(part.nodes.back()).id},
                             {"elements", part.num_elements},
                             {"held", part.is_held}});
  for (const auto& q : fe::find_worst_quality(model))
    json["quality"][q.card] = {{"count", q.count},
                               {"aspect", q.worst.aspect},
                               {"aspect_element", q.aspect_id},
                               {"warp_deg", q.worst.warp_deg},
                               {"warp_element", q.warp_id},
                               {"jacobian", q.worst.jacobian},
                               {"jacobian_element", q.jacobian_id}};
  return json;
}

namespace {

/// Section properties at one station of a PBARL or PBEAML.
struct SectionRow {
  std::string card, shape;
  int id = 0;
  double x_over_L = 0, nsm = 0;
  fe::LibrarySection section;
};

/// Sections with wrong dimensions are left out: the model reports them.
std::vector<SectionRow> list_sections(const records::Deck& deck) {
  std::vector<SectionRow> rows;
  const auto add = [&](SectionRow row, const std::vector<double>& dims) {
    std::string problem;
    const auto section = fe::calc_library_section(row.shape, dims, &problem);
    if (!section) return false;
    row.section = *section;
    rows.push_back(std::move(row));
    return true;
  };
  for (const auto& p : deck.pbarl) {
    if (!add({"PBARL", p.shape, p.id, 0, p.nsm, {}}, p.dims)) continue;
    auto& s = rows.back().section;
    s.n.setZero();                    // a CBAR's axis is the centroid
    if (s.I12 != 0) s.k1 = s.k2 = 0;  // as for a PBAR, I12 rules shear out
  }
  for (const auto& p : deck.pbeaml) {
    double k1 = 0, k2 = 0;
    for (std::size_t i = 0; i < p.stations.size(); ++i) {
      const auto& station = p.stations[i];
      if (!add({"PBEAML", p.shape, p.id, station.x_over_L, station.nsm, {}}, station.dims)) continue;
      auto& s = rows.back().section;
      if (i == 0) k1 = s.k1, k2 = s.k2;
      s.k1 = k1, s.k2 = k2;
    }
  }
  return rows;
}

}  // namespace

std::string format_sections(const records::Deck& deck) {
  constexpr std::size_t kShown = 20;
  const auto rows = list_sections(deck);
  if (rows.empty()) return {};
  Table table{{"section", "shape", "x/L", "A", "I1", "I2", "I12", "J", "K1", "K2", "NSM"}, {}};
  for (std::size_t i = 0; i < std::min(kShown, rows.size()); ++i) {
    const auto& r = rows[i];
    std::vector<std::string> cells{fmt::format("{} {}", r.card, r.id), r.shape, fmt::format("{:g}", r.x_over_L)};
    const auto& s = r.section;
    for (const double value : {s.A, s.I1, s.I2, s.I12, s.J, s.k1, s.k2, r.nsm})
      cells.push_back(fmt::format("{:.5g}", value + 0.0));
    table.rows.push_back(std::move(cells));
  }
  std::string text = "sections by dimensions (K 0: no shear flexibility)\n";
  text += table.to_text();
  if (rows.size() > kShown) text += fmt::format("... and {} more; --json lists all\n", rows.size() - kShown);
  return text + "\n";
}

nlohmann::json make_sections_json(const records::Deck& deck) {
  auto json = nlohmann::json::array();
  for (const auto& r : list_sections(deck)) {
    const auto& s = r.section;
    json.push_back({{"card", r.card},
                    {"id", r.id},
                    {"shape", r.shape},
                    {"x_over_L", r.x_over_L},
                    {"A", s.A},
                    {"I1", s.I1},
                    {"I2", s.I2},
                    {"I12", s.I12},
                    {"J", s.J},
                    {"K1", s.k1},
                    {"K2", s.k2},
                    {"N1", s.n[0]},
                    {"N2", s.n[1]},
                    {"NSM", r.nsm}});
  }
  return json;
}

std::string format_autospc(const fe::Model& model) {
  if (model.autospc().empty()) return "AUTOSPC: none\n";
  constexpr std::size_t kShown = 10;
  const auto& all = model.autospc();
  Table table{{"AUTOSPC grid", "component", "stiffness ratio", ""}, {}};
  for (std::size_t i = 0; i < std::min(kShown, all.size()); ++i)
    table.rows.push_back({std::to_string(all[i].node), std::to_string(all[i].component),
                          fmt::format("{:.2e}", all[i].ratio),
                          !all[i].is_skew        ? ""
                          : all[i].terms.empty() ? "the weakest of a singular block"
                                                 : "of an oblique direction, which is held"});
  return table.to_text() +
         (all.size() > kShown ? fmt::format("... and {} more\n", count(all.size() - kShown, "dof")) : "");
}

std::string format_card_counts(const records::Deck& deck) {
  std::map<std::string, std::string> remarks;
  for (const auto& card : deck.unused) {
    const auto at = deck.locate(card.first);
    remarks[card.name] = fmt::format("skipped, first at {}:{}", at.file, at.line);
  }
  Table table{{"card", "count", ""}, {}};
  for (const auto& [name, count] : deck.card_counts) table.rows.push_back({name, std::to_string(count), remarks[name]});
  return table.to_text();
}

nlohmann::json to_json_list(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  return std::vector<double>(vector.data(), vector.data() + vector.size());
}

nlohmann::json to_json(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  auto rows = nlohmann::json::array();
  for (int i = 0; i < matrix.rows(); ++i) rows.push_back(to_json_list(matrix.row(i).transpose().eval()));
  return rows;
}

nlohmann::json to_json(const analysis::SubcaseFailures& failures) {
  auto list = nlohmann::json::array();
  for (const auto& [id, items] : failures.get_failed()) {
    auto messages = nlohmann::json::array();
    for (const auto& item : items) messages.push_back(format(item));
    list.push_back({{"id", id}, {"messages", messages}});
  }
  return list;
}

nlohmann::json to_json(const fe::GridPointWeight& w) {
  return {{"grid", w.grid},
          {"MO", to_json(Eigen::MatrixXd(w.MO))},
          {"S", to_json(Eigen::MatrixXd(w.S))},
          {"mass", to_json_list(w.mass)},
          {"cg", to_json(Eigen::MatrixXd(w.cg))},
          {"I_S", to_json(Eigen::MatrixXd(w.I_S))},
          {"I_Q", to_json_list(w.I_Q)},
          {"Q", to_json(Eigen::MatrixXd(w.Q))}};
}

nlohmann::json to_json(const records::MassProperties& p) {
  nlohmann::json json{{"reference", to_json_list(p.reference)},
                      {"mass", p.mass},
                      {"cg", to_json_list(p.cg)},
                      {"inertia", to_json(Eigen::MatrixXd(p.inertia))},
                      {"inertia_cg", to_json(Eigen::MatrixXd(analysis::calc_central_inertia(p)))},
                      {"rigid_mass", to_json(Eigen::MatrixXd(p.rigid_mass))}};
  if (fe::calc_mass_difference(p.rigid_mass) > fe::kMassDifference) {  // no one mass, no centre
    const auto w = fe::calc_grid_point_weight(p.rigid_mass);
    json["by_direction"] = {{"axes", to_json(Eigen::MatrixXd(w.S))},
                            {"mass", to_json_list(w.mass)},
                            {"cg", to_json(Eigen::MatrixXd(w.cg))}};
  }
  return json;
}

}  // namespace bough::cli
