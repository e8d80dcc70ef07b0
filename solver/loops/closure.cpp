#include "solver/loops/closure.hpp"

#include <array>
#include <cmath>

namespace bough::solver {

namespace {

using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
constexpr int kMaxFits = 50;

Vector3d calc_log(const Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

class HingeClosure final : public Closure {
 public:
  explicit HingeClosure(std::unique_ptr<const Hinge> hinge)
      : Closure(6 - hinge->num_u(), hinge->num_q()), hinge_(std::move(hinge)) {}

  void calc_position(const Matrix3d& R, const Vector3d& p, double* q, ClosureMotion& m) const override {
    fit(R, p, q, m);
    const int nu = hinge_->num_u();
    if (nu == 0) {
      m.W.setIdentity();
      m.gap = calc_error(R, p, m.hinge);
      return;
    }
    const Eigen::HouseholderQR<Columns> qr(m.hinge.H.leftCols(nu));
    const Matrix6d Q = qr.householderQ() * Matrix6d::Identity();
    m.W.leftCols(6 - nu) = Q.rightCols(6 - nu);
    m.gap.head(6 - nu).noalias() = m.W.leftCols(6 - nu).transpose() * calc_error(R, p, m.hinge);
  }

  void calc_velocity(const Matrix3d&, const Vector3d&, const Vector6d& V, const double*,
                     ClosureMotion& m) const override {
    Vector6d u = m.H_plus * V;
    hinge_->calc_bias(u.data(), m.hinge);
    m.bias.head(num_rows()).noalias() = m.W.leftCols(num_rows()).transpose() * m.hinge.bias;
  }

  // Rotations by thirds of a turn: one of them lies in the basin of the nearest pose. Translations have one basin.
  void find_start(const Matrix3d& R, const Vector3d& p, double* q) const override {
    ClosureMotion m;
    double best = -1;
    std::array<double, 7> trial{}, found{};
    hinge_->set_neutral(trial.data());
    HingeMotion neutral;
    hinge_->calc_position(trial.data(), neutral);
    std::array<int, 6> places{};
    int trials = 1;
    for (int i = 0; i < hinge_->num_u(); ++i) {
      places[static_cast<std::size_t>(i)] = neutral.H.col(i).tail<3>().isZero(0) ? 1 : 3;
      trials *= places[static_cast<std::size_t>(i)];
    }
    for (int k = 0; k < trials; ++k) {
      hinge_->set_neutral(trial.data());
      Vector6d turn = Vector6d::Zero();
      for (int i = 0, left = k; i < hinge_->num_u(); ++i) {
        turn[i] = 2.0 * (left % places[static_cast<std::size_t>(i)]);
        left /= places[static_cast<std::size_t>(i)];
      }
      move(turn, trial.data());
      fit(R, p, trial.data(), m);
      const double error = calc_error(R, p, m.hinge).norm();
      if (best >= 0 && error > best - 1e-9) continue;
      best = error;
      found = trial;
    }
    std::copy_n(found.begin(), num_q(), q);
  }

  bool is_hinge() const override { return true; }

 private:
  static Vector6d calc_error(const Matrix3d& R, const Vector3d& p, const HingeMotion& h) {
    Vector6d e;
    e << p - h.p_HpHc, calc_log(R * h.R_HpHc.transpose());
    return e;
  }

  void move(const Vector6d& step, double* q) const {
    double q_dot[7];
    hinge_->calc_q_dot(q, step.data(), q_dot);
    for (int i = 0; i < num_q(); ++i) q[i] += q_dot[i];
    if (!hinge_->has_independent_coordinates()) Eigen::Map<Eigen::Vector4d>(q).normalize();
  }

  // Gauss-Newton: quadratic where the gap vanishes.
  void fit(const Matrix3d& R, const Vector3d& p, double* q, ClosureMotion& m) const {
    const int nu = hinge_->num_u();
    double last = 0;
    for (int i = 0; i < kMaxFits; ++i) {
      m.hinge = HingeMotion();
      hinge_->calc_position(q, m.hinge);
      if (nu == 0) return;
      const Columns H = m.hinge.H.leftCols(nu);
      const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6> D = H.transpose() * H;
      m.H_plus.topRows(nu) = D.ldlt().solve(H.transpose());
      const Vector6d e = calc_error(R, p, m.hinge);
      Vector6d step = Vector6d::Zero();
      step.head(nu).noalias() = m.H_plus.topRows(nu) * e;
      const double size = step.norm();
      if (size < 1e-15 || (i > 2 && size < 1e-12 && size > 0.5 * last)) break;
      last = size;
      move(step, q);
    }
  }

  std::unique_ptr<const Hinge> hinge_;
};

class DistanceClosure final : public Closure {
 public:
  explicit DistanceClosure(double length) : Closure(1, 0), length_(length) {}
  void calc_position(const Matrix3d&, const Vector3d& p, double*, ClosureMotion& m) const override {
    const double r = p.norm();
    m.W.col(0) << (r > 0 ? Vector3d(p / r) : Vector3d::UnitX()), Vector3d::Zero();
    m.gap[0] = r - length_;
  }
  void calc_velocity(const Matrix3d&, const Vector3d& p, const Vector6d& V, const double*,
                     ClosureMotion& m) const override {
    const Vector3d v = V.head<3>();
    const double along = m.W.col(0).head<3>().dot(v), r = p.norm();
    m.bias[0] = r > 0 ? -(v.squaredNorm() - along * along) / r : 0;
  }

 private:
  double length_;
};

/// p has no component along given unit vectors of Hp.
class PointClosure final : public Closure {
 public:
  explicit PointClosure(const Matrix3d& directions, int num) : Closure(num, 0), directions_(directions) {}
  void calc_position(const Matrix3d&, const Vector3d& p, double*, ClosureMotion& m) const override {
    for (int i = 0; i < num_rows(); ++i) {
      m.W.col(i) << directions_.col(i), Vector3d::Zero();
      m.gap[i] = directions_.col(i).dot(p);
    }
  }
  void calc_velocity(const Matrix3d&, const Vector3d&, const Vector6d&, const double*,
                     ClosureMotion& m) const override {
    m.bias.setZero();
  }

 private:
  Matrix3d directions_;
};

/// With n the normal of the plane, e the axis of the disc, m the unit vector of n - (n·e) e, the point of contact is at
/// ρ = -R m - c n from the centre, and each row is d·(v + w × ρ), d = n and two tangents. The row of n is d/dt of the
/// height n·p - (R m·n + c).
class RollingClosure final : public Closure {
 public:
  RollingClosure(const Vector3d& normal, const Vector3d& axis, double radius, double crown)
      : Closure(3, 0, 2), axis_(axis), radius_(radius), crown_(crown) {
    directions_.col(0) = normal;
    directions_.col(1) = normal.unitOrthogonal();
    directions_.col(2) = normal.cross(Vector3d(directions_.col(1)));
  }
  void calc_position(const Matrix3d& R, const Vector3d& p, double*, ClosureMotion& motion) const override {
    const Contact c = calc_contact(R);
    const Vector3d rho = -radius_ * c.m - crown_ * directions_.col(0);
    for (int i = 0; i < 3; ++i) {
      const Vector3d d = directions_.col(i);
      motion.W.col(i) << d, rho.cross(d);
    }
    motion.gap.setZero();
    motion.gap[0] = directions_.col(0).dot(p + rho);
  }
  void calc_velocity(const Matrix3d& R, const Vector3d&, const Vector6d& V, const double*,
                     ClosureMotion& motion) const override {
    const Contact c = calc_contact(R);
    const Vector3d n = directions_.col(0), w = V.tail<3>(), e_dot = w.cross(c.e);
    const Vector3d t_dot = -n.dot(e_dot) * c.e - n.dot(c.e) * e_dot;
    const Vector3d rho_dot = -radius_ / c.size * (t_dot - c.m.dot(t_dot) * c.m);
    for (int i = 0; i < 3; ++i) motion.bias[i] = -directions_.col(i).dot(w.cross(rho_dot));
  }

 private:
  struct Contact {
    Vector3d e, m;
    double size = 1;  ///< sine of the angle between plane and disc
  };
  // A disc that lies flat touches everywhere: any point of the rim stands for it.
  Contact calc_contact(const Matrix3d& R) const {
    const Vector3d n = directions_.col(0);
    Contact c;
    c.e = R * axis_;
    const Vector3d t = n - n.dot(c.e) * c.e;
    c.size = t.norm();
    if (c.size < kFlat) return {c.e, c.e.unitOrthogonal(), kFlat};
    c.m = t / c.size;
    return c;
  }
  static constexpr double kFlat = 1e-12;

  Matrix3d directions_;
  Vector3d axis_;
  double radius_, crown_;
};

class KnifeEdgeClosure final : public Closure {
 public:
  explicit KnifeEdgeClosure(const Vector3d& axis) : Closure(1, 0, 1), axis_(axis) {}
  void calc_position(const Matrix3d& R, const Vector3d&, double*, ClosureMotion& m) const override {
    m.W.col(0) << R * axis_, Vector3d::Zero();
    m.gap.setZero();
  }
  void calc_velocity(const Matrix3d&, const Vector3d&, const Vector6d& V, const double*,
                     ClosureMotion& m) const override {
    const Vector3d v = V.head<3>(), w = V.tail<3>();
    m.bias[0] = -w.cross(Vector3d(m.W.col(0).head<3>())).dot(v);
  }

 private:
  Vector3d axis_;
};

}  // namespace

std::unique_ptr<const Closure> make_rolling_closure(const Vector3d& normal, const Vector3d& axis, double radius,
                                                    double crown) {
  return std::make_unique<RollingClosure>(normal, axis, radius, crown);
}

std::unique_ptr<const Closure> make_knife_edge_closure(const Vector3d& axis) {
  return std::make_unique<KnifeEdgeClosure>(axis);
}

std::unique_ptr<const Closure> make_hinge_closure(std::unique_ptr<const Hinge> hinge) {
  return std::make_unique<HingeClosure>(std::move(hinge));
}

std::unique_ptr<const Closure> make_distance_closure(double length) {
  return std::make_unique<DistanceClosure>(length);
}

std::unique_ptr<const Closure> make_line_closure(const Vector3d& axis) {
  Matrix3d directions = Matrix3d::Zero();
  directions.col(0) = axis.unitOrthogonal();
  directions.col(1) = axis.cross(Vector3d(directions.col(0)));
  return std::make_unique<PointClosure>(directions, 2);
}

std::unique_ptr<const Closure> make_plane_closure(const Vector3d& normal) {
  Matrix3d directions = Matrix3d::Zero();
  directions.col(0) = normal;
  return std::make_unique<PointClosure>(directions, 1);
}

}  // namespace bough::solver
