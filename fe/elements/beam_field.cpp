#include "fe/elements/beam_field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fe/shape/gauss.hpp"

namespace bough::fe {
namespace {

enum { kN, kVy, kVz, kT, kMy, kMz };

/// Section forces at ξ for forces at the end l = ξ + arm: columns as the rows, equilibrium of a straight beam.
Matrix6d calc_equilibrium(double arm) {
  Matrix6d b = Matrix6d::Identity();
  b(kMy, kVz) = -arm;
  b(kMz, kVy) = arm;
  return b;
}

ActiveForces find_active(const BeamProperty& p) {
  const auto all = [&](auto value) { return std::all_of(p.stations.begin(), p.stations.end(), value); };
  ActiveForces active;
  active.axial = all([](const BeamSection& s) { return s.A > 0; });
  active.torsion = p.material.G > 0 && all([](const BeamSection& s) { return s.J > 0; });
  active.plane1 = all([](const BeamSection& s) { return s.I1 > 0; });
  active.plane2 = all([](const BeamSection& s) { return s.I2 > 0; });
  return active;
}

/// Ends of quadrature panels: short enough that 8 Gauss points integrate 1 / (linear stiffness) to rounding.
std::vector<double> calc_breaks(const BeamProperty& p, double length) {
  std::vector<double> breaks{0};
  for (std::size_t k = 1; k < p.stations.size(); ++k) {
    const BeamSection &a = p.stations[k - 1], &b = p.stations[k];
    double ratio = 1;
    for (const auto& [u, v] : {std::pair{a.A, b.A}, {a.I1, b.I1}, {a.I2, b.I2}, {a.J, b.J}})
      if (u > 0 && v > 0) ratio = std::max({ratio, u / v, v / u});
    const int num_panels = std::clamp(static_cast<int>(std::ceil((ratio - 1) / 0.5)), 1, 16);
    for (int i = 1; i <= num_panels; ++i)
      breaks.push_back(length * (a.x_over_L + (b.x_over_L - a.x_over_L) * i / num_panels));
  }
  return breaks;
}

}  // namespace

BeamField::BeamField(const BeamProperty& property, double length)
    : property_(property), length_(length), uniform_(property.is_uniform()), active_(find_active(property)) {
  if (!uniform_) breaks_ = calc_breaks(property, length);
  const Matrix6d f = calc_flexibility(length);
  // Scaled to lengths of order one before inversion, so that thin and thick beams are inverted alike.
  Eigen::Matrix<double, 6, 1> d;
  for (int i = 0; i < 6; ++i) d[i] = 1 / std::sqrt(f(i, i));
  const Matrix6d scaled = d.asDiagonal() * f * d.asDiagonal();
  G_ = d.asDiagonal() * scaled.llt().solve(Matrix6d::Identity()) * d.asDiagonal();
  G_ = (0.5 * (G_ + G_.transpose())).eval();
  GS_ = G_ * calc_relative();
}

void BeamField::keep_shapes() {
  if (!uniform_ || !kept_.empty()) return;
  std::vector<std::pair<double, Shape>> kept;
  for (const int n : {3, 4})
    for (const auto& point : calc_points(n, 7)) {
      kept.emplace_back(point.x, Shape{});
      calc_shape(point.x, &kept.back().second.D, &kept.back().second.e);
    }
  kept_ = std::move(kept);
  kept_mass_ = calc_line_mass();
}

BeamField::LineMass BeamField::calc_line_mass() const {
  if (kept_mass_) return *kept_mass_;
  LineMass line{Matrix12d::Zero(), 0};
  for (const auto& point : calc_points(4, 7)) {
    const Matrix6d m = calc_section_mass(property_, property_.calc_section(point.x / length_), true);
    Matrix6x12d D;
    calc_shape(point.x, &D, nullptr);
    const Matrix6x12d mD = point.weight * (m * D);
    line.M.noalias() += D.transpose().lazyProduct(mD);
    line.mass += point.weight * m(0, 0);
  }
  return line;
}

const BeamField::Shape* BeamField::find_kept(double x) const {
  for (const auto& [at, shape] : kept_)
    if (at == x) return &shape;
  return nullptr;
}

std::shared_ptr<const BeamField> BeamFields::find(std::shared_ptr<const BeamProperty> property, double length) {
  // With more lengths than this the beams are a mesh of all kinds, and the kept shapes would fill memory.
  constexpr std::size_t kMaxFields = 512;
  const std::pair key(std::move(property), length);
  if (const auto known = fields_.find(key); known != fields_.end()) return known->second;
  auto field = std::make_shared<BeamField>(*key.first, length);
  if (fields_.size() >= kMaxFields) return field;
  field->keep_shapes();
  fields_.emplace(key, field);
  return field;
}

Matrix6d BeamField::calc_compliance(double x) const {
  const BeamSection s = property_.calc_section(x / length_);
  const double E = property_.material.E, G = property_.material.G;
  // A stiffness that is not there gets unit stiffness: it gives the field its shape and is masked in K.
  const double I1 = active_.plane1 ? s.I1 : 1, I2 = active_.plane2 ? s.I2 : 1;
  const double I12 = active_.plane1 && active_.plane2 ? s.I12 : 0;
  Matrix6d c = Matrix6d::Zero();
  c(kN, kN) = active_.axial ? 1 / (E * s.A) : 1 / E;
  if (property_.k1 > 0 && active_.plane1 && s.A > 0 && G > 0) c(kVy, kVy) = 1 / (property_.k1 * G * s.A);
  if (property_.k2 > 0 && active_.plane2 && s.A > 0 && G > 0) c(kVz, kVz) = 1 / (property_.k2 * G * s.A);
  c(kT, kT) = active_.torsion ? 1 / (G * s.J) : 1 / E;
  // σ = E (ε + z κy - y κz): [My; Mz] = E [I2 -I12; -I12 I1] [κy; κz] about the neutral axis.
  const double det = E * (I1 * I2 - I12 * I12);
  c(kMy, kMy) = I1 / det;
  c(kMz, kMz) = I2 / det;
  c(kMy, kMz) = c(kMz, kMy) = I12 / det;
  if (s.n.isZero(0)) return c;
  Matrix6d P = Matrix6d::Identity();  // forces about the shear centre to forces about the neutral axis
  P(kMy, kN) = -s.n[1];
  P(kMz, kN) = s.n[0];
  return P.transpose() * c * P;
}

Matrix6d BeamField::calc_flexibility(double x) const {
  Matrix6d F = Matrix6d::Zero();
  const auto add_interval = [&](double from, double to, int num_points) {
    for (const GaussPoint& g : get_gauss_points(num_points)) {
      const double xi = from + (to - from) * g.x;
      F.noalias() += (to - from) * g.weight * calc_equilibrium(x - xi).transpose() *
                     (calc_compliance(xi) * calc_equilibrium(length_ - xi));
    }
  };
  if (uniform_) {
    add_interval(0, x, 2);  // integrand quadratic: exact
    return F;
  }
  for (std::size_t k = 1; k < breaks_.size() && breaks_[k - 1] < x; ++k)
    add_interval(breaks_[k - 1], std::min(x, breaks_[k]), 8);
  return F;
}

Matrix6d BeamField::calc_stiffness() const {
  Matrix6d G = G_;
  const auto clear = [&](int i) {
    G.row(i).setZero();
    G.col(i).setZero();
  };
  if (!active_.axial) clear(kN);
  if (!active_.torsion) clear(kT);
  if (!active_.plane1) clear(kVy), clear(kMz);
  if (!active_.plane2) clear(kVz), clear(kMy);
  return G;
}

Matrix6x12d BeamField::calc_relative() const {
  Matrix6x12d S;
  S.leftCols<6>() = -calc_equilibrium(length_).transpose();
  S.rightCols<6>().setIdentity();
  return S;
}

void BeamField::calc_shape(double x, Matrix6x12d* D, Matrix6x12d* e) const {
  if (const Shape* kept = find_kept(x)) {
    if (D) *D = kept->D;
    if (e) *e = kept->e;
    return;
  }
  if (D) {
    D->noalias() = calc_flexibility(x) * GS_;
    D->leftCols<6>() += calc_equilibrium(x).transpose();
  }
  if (e) e->noalias() = calc_compliance(x) * (calc_equilibrium(length_ - x) * GS_);
}

std::vector<BeamField::Point> BeamField::calc_points(int num_uniform, int num_tapered) const {
  std::vector<Point> points;
  const auto add_interval = [&](double from, double to, int n) {
    for (const GaussPoint& g : get_gauss_points(n))
      points.push_back({from + (to - from) * g.x, (to - from) * g.weight});
  };
  if (uniform_) {
    add_interval(0, length_, num_uniform);
    return points;
  }
  for (std::size_t k = 1; k < breaks_.size(); ++k) add_interval(breaks_[k - 1], breaks_[k], num_tapered);
  return points;
}

}  // namespace bough::fe
