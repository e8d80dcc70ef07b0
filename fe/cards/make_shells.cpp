#include "fe/cards/maker.hpp"
#include "fe/cards/shell_card.hpp"
#include "fe/elements/shell.hpp"

namespace bough::fe {

void make_shells(Maker& maker) {
  ShellSections sections(maker);
  std::vector<ResolvedShell> shells;
  for (const auto& card : maker.deck().shells) {
    if (!card.midsides.empty()) continue;  // curved
    if (auto shell = resolve_shell(maker, sections, card)) shells.push_back(std::move(*shell));
  }
  const auto surface = calc_surface_normals(maker, shells);
  for (const auto& shell : shells) {
    const auto angle = calc_material_angle(maker, shell);
    if (!angle) continue;
    ShellGeometry geometry{shell.x, shell.card->z_offset, {}};
    for (int n : shell.nodes) {
      const auto it = surface.find(n);
      const Vector3d normal = it == surface.end() ? shell.normal : it->second;
      geometry.normals.push_back(normal.dot(shell.normal) < 0 ? Vector3d(-normal) : normal);
    }
    const bool drilling = shell.card->card == "CQUADR" || shell.card->card == "CTRIAR";
    const auto kind = drilling ? shell::MembraneKind::Drilling : shell::MembraneKind::Plain;
    maker.add(std::make_unique<Shell>(shell.card->id, shell.card->card, shell.nodes, maker.list_gdofs(shell.nodes),
                                      geometry, rotate_section(*shell.section, *angle), kind),
              shell.section->ge);
  }
}

}  // namespace bough::fe
