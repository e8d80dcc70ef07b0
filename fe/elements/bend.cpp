#include "fe/elements/bend.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "base/rotation.hpp"
#include "fe/elements/carried.hpp"
#include "fe/shape/gauss.hpp"

namespace bough::fe {
namespace {

/// Straight parts of an arc for its mass and geometric stiffness.
constexpr int kNumParts = 32;

using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Point {
  Vector3d x;
  Matrix3d axes;  ///< columns: tangent, radial (outward), normal
};

Point calc_point(const BendGeometry& g, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const Vector3d radial = c * g.radial + s * g.tangent, tangent = (c * g.tangent - s * g.radial).normalized();
  Point p;
  p.x = g.centre + radial;
  p.axes << tangent, radial.normalized(), tangent.cross(radial.normalized());
  return p;
}

/// Force and moment on the section at `at`, in its axes, by force and moment (basic) acting at x. Transposed: what a
/// deformation at `at` does to the far point x.
Matrix6d calc_sections(const Point& at, const Vector3d& x) {
  Matrix6d W = Matrix6d::Zero();
  W.topLeftCorner<3, 3>() = W.bottomRightCorner<3, 3>() = at.axes.transpose();
  W.bottomLeftCorner<3, 3>() = at.axes.transpose() * skew(x - at.x);
  return W;
}

Eigen::Matrix<double, 6, 1> calc_compliance(const BeamProperty& property) {
  const double E = property.material.E, G = property.material.G;
  const BeamSection& s = property.stations.front();
  const auto per = [](double k) { return k > 0 ? 1 / k : 0.0; };
  Eigen::Matrix<double, 6, 1> c;
  c << 1 / (E * s.A), per(property.k1 * G * s.A), per(property.k2 * G * s.A), 1 / (G * s.J), 1 / (E * s.I2),
      1 / (E * s.I1);
  return c;
}

/// F = ∫ W(x)ᵀ c W(x_B) ds from end A to the angle `to`: displacements there by forces at end B, A held.
Matrix6d calc_flexibility(const BendGeometry& g, const Eigen::Matrix<double, 6, 1>& c, double to, const Vector3d& x_b) {
  constexpr int kPanels = 4;
  const Vector3d x = calc_point(g, to).x;
  Matrix6d F = Matrix6d::Zero();
  for (int panel = 0; panel < kPanels; ++panel)
    for (const GaussPoint& point : get_gauss_points(8)) {
      const Point at = calc_point(g, to * (panel + point.x) / kPanels);
      const double ds = g.radial.norm() * to * point.weight / kPanels;
      F += ds * calc_sections(at, x).transpose() * c.asDiagonal() * calc_sections(at, x_b);
    }
  return F;
}

/// Rigid-body motion of x by that of a point at -`arm` from it.
Matrix6d calc_carry(const Vector3d& arm) {
  Matrix6d T = Matrix6d::Identity();
  T.topRightCorner<3, 3>() = -skew(arm);
  return T;
}

}  // namespace

Bend::Bend(int id, std::vector<int> nodes, std::vector<int> gdofs, std::shared_ptr<const BeamProperty> property,
           const BendGeometry& geometry)
    : Element(id, "CBEND", std::move(nodes), std::move(gdofs)) {
  BOUGH_DEMAND(num_dofs() == 12);
  alpha_ = property->material.alpha;
  tref_ = property->material.tref;
  const auto compliance = calc_compliance(*property);
  const Point a = calc_point(geometry, 0), b = calc_point(geometry, geometry.angle);
  chord_ = b.x - a.x;
  Eigen::Matrix<double, 6, 12> S;
  S << -calc_carry(b.x - a.x), Matrix6d::Identity();
  const Eigen::LLT<Matrix6d> F(calc_flexibility(geometry, compliance, geometry.angle, b.x));
  const Eigen::Matrix<double, 6, 12> end_force = F.solve(S);
  K_ = S.transpose() * end_force;
  K_ = (0.5 * (K_ + K_.transpose())).eval();
  sections_.resize(12, 12);
  sections_ << calc_sections(a, b.x) * end_force, calc_sections(b, b.x) * end_force;

  motion_ = MatrixXd::Zero(6 * (kNumParts + 1), 12);
  parts_by_forces_.resize(8 * kNumParts, 6);
  const Matrix6d to_basic = calc_sections(b, b.x).transpose();
  const std::vector<int> dofs{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  for (int k = 0; k <= kNumParts; ++k) {
    const double angle = geometry.angle * k / kNumParts;
    const Point p = calc_point(geometry, angle);
    chain_.push_back(p.x);
    auto rows = motion_.middleRows<6>(6 * k);
    rows.leftCols<6>() = calc_carry(p.x - a.x);
    rows += calc_flexibility(geometry, compliance, angle, b.x) * end_force;
    if (k == 0) continue;
    const Point before = calc_point(geometry, geometry.angle * (k - 1) / kNumParts),
                middle = calc_point(geometry, geometry.angle * (k - 0.5) / kNumParts);
    BeamGeometry straight;
    straight.is_part = true;
    straight.length = (p.x - before.x).norm();
    straight.R_basic_element = middle.axes;
    parts_.push_back(std::make_unique<Beam>(id, "CBEND", std::vector<int>{0, 1}, dofs, property, straight));
    Point from = before, to = p;
    from.axes = to.axes = middle.axes;
    const Matrix6d at_from = calc_sections(from, b.x) * to_basic, at_to = calc_sections(to, b.x) * to_basic;
    parts_by_forces_.middleRows<8>(8 * (k - 1)) << at_to.topRows<4>(), at_from.bottomRows<2>(), at_to.bottomRows<2>();
  }
  const double half = geometry.angle / (2 * kNumParts);
  mass_scale_ = half / std::sin(half);
}

void Bend::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const { K += scale * K_; }

void Bend::add_mass(MassKind kind, double scale, Eigen::Ref<MatrixXd> M) const {
  MatrixXd whole = MatrixXd::Zero(12, 12), part(12, 12);
  for (int k = 0; k < kNumParts; ++k) {
    const auto motion = motion_.middleRows<12>(6 * k);
    part.setZero();
    parts_[static_cast<std::size_t>(k)]->add_mass(MassKind::Consistent, scale * mass_scale_, part);
    whole += motion.transpose() * part * motion;
  }
  if (kind == MassKind::Consistent) {
    M += whole;
    return;
  }
  double mass = 0;
  for (const int i : {0, 6})
    for (const int j : {0, 6}) mass += whole(i, j);
  for (const int i : {0, 1, 2, 6, 7, 8}) M(i, i) += 0.5 * mass;
}

bool Bend::add_carried(MassKind, const Eigen::Ref<const Matrix3Xd>&, CarriedMass& carried) const {
  if (carried.detail == CarriedDetail::Whether) return true;
  std::vector<ChordPoint> moved;
  for (int k = 0; k < kNumParts; ++k) {
    const Eigen::Matrix<double, 12, 12> motion = motion_.middleRows<12>(6 * k);
    CarriedMass part(12, carried.detail);
    Matrix3Xd x(3, 2);
    x << chain_[static_cast<std::size_t>(k)], chain_[static_cast<std::size_t>(k) + 1];
    parts_[static_cast<std::size_t>(k)]->add_carried(MassKind::Consistent, x, part);
    const auto first = static_cast<int>(carried.points.size());
    for (const auto& point : part.points) carried.add_point(point.is_place, point.x, point.H * motion);
    carried.mu.bottomRightCorner(part.mu.rows(), part.mu.cols()) = mass_scale_ * part.mu;
    for (const auto& p : part.chord_points) moved.push_back({first + p.point, p.motion * motion, p.turn * motion});
  }
  if (carried.detail == CarriedDetail::SecondOrder)
    carried.add_chord_field(chain_.front(), chain_.back() - chain_.front(), MatrixXd::Identity(12, 12), moved);
  return true;
}

std::vector<std::string> Bend::internal_force_names() const {
  std::vector<std::string> names;
  for (const char* end : {"_a", "_b"})
    for (const char* name : {"axial", "shear_radial", "shear_normal", "torque", "moment_radial", "moment_normal"})
      names.push_back(std::string(name) + end);
  return names;
}

void Bend::calc_internal_forces(const Eigen::Ref<const VectorXd>& u, Eigen::Ref<VectorXd> force) const {
  force = sections_ * u;
}

ThermalState Bend::calc_thermal(const ElementTemperature& T) const {
  VectorXd free = VectorXd::Zero(12);
  free.segment<3>(6) = alpha_ * T.calc_change(tref_).node.mean() * chord_;
  const VectorXd f = K_ * free;
  ThermalState state(num_dofs(), num_internal_forces());
  state.load += f;
  state.force -= sections_ * free;
  state.energy = 0.5 * free.dot(f);
  return state;
}

void Bend::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                   Eigen::Ref<MatrixXd> K_G) const {
  const VectorXd part_forces = parts_by_forces_ * force.tail<6>();
  MatrixXd part(12, 12);
  for (int k = 0; k < kNumParts; ++k) {
    const auto motion = motion_.middleRows<12>(6 * k);
    part.setZero();
    parts_[static_cast<std::size_t>(k)]->add_geometric_stiffness(part_forces.segment<8>(8 * k), scale, part);
    K_G += motion.transpose() * part * motion;
  }
}

}  // namespace bough::fe
