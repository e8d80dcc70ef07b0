#include "fe/sections/beam_property.hpp"

#include "base/diagnostic.hpp"
#include "base/rotation.hpp"

namespace bough::fe {

BeamSection BeamProperty::calc_section(double x_over_L) const {
  BOUGH_DEMAND(!stations.empty());
  if (stations.size() == 1) return stations.front();
  std::size_t k = 1;
  while (k + 1 < stations.size() && stations[k].x_over_L < x_over_L) ++k;
  const BeamSection& a = stations[k - 1];
  const BeamSection& b = stations[k];
  const double t = (x_over_L - a.x_over_L) / (b.x_over_L - a.x_over_L);
  const auto mix = [t](const auto& p, const auto& q) { return (p + t * (q - p)); };
  BeamSection s;
  s.x_over_L = x_over_L;
  s.A = mix(a.A, b.A);
  s.I1 = mix(a.I1, b.I1);
  s.I2 = mix(a.I2, b.I2);
  s.I12 = mix(a.I12, b.I12);
  s.J = mix(a.J, b.J);
  s.nsm = mix(a.nsm, b.nsm);
  s.nsi = mix(a.nsi, b.nsi);
  s.n = a.n + t * (b.n - a.n);
  s.m = a.m + t * (b.m - a.m);
  return s;
}

Eigen::Matrix<double, 6, 6> calc_section_mass(const BeamProperty& property, const BeamSection& s, bool bending) {
  const double rho_A = property.material.rho * s.A;
  const double mu = rho_A + s.nsm;
  Eigen::Matrix<double, 6, 6> m = Eigen::Matrix<double, 6, 6>::Zero();
  m.topLeftCorner<3, 3>() = mu * Eigen::Matrix3d::Identity();
  if (property.has_torsional_inertia) m(3, 3) = property.material.rho * (s.I1 + s.I2);
  if (!property.has_section_inertia) return m;
  const Eigen::Vector2d first = rho_A * s.n + s.nsm * s.m;
  const Eigen::Vector3d p(0, first[0], first[1]);
  m.topRightCorner<3, 3>() = -skew(p);
  m.bottomLeftCorner<3, 3>() = skew(p);
  const double rho = property.material.rho;
  double yy = rho_A * s.n[0] * s.n[0] + s.nsm * s.m[0] * s.m[0];
  double zz = rho_A * s.n[1] * s.n[1] + s.nsm * s.m[1] * s.m[1];
  double yz = rho_A * s.n[0] * s.n[1] + s.nsm * s.m[0] * s.m[1];
  m(3, 3) = yy + zz + rho * (s.I1 + s.I2) + s.nsi;
  if (bending) {
    yy += rho * s.I1;
    zz += rho * s.I2;
    yz += rho * s.I12;
  }
  m(4, 4) = zz;
  m(5, 5) = yy;
  m(4, 5) = m(5, 4) = -yz;
  return m;
}

}  // namespace bough::fe
