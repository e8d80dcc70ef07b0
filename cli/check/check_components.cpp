#include "cli/check/check_components.hpp"

#include <fmt/format.h>

#include "cli/common/console.hpp"
#include "cli/common/deck_tables.hpp"
#include "fe/statics/superelement_check.hpp"

namespace bough::cli {
namespace {

constexpr Eigen::Index kMaxShown = 12;

std::string list_frequencies(const Eigen::VectorXd& hz) {
  std::string text;
  for (Eigen::Index i = 0; i < std::min(hz.size(), kMaxShown); ++i)
    text += fmt::format("{}{:.6g}", i > 0 ? ", " : "", hz[i]);
  return hz.size() > kMaxShown ? text + fmt::format(", ... {:.6g}", hz[hz.size() - 1]) : text;
}

}  // namespace

void check_components(const records::Deck& deck, std::string& text, nlohmann::json& json, Diagnostics& diagnostics) {
  if (deck.superelements.empty()) return;
  json["superelements"] = nlohmann::json::array();
  for (const auto& superelement : deck.superelements) {
    const auto check = fe::check_superelement(deck, superelement, diagnostics);
    text += fmt::format("superelement {}: {}, {}{}\n", check.id,
                        count(static_cast<std::size_t>(check.num_grids), "boundary grid"),
                        count(static_cast<std::size_t>(check.num_points), "generalized coordinate"),
                        check.file.empty() ? "" : ", matrices of " + check.file);
    text += fmt::format("  rigid-body motion: strain energy {:.1e} of the diagonal's, force {:.2e}, moment {:.2e}\n",
                        check.rigid_energy.maxCoeff(), check.rigid_force, check.rigid_moment);
    text += fmt::format("  mass {:.7g}, centre of mass ({:.6g}, {:.6g}, {:.6g})\n", check.mass.mass, check.mass.cg.x(),
                        check.mass.cg.y(), check.mass.cg.z());
    text += fmt::format("  coupling K_bq {:.1e}\n", check.coupling);
    if (check.held_hz.size() > 0) text += fmt::format("  boundary held, Hz: {}\n", list_frequencies(check.held_hz));
    nlohmann::json one{{"id", check.id},
                       {"num_grids", check.num_grids},
                       {"num_points", check.num_points},
                       {"rigid_force", check.rigid_force},
                       {"rigid_moment", check.rigid_moment},
                       {"coupling", check.coupling},
                       {"mass_properties", to_json(check.mass)}};
    one["rigid_energy"] = std::vector<double>(check.rigid_energy.begin(), check.rigid_energy.end());
    one["held_hz"] = std::vector<double>(check.held_hz.begin(), check.held_hz.end());
    std::vector<std::string> tables;
    for (const auto& table : superelement.recovery) {
      tables.push_back(table.name);
      text += fmt::format("  {}: {} rows of {} items\n", table.name, table.rows.rows(), table.items.size());
    }
    one["recovery"] = tables;
    json["superelements"].push_back(std::move(one));
  }
  text += "\n";
}

}  // namespace bough::cli
