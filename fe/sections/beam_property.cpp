#include "fe/sections/beam_property.hpp"

#include "base/diagnostic.hpp"

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

}  // namespace bough::fe
