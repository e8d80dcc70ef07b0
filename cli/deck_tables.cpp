#include "deck_tables.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "bough/base/rotation.hpp"
#include "console.hpp"

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

/// Inertia about the centre of mass: I_ref - m (|c|² 1 - c cᵀ), c from the reference.
Matrix3d calc_central_inertia(const records::MassProperties& p) {
  const Vector3d c = p.cg - p.reference;
  return p.inertia - p.mass * (c.squaredNorm() * Matrix3d::Identity() - c * c.transpose());
}
}  // namespace

std::string format_mass_properties(const records::MassProperties& p) {
  const Matrix3d central = calc_central_inertia(p);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(central);
  std::string text = fmt::format("mass properties about ({:g}, {:g}, {:g}), basic axes\n", p.reference.x(),
                                 p.reference.y(), p.reference.z());
  text += "  rigid mass matrix (x y z, rotations x y z)\n" + format_rows(p.rigid_mass);
  text += fmt::format("  mass {:.8g}\n  centre of mass {:.8g} {:.8g} {:.8g}\n", p.mass, p.cg.x() + 0.0, p.cg.y() + 0.0,
                      p.cg.z() + 0.0);
  text += "  inertia about the reference\n" + format_rows(p.inertia);
  text += "  inertia about the centre of mass\n" + format_rows(central);
  text += "  principal inertias\n" + format_rows(principal.eigenvalues().transpose());
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

std::string format_ground_check(const GroundChecks& ground) {
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
  std::string text = list("coincident grids", pairs) + list("grids not used", unused);
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
                      {"quality", nlohmann::json::object()}};
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

std::string format_autospc(const fe::Model& model) {
  if (model.autospc().empty()) return "AUTOSPC: none\n";
  constexpr std::size_t kShown = 10;
  const auto& all = model.autospc();
  Table table{{"AUTOSPC grid", "component", "stiffness ratio"}, {}};
  for (std::size_t i = 0; i < std::min(kShown, all.size()); ++i)
    table.rows.push_back(
        {std::to_string(all[i].node), std::to_string(all[i].component), fmt::format("{:.2e}", all[i].ratio)});
  return table.to_text() +
         (all.size() > kShown ? fmt::format("... and {} more\n", count(all.size() - kShown, "dof")) : "");
}

std::string format_card_counts(const records::Deck& deck) {
  Table table{{"card", "count", ""}, {}};
  for (const auto& [name, count] : deck.card_counts) {
    std::string remark;
    for (const auto& card : deck.unused) {
      if (card.name != name) continue;
      const auto at = deck.locate(card.first);
      remark = fmt::format("skipped, first at {}:{}", at.file, at.line);
    }
    table.rows.push_back({name, std::to_string(count), remark});
  }
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
  return {{"reference", to_json_list(p.reference)},
          {"mass", p.mass},
          {"cg", to_json_list(p.cg)},
          {"inertia", to_json(Eigen::MatrixXd(p.inertia))},
          {"inertia_cg", to_json(Eigen::MatrixXd(calc_central_inertia(p)))},
          {"rigid_mass", to_json(Eigen::MatrixXd(p.rigid_mass))}};
}

}  // namespace bough::cli
