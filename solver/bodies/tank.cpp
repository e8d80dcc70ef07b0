#include "solver/bodies/tank.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bough::solver {
namespace {

constexpr double kPi = std::numbers::pi;

/// Moments of a body of revolution along its axis and about its reference point, and their derivatives by mass.
struct AxialMoments {
  double first = 0, first_m = 0;      ///< ∫ρ z
  double axial = 0, axial_m = 0;      ///< inertia about the axis
  double lateral = 0, lateral_m = 0;  ///< inertia about a normal through the reference point
};

class AxialTank : public TankShape {
 public:
  explicit AxialTank(const TankAxis& place) : place_(place) {}
  TankContent calc(double mass) const final {
    const AxialMoments a = calc_moments(mass);
    TankContent c;
    c.mass = mass;
    set(mass, a.first, a.axial, a.lateral, c.S, c.J);
    set(1, a.first_m, a.axial_m, a.lateral_m, c.S_m, c.J_m);
    return c;
  }

 protected:
  virtual AxialMoments calc_moments(double mass) const = 0;

 private:
  // r = p + s: J = J_s + (2 p·S_s 1 - p S_sᵀ - S_s pᵀ) + m (p·p 1 - p pᵀ), linear in the moments.
  void set(double m, double first, double axial, double lateral, Vector3d& S, Matrix3d& J) const {
    const Vector3d &p = place_.position, &e = place_.axis;
    const Vector3d S_s = first * e;
    S = m * p + S_s;
    J = (axial - lateral) * e * e.transpose() - p * S_s.transpose() - S_s * p.transpose() - m * p * p.transpose();
    J.diagonal().array() += lateral + 2 * p.dot(S_s) + m * p.squaredNorm();
  }
  TankAxis place_;
};

class CylinderTank final : public AxialTank {
 public:
  CylinderTank(const TankAxis& place, double radius, double height, double density)
      : AxialTank(place), r2_(radius * radius), per_length_(density * kPi * r2_), capacity_(per_length_ * height) {}
  double capacity() const override { return capacity_; }

 protected:
  AxialMoments calc_moments(double m) const override {
    const double h = m / per_length_;
    return {0.5 * m * h, h, 0.5 * m * r2_, 0.5 * r2_, m * (0.25 * r2_ + h * h / 3), 0.25 * r2_ + h * h};
  }

 private:
  double r2_, per_length_, capacity_;
};

class SphereTank final : public AxialTank {
 public:
  SphereTank(const TankAxis& place, double radius, double density)
      : AxialTank(place), r_(radius), density_(density), capacity_(4.0 / 3 * kPi * density * std::pow(radius, 3)) {}
  double capacity() const override { return capacity_; }

 protected:
  AxialMoments calc_moments(double m) const override {
    // Height z = R u of the surface above the centre: (2 + 3u - u³)/4 = share, u = 2 cos θ, cos 3θ = 1 - 2 share.
    const double share = std::clamp(m / capacity_, 0.0, 1.0);
    const double u = std::clamp(2 * std::cos((2 * std::asin(std::sqrt(share)) + 4 * kPi) / 3), -1.0, 1.0);
    const double z = r_ * u, r2 = r_ * r_, z2 = z * z, s2 = r2 - z2, c = density_ * kPi;
    AxialMoments a;
    a.first = -0.25 * c * s2 * s2;
    a.first_m = z;
    a.axial = 0.5 * c * (r2 * r2 * (z + r_) - 2.0 / 3 * r2 * (z * z2 + r_ * r2) + 0.2 * (z * z2 * z2 + r_ * r2 * r2));
    a.axial_m = 0.5 * s2;
    a.lateral = 0.5 * a.axial + c * (r2 * (z * z2 + r_ * r2) / 3 - 0.2 * (z * z2 * z2 + r_ * r2 * r2));
    a.lateral_m = 0.25 * s2 + z2;
    return a;
  }

 private:
  double r_, density_, capacity_;
};

class Grain final : public AxialTank {
 public:
  Grain(const TankAxis& place, double radius, double bore, double height, double density)
      : AxialTank(place),
        r2_(radius * radius),
        height_(height),
        per_area_(density * kPi * height),
        capacity_(per_area_ * (r2_ - bore * bore)) {}
  double capacity() const override { return capacity_; }

 protected:
  AxialMoments calc_moments(double m) const override {
    const double bore2 = r2_ - m / per_area_, axial = 0.5 * m * (r2_ + bore2), h2 = height_ * height_ / 3;
    return {0.5 * m * height_, 0.5 * height_, axial, bore2, 0.5 * axial + m * h2, 0.5 * bore2 + h2};
  }

 private:
  double r2_, height_, per_area_, capacity_;
};

class TableTank final : public TankShape {
 public:
  TableTank(const TankTable& table, const TankContent& whole) : table_(table), whole_(whole) {}
  double capacity() const override { return table_.mass.back() - whole_.mass; }
  TankContent calc(double content) const override {
    const double m = content + whole_.mass;
    const auto upper = std::upper_bound(table_.mass.begin(), table_.mass.end(), m) - table_.mass.begin();
    const auto last = static_cast<std::ptrdiff_t>(table_.mass.size()) - 1;
    Vector3d c, c_m = Vector3d::Zero();
    Matrix3d I, I_m = Matrix3d::Zero();
    if (last == 0 || m < table_.mass.front()) {
      c = table_.cg.front();
      I = table_.inertia.front();
    } else {
      const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(upper, 1, last)), before = i - 1;
      const double width = table_.mass[i] - table_.mass[before];
      c_m = (table_.cg[i] - table_.cg[before]) / width;
      I_m = (table_.inertia[i] - table_.inertia[before]) / width;
      c = table_.cg[before] + (m - table_.mass[before]) * c_m;
      I = table_.inertia[before] + (m - table_.mass[before]) * I_m;
    }
    TankContent result;
    result.mass = content;
    result.S = m * c - whole_.S;
    result.S_m = c + m * c_m;
    const Matrix3d unit = c.squaredNorm() * Matrix3d::Identity() - c * c.transpose();
    result.J = I + m * unit - whole_.J;
    result.J_m = I_m + unit + m * (2 * c.dot(c_m) * Matrix3d::Identity() - c * c_m.transpose() - c_m * c.transpose());
    return result;
  }

 private:
  TankTable table_;
  TankContent whole_;
};

class TankWithout final : public TankShape {
 public:
  TankWithout(std::shared_ptr<const TankShape> tank, double point_mass, const Vector3d& position)
      : tank_(std::move(tank)), mass_(point_mass), at_(position) {}
  double capacity() const override { return tank_->capacity(); }
  TankContent calc(double mass) const override {
    TankContent c = tank_->calc(mass);
    c.mass -= mass_;
    c.S -= mass_ * at_;
    c.J -= mass_ * (at_.squaredNorm() * Matrix3d::Identity() - at_ * at_.transpose());
    return c;
  }

 private:
  std::shared_ptr<const TankShape> tank_;
  double mass_;
  Vector3d at_;
};

}  // namespace

std::unique_ptr<const TankShape> make_tank_without(std::shared_ptr<const TankShape> tank, double point_mass,
                                                   const Vector3d& position) {
  return std::make_unique<TankWithout>(std::move(tank), point_mass, position);
}
std::unique_ptr<const TankShape> make_cylinder_tank(const TankAxis& place, double radius, double height,
                                                    double density) {
  return std::make_unique<CylinderTank>(place, radius, height, density);
}
std::unique_ptr<const TankShape> make_sphere_tank(const TankAxis& place, double radius, double density) {
  return std::make_unique<SphereTank>(place, radius, density);
}
std::unique_ptr<const TankShape> make_grain(const TankAxis& place, double radius, double bore, double height,
                                            double density) {
  return std::make_unique<Grain>(place, radius, bore, height, density);
}
std::unique_ptr<const TankShape> make_tank_table(const TankTable& table, const TankContent& whole) {
  return std::make_unique<TableTank>(table, whole);
}

}  // namespace bough::solver
