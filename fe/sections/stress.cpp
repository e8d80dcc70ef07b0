#include "fe/sections/stress.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "base/diagnostic.hpp"

namespace bough::fe {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector6d = Eigen::Matrix<double, 6, 1>;

std::string add_point(const std::string& component, const StressPoint& point) {
  return point.name.empty() ? component : component + "@" + point.name;
}

bool has_bond_index(const StressPoint& point) { return point.theory != FailureTheory::None && point.bond > 0; }

/// Names of the results that are derived from the components of a point.
std::vector<std::string> list_derived(const StressPoint& point, bool of_strain) {
  if (of_strain && (point.kind == StressKind::Rod || point.kind == StressKind::Ply)) return {};
  switch (point.kind) {
    case StressKind::Plane:
    case StressKind::Solid:
      return {"von_mises", "major", "minor"};
    case StressKind::Rod:
      return {"von_mises"};
    case StressKind::Ply:
      if (point.theory != FailureTheory::None) return {"failure"};
      return {};
    case StressKind::Bond:
      if (has_bond_index(point)) return {"failure"};
      return {};
    default:
      return {};
  }
}

Eigen::Index count_derived(const StressPoint& point, bool of_strain) {
  switch (point.kind) {
    case StressKind::Plane:
    case StressKind::Solid:
      return 3;
    case StressKind::Rod:
      return of_strain ? 0 : 1;
    case StressKind::Ply:
      return of_strain || point.theory == FailureTheory::None ? 0 : 1;
    case StressKind::Bond:
      return has_bond_index(point) ? 1 : 0;
    default:
      return 0;
  }
}

void calc_derived(const StressPoint& point, const Eigen::Ref<const VectorXd>& given, bool of_strain, double* out) {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> s = given;  // no separate memory: it is called often
  if (of_strain) s = halve_shears(point.kind, given);
  if (point.kind == StressKind::Plane) {
    const double mean = 0.5 * (s[0] + s[1]), radius = std::hypot(0.5 * (s[0] - s[1]), s[2]);
    out[0] = of_strain ? calc_plane_von_mises_strain(given) : calc_plane_von_mises(s);
    out[1] = mean + radius;
    out[2] = mean - radius;
  } else if (point.kind == StressKind::Solid) {
    Eigen::Matrix3d sigma;
    sigma << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    const Vector3d principal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sigma, Eigen::EigenvaluesOnly).eigenvalues();
    out[0] = of_strain ? calc_solid_von_mises_strain(given) : calc_solid_von_mises(s);
    out[1] = principal[2];
    out[2] = principal[0];
  } else if (point.kind == StressKind::Rod && !of_strain) {
    out[0] = std::sqrt(s[0] * s[0] + 3 * s[1] * s[1]);
  } else if (point.kind == StressKind::Ply && !of_strain && point.theory != FailureTheory::None) {
    out[0] = calc_failure_index(point, s);
  } else if (point.kind == StressKind::Bond && has_bond_index(point)) {
    out[0] = std::max(std::abs(s[0]), std::abs(s[1])) / point.bond;
  }
}

/// Over several points: axial stress its extremes, the others the largest of what a point derives first.
std::vector<std::string> list_extremes(const std::vector<StressPoint>& points, bool of_strain) {
  if (points.size() < 2) return {};
  const auto& first = points.front();
  if (first.kind == StressKind::Axial) return {"max", "min"};
  const auto derived = list_derived(first, of_strain);
  return derived.empty() ? std::vector<std::string>{} : std::vector<std::string>{derived.front()};
}

std::vector<std::string> list_names(const std::vector<StressPoint>& points, bool of_strain) {
  std::vector<std::string> names;
  for (const auto& point : points) {
    for (const auto& component : list_components(point.kind)) names.push_back(add_point(component, point));
    for (const auto& derived : list_derived(point, of_strain)) names.push_back(add_point(derived, point));
  }
  for (const auto& extreme : list_extremes(points, of_strain)) names.push_back(extreme);
  return names;
}

VectorXd calc_results(const std::vector<StressPoint>& points, const Eigen::Ref<const VectorXd>& given, bool of_strain) {
  const PointResults results(points, of_strain);
  VectorXd out(results.size());
  results.calc(given, out);
  return out;
}

}  // namespace

const std::vector<std::string>& list_components(StressKind kind) {
  static const std::vector<std::string> axial{"xx"}, rod{"xx", "torsion"}, shear{"xy"}, plane{"xx", "yy", "xy"},
      ply{"11", "22", "12"}, bond{"xz", "yz"}, solid{"xx", "yy", "zz", "xy", "yz", "zx"},
      mid{"xx", "yy", "xy", "kappa_xx", "kappa_yy", "kappa_xy"};
  switch (kind) {
    case StressKind::Axial:
      return axial;
    case StressKind::Rod:
      return rod;
    case StressKind::Shear:
      return shear;
    case StressKind::Plane:
      return plane;
    case StressKind::Ply:
      return ply;
    case StressKind::Bond:
      return bond;
    case StressKind::Mid:
      return mid;
    default:
      return solid;
  }
}

std::vector<std::string> list_stress_names(const std::vector<StressPoint>& points) {
  std::vector<std::string> names;
  for (const auto& point : points)
    for (const auto& component : list_components(point.kind)) names.push_back(add_point("stress_" + component, point));
  return names;
}

std::vector<std::string> list_result_names(const std::vector<StressPoint>& points) { return list_names(points, false); }

VectorXd calc_stress_results(const std::vector<StressPoint>& points, const Eigen::Ref<const VectorXd>& stress) {
  return calc_results(points, stress, false);
}

std::vector<std::string> list_strain_result_names(const std::vector<StressPoint>& points) {
  return list_names(points, true);
}

VectorXd calc_strain_results(const std::vector<StressPoint>& points, const Eigen::Ref<const VectorXd>& strain) {
  return calc_results(points, strain, true);
}

PointResults::PointResults(std::vector<StressPoint> points, bool of_strain)
    : points_(std::move(points)), of_strain_(of_strain) {
  for (const auto& point : points_) {
    num_components_.push_back(static_cast<Eigen::Index>(list_components(point.kind).size()));
    num_derived_.push_back(count_derived(point, of_strain));
    size_ += num_components_.back() + num_derived_.back();
  }
  num_extremes_ = static_cast<Eigen::Index>(list_extremes(points_, of_strain).size());
  size_ += num_extremes_;
}

void PointResults::calc(const Eigen::Ref<const VectorXd>& given, Eigen::Ref<VectorXd> out) const {
  BOUGH_DEMAND(out.size() == size_);
  Eigen::Index from = 0, to = 0;
  double max_stress = -HUGE_VAL, min_stress = HUGE_VAL;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const auto n = num_components_[p], d = num_derived_[p];
    out.segment(to, n) = given.segment(from, n);
    calc_derived(points_[p], given.segment(from, n), of_strain_, out.data() + to + n);
    const bool is_beside = points_[p].kind == StressKind::Mid || (points_[p].kind == StressKind::Bond && d == 0);
    if (!is_beside) {
      const double value = d > 0 ? out[to + n] : given[from];
      max_stress = std::max(max_stress, value);
      min_stress = std::min(min_stress, value);
    }
    from += n;
    to += n + d;
  }
  BOUGH_DEMAND(from == given.size());
  if (num_extremes_ > 0) out[to] = max_stress;
  if (num_extremes_ > 1) out[to + 1] = min_stress;
}

double calc_plane_von_mises_strain(const Vector3d& e) {
  return std::sqrt(std::max(0.0, 4.0 / 9 * (e[0] * e[0] - e[0] * e[1] + e[1] * e[1]) + e[2] * e[2] / 3));
}

double calc_solid_von_mises_strain(const Vector6d& e) {
  const double a = e[0] - e[1], b = e[1] - e[2], c = e[2] - e[0];
  return std::sqrt(2.0 / 9 * (a * a + b * b + c * c) + e.tail<3>().squaredNorm() / 3);
}

VectorXd halve_shears(StressKind kind, VectorXd strain) {
  if (kind == StressKind::Plane || kind == StressKind::Ply) strain[2] *= 0.5;
  if (kind == StressKind::Solid) strain.tail<3>() *= 0.5;
  return strain;
}

double calc_plane_von_mises(const Vector3d& s) {
  return std::sqrt(std::max(0.0, s[0] * s[0] - s[0] * s[1] + s[1] * s[1] + 3 * s[2] * s[2]));
}

double calc_solid_von_mises(const Vector6d& s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt(0.5 * (a * a + b * b + c * c) + 3 * s.tail<3>().squaredNorm());
}

double calc_failure_index(const StressPoint& ply, const Vector3d& s) {
  const auto& p = ply.strength;
  if (ply.theory == FailureTheory::None || !(p.Xt > 0 && p.Yt > 0 && p.S > 0)) return 0;
  const double Xc = p.Xc > 0 ? p.Xc : p.Xt, Yc = p.Yc > 0 ? p.Yc : p.Yt;
  if (ply.theory == FailureTheory::Strain) {
    // Limits of stress become those of strain by the moduli, as for a single stress.
    const Vector3d e = ply.compliance * s;
    const Vector3d unit = p.is_strain ? Vector3d::Ones() : Vector3d(ply.compliance.diagonal());
    return std::max({std::abs(e[0]) / (unit[0] * (e[0] >= 0 ? p.Xt : Xc)),
                     std::abs(e[1]) / (unit[1] * (e[1] >= 0 ? p.Yt : Yc)), std::abs(e[2]) / (unit[2] * p.S)});
  }
  const double shear = s[2] * s[2] / (p.S * p.S);
  if (ply.theory == FailureTheory::Hill) {
    const double X = s[0] >= 0 ? p.Xt : Xc, Y = s[1] >= 0 ? p.Yt : Yc;
    const double X12 = s[0] * s[1] >= 0 ? p.Xt : Xc;
    return s[0] * s[0] / (X * X) - s[0] * s[1] / (X12 * X12) + s[1] * s[1] / (Y * Y) + shear;
  }
  const double linear = (1 / p.Xt - 1 / Xc) * s[0] + (1 / p.Yt - 1 / Yc) * s[1];
  const double squares = s[0] * s[0] / (p.Xt * Xc) + s[1] * s[1] / (p.Yt * Yc) + shear;
  const double cross = ply.theory == FailureTheory::Hoffman ? -s[0] * s[1] / (p.Xt * Xc) : 2 * p.F12 * s[0] * s[1];
  return linear + squares + cross;
}

}  // namespace bough::fe
