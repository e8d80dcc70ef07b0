#include <algorithm>

#include "base/number_text.hpp"
#include "fe/cards/maker.hpp"
#include "fe/elements/shear_panel.hpp"

namespace bough::fe {

void make_shear_panels(Maker& maker) {
  const auto& deck = maker.deck();
  const RecordIndex<records::Pshear> pshear(deck.pshear);
  for (const auto& card : deck.shear_panels) {
    const std::string who = "CSHEAR " + std::to_string(card.id);
    std::vector<int> nodes;
    for (int g : card.grids) nodes.push_back(maker.find_grid(g, who, card.at));
    const auto* property = pshear.find(card.pid);
    if (!property) {
      maker.report_missing_property(card.pid, "PSHEAR", who, card.at);
      continue;
    }
    const std::string name = "PSHEAR " + std::to_string(property->id);
    const auto* material = maker.find_material(property->mid, name, property->at);
    if (!material || std::any_of(nodes.begin(), nodes.end(), [](int n) { return n < 0; })) continue;
    if (!(property->t > 0 && material->G > 0 && property->f1 >= 0 && property->f2 >= 0)) {
      maker.error("fe.bad-property", property->at,
                  name + " has T = " + show_number(property->t) + ", G = " + show_number(material->G) +
                      ", F1 = " + show_number(property->f1) + ", F2 = " + show_number(property->f2) +
                      ", expected T > 0, G > 0, F1 >= 0 and F2 >= 0",
                  "correct the property or its material");
      continue;
    }
    std::array<Vector3d, 4> x;
    std::vector<int> gdofs;
    for (std::size_t i = 0; i < 4; ++i) {
      const Node& node = maker.nodes().node(nodes[i]);
      x[i] = node.x;
      for (int c = 0; c < 3; ++c) gdofs.push_back(node.first_gdof + c);
    }
    const double area = ShearPanel::calc_area(x), span = (x[2] - x[0]).squaredNorm();
    if (!(area > 1e-10 * span) || !(ShearPanel::calc_weights(x).minCoeff() > 0)) {
      maker.error("fe.bad-facet", card.at,
                  who + (area > 1e-10 * span ? " has an interior angle of 180 degrees or more" : " has no area"),
                  "correct the corners or their order");
      continue;
    }
    ShearPanelProperty p{material->G, material->nu, material->E, property->t, 0, {}};
    p.mass = material->rho * property->t + property->nsm;
    const auto length = [&](std::size_t i) { return (x[(i + 1) % 4] - x[i]).norm(); };
    for (std::size_t i = 0; i < 4; ++i) {
      const double f = i % 2 == 0 ? property->f1 : property->f2;
      // Quick Reference Guide, PSHEAR: up to 1.01 a fraction of the panel's width, above a multiple of its thickness.
      p.rod_area[i] = f > 1.01 ? 0.5 * f * p.t * p.t : f * p.t * area / (length(i) + length((i + 2) % 4));
    }
    maker.add(std::make_unique<ShearPanel>(card.id, std::move(nodes), std::move(gdofs), x, p), material->ge);
  }
}

}  // namespace bough::fe
