#include "fe/sections/laminate.hpp"

#include <cmath>

namespace bough::fe {

PlaneMaterial make_isotropic_plane(double E, double G, double nu, double rho) {
  PlaneMaterial m;
  const double c = E / (1 - nu * nu);
  m.Q << c, nu * c, 0, nu * c, c, 0, 0, 0, G;
  m.G = G * Eigen::Matrix2d::Identity();
  m.rho = rho;
  return m;
}

PlaneMaterial make_orthotropic_plane(double E1, double E2, double nu12, double G12, double G1z, double G2z,
                                     double rho) {
  PlaneMaterial m;
  const double c = 1 - nu12 * nu12 * E2 / E1;
  m.Q << E1 / c, nu12 * E2 / c, 0, nu12 * E2 / c, E2 / c, 0, 0, 0, G12;
  m.G = Eigen::Vector2d(G1z, G2z).asDiagonal();
  m.shear_rigid = !(G1z > 0 && G2z > 0);
  m.rho = rho;
  return m;
}

PlaneMaterial rotate_material(const PlaneMaterial& material, double angle) {
  ShellSection s;
  s.A = material.Q;
  s.S = material.G;
  const ShellSection turned = rotate_section(s, angle);
  PlaneMaterial m = material;
  m.Q = turned.A;
  m.G = turned.S;
  m.alpha = rotate_strain(material.alpha, angle);
  return m;
}

Eigen::Vector3d rotate_strain(const Eigen::Vector3d& strain, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix3d t;
  t << c * c, s * s, -c * s, s * s, c * c, c * s, 2 * c * s, -2 * c * s, c * c - s * s;
  return t * strain;
}

namespace {

/// Position of the neutral axis of bending in one direction, from the bottom of the laminate.
double find_neutral(const std::vector<LaminateLayer>& layers, int direction) {
  double EA = 0, ES = 0, z = 0;
  for (const auto& l : layers) {
    const double E = l.material.Q(direction, direction);
    EA += E * l.thickness;
    ES += E * l.thickness * (z + 0.5 * l.thickness);
    z += l.thickness;
  }
  return ES / EA;
}

/// Shear stiffness of the stack in one direction by the energy of the equilibrium shear flow.
double calc_shear_stiffness(const std::vector<LaminateLayer>& layers, int direction) {
  double EI = 0, energy = 0, F = 0, bottom = -find_neutral(layers, direction);
  for (const auto& l : layers) {
    const double E = l.material.Q(direction, direction), t = l.thickness, top = bottom + t;
    EI += E * (std::pow(top, 3) - std::pow(bottom, 3)) / 3;
    if (!l.material.shear_rigid) {
      // F is quadratic in the layer, F² quartic: three Gauss points are exact.
      const double a = std::sqrt(0.6), x[3] = {-a, 0, a}, w[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
      for (int q = 0; q < 3; ++q) {
        const double at = bottom + 0.5 * t * (1 + x[q]);
        const double flow = F + 0.5 * E * (at * at - bottom * bottom);
        energy += w[q] * t * flow * flow / l.material.G(direction, direction);
      }
    }
    F += 0.5 * E * (top * top - bottom * bottom);
    bottom = top;
  }
  return energy > 0 ? EI * EI / energy : 0;
}

}  // namespace

ShellSection make_laminate_section(const std::vector<LaminateLayer>& layers, double z0) {
  ShellSection s;
  double z = z0, first_moment = 0;
  for (const auto& l : layers) {
    const double top = z + l.thickness;
    s.A += l.material.Q * l.thickness;
    s.B += l.material.Q * (top * top - z * z) / 2;
    s.D += l.material.Q * (top * top * top - z * z * z) / 3;
    s.mass += l.material.rho * l.thickness;
    first_moment += l.material.rho * (top * top - z * z) / 2;
    s.rotary_inertia += l.material.rho * (top * top * top - z * z * z) / 3;
    z = top;
  }
  if (s.B.norm() < 1e-12 * std::sqrt(s.A.norm() * s.D.norm())) s.B.setZero();  // a symmetric stack
  if (s.mass > 0) s.mass_offset = first_moment / s.mass;
  if (std::abs(s.mass_offset) < 1e-12 * (z - z0)) s.mass_offset = 0;
  s.rotary_inertia -= s.mass * s.mass_offset * s.mass_offset;
  const double Sx = calc_shear_stiffness(layers, 0), Sy = calc_shear_stiffness(layers, 1);
  s.shear_flexible = Sx > 0 && Sy > 0;
  if (s.shear_flexible) s.S = Eigen::Vector2d(Sx, Sy).asDiagonal();
  return s;
}

std::vector<Eigen::Vector2d> calc_interlaminar_shear(const std::vector<LaminateLayer>& layers) {
  std::vector<Eigen::Vector2d> shear(layers.size(), Eigen::Vector2d::Zero());
  for (int direction = 0; direction < 2; ++direction) {
    double EI = 0, F = 0, bottom = -find_neutral(layers, direction);
    for (std::size_t k = 0; k < layers.size(); ++k) {
      const double E = layers[k].material.Q(direction, direction), top = bottom + layers[k].thickness;
      EI += E * (std::pow(top, 3) - std::pow(bottom, 3)) / 3;
      F += 0.5 * E * (top * top - bottom * bottom);
      shear[k][direction] = -F;
      bottom = top;
    }
    for (auto& of_layer : shear) of_layer[direction] /= EI;
  }
  shear.back().setZero();  // F is round-off there
  return shear;
}

LaminateLayer smear(const std::vector<LaminateLayer>& layers) {
  LaminateLayer result;
  auto& m = result.material;
  Eigen::Vector3d stress = Eigen::Vector3d::Zero();
  for (const auto& l : layers) {
    result.thickness += l.thickness;
    m.Q += l.thickness * l.material.Q;
    m.G += l.thickness * l.material.G;
    m.rho += l.thickness * l.material.rho;
    stress += l.thickness * (l.material.Q * l.material.alpha);
    m.shear_rigid = m.shear_rigid || l.material.shear_rigid;
  }
  if (!stress.isZero(0)) m.alpha = m.Q.ldlt().solve(stress);
  m.Q /= result.thickness;
  m.G /= result.thickness;
  m.rho /= result.thickness;
  return result;
}

ShellExpansion make_laminate_expansion(const std::vector<LaminateLayer>& layers, double z0) {
  ShellExpansion e;
  double z = z0;
  for (const auto& l : layers) {
    const double top = z + l.thickness;
    const double first = (top * top - z * z) / 2, second = (top * top * top - z * z * z) / 3;
    const Eigen::Vector3d stress = l.material.Q * l.material.alpha;
    const double energy = stress.dot(l.material.alpha);
    e.N_t += l.thickness * stress;
    e.M_t += first * stress;
    e.M_g += second * stress;
    e.e_tt += l.thickness * energy;
    e.e_tg += first * energy;
    e.e_gg += second * energy;
    z = top;
  }
  if (e.M_t.norm() < 1e-12 * (z - z0) * e.N_t.norm()) e.M_t.setZero();  // a symmetric stack
  e.N_g = e.M_t;
  return e;
}

}  // namespace bough::fe
