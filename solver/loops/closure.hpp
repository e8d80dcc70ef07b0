#pragma once
/// \file Interface of a constraint for the loops: rows W(X) on the relative motion of two frames, for every type.
///
/// Hp is fixed at a marker of the parent, Hc at one of the child. X = [R, p]: Hc in Hp; [v; w] and [a; α] its velocity
/// and acceleration as the hinges have them (solver/hinges/hinge.hpp), components in Hp. A closure demands
///     gap(X) = 0,   Wᵀ [v; w] = 0,   Wᵀ [a; α] = bias            W: 6 x num_rows
/// (rows after the first num_position_rows hold rates alone, nonholonomic: their gap is 0)
/// and so passes on the wrench W λ at Hc, in Hp.
#include <memory>

#include "formats/records/constraint_spec.hpp"
#include "solver/hinges/hinge.hpp"

namespace bough::solver {

struct ClosureMotion {
  Matrix6d W = Matrix6d::Zero();  ///< the first num_rows columns
  Vector6d gap = Vector6d::Zero(), bias = Vector6d::Zero();
  HingeMotion hinge;                   ///< of a closing hinge at its coordinates
  Matrix6d H_plus = Matrix6d::Zero();  ///< pseudo-inverse of its H
};

class Closure {
 public:
  /// \param num_rows  of W, 1 to 6. \param num_q  coordinates of the closing hinge, 0 without one.
  /// \param num_rate_rows  the last rows, which hold rates alone.
  Closure(int num_rows, int num_q, int num_rate_rows = 0)
      : num_rows_(num_rows), num_q_(num_q), num_rate_rows_(num_rate_rows) {}
  virtual ~Closure() = default;
  /// Number of constraint rows.
  int num_rows() const { return num_rows_; }
  /// Number of rows that hold a position.
  int num_position_rows() const { return num_rows_ - num_rate_rows_; }
  /// Number of coordinates of the closing hinge; 0 if the constraint is not a hinge.
  int num_q() const { return num_q_; }

  /// W and gap. q: num_q, in: near, out: those of the closing hinge that come nearest to X. No allocation.
  virtual void calc_position(const Matrix3d& R, const Vector3d& p, double* q, ClosureMotion& motion) const = 0;
  /// The bias, after calc_position.
  virtual void calc_velocity(const Matrix3d& R, const Vector3d& p, const Vector6d& V, const double* q,
                             ClosureMotion& motion) const = 0;
  /// A first q from nowhere near.
  virtual void find_start(const Matrix3d&, const Vector3d&, double*) const {}
  /// Returns true if the constraint is a closing hinge with coordinates.
  virtual bool is_hinge() const { return false; }

 private:
  int num_rows_, num_q_, num_rate_rows_;
};

/// W spans what the hinge's H(q) does not, at the q whose pose X(q) is nearest; gap = Wᵀ [p - p(q); log(R R(q)ᵀ)].
std::unique_ptr<const Closure> make_hinge_closure(std::unique_ptr<const Hinge> hinge);
/// |p| = length.
std::unique_ptr<const Closure> make_distance_closure(double length);
/// p on the line along a unit axis through Hp.
std::unique_ptr<const Closure> make_line_closure(const Vector3d& axis);
/// p in the plane through Hp.
std::unique_ptr<const Closure> make_plane_closure(const Vector3d& normal);
/// Rolling without slip on the plane through Hp: a rim of round cross-section (radius `crown`) along the circle of
/// `radius` about Hc's origin and the unit axis (in Hc). Height is one row, both components of slip are rates alone.
std::unique_ptr<const Closure> make_rolling_closure(const Vector3d& normal, const Vector3d& axis, double radius,
                                                    double crown);
/// No velocity of Hc's origin along a unit axis of Hc.
std::unique_ptr<const Closure> make_knife_edge_closure(const Vector3d& axis);

}  // namespace bough::solver
