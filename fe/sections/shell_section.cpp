#include "fe/sections/shell_section.hpp"

#include <cmath>

#include "fe/sections/shell_stress.hpp"

namespace bough::fe {

ShellSection rotate_section(const ShellSection& section, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  // Strains in material axes from strains in element axes; the stiffness transforms as TᵀCT (Jones, eq. 2.81).
  Eigen::Matrix3d t;
  t << c * c, s * s, c * s, s * s, c * c, -c * s, -2 * c * s, 2 * c * s, c * c - s * s;
  Eigen::Matrix2d r;
  r << c, s, -s, c;
  ShellSection turned = section;
  turned.A = t.transpose() * section.A * t;
  turned.B = t.transpose() * section.B * t;
  turned.D = t.transpose() * section.D * t;
  turned.S = r.transpose() * section.S * r;
  if (section.expansion) {
    auto e = std::make_shared<ShellExpansion>(*section.expansion);
    for (auto* v : {&e->N_t, &e->M_t, &e->N_g, &e->M_g}) *v = (t.transpose() * *v).eval();
    turned.expansion = std::move(e);
  }
  if (section.stress && !section.stress->layers.empty()) {
    auto turned_stress = std::make_shared<ShellStress>(*section.stress);
    for (auto& layer : turned_stress->layers) {
      layer.angle += angle;
      layer.shear = (layer.shear * r).eval();
    }
    turned.stress = std::move(turned_stress);
  }
  return turned;
}

}  // namespace bough::fe
