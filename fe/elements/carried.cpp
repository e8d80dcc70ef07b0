#include "fe/elements/carried.hpp"

#include "base/rotation.hpp"

namespace bough::fe {

int CarriedMass::add_point(bool is_place, const Vector3d& x, const Eigen::Ref<const Matrix3Xd>& H) {
  const auto index = static_cast<int>(points.size());
  points.push_back({is_place, x, H});
  mu.conservativeResize(index + 1, index + 1);
  mu.row(index).setZero();
  mu.col(index).setZero();
  return index;
}

int CarriedMass::add_turn(int slot) {
  turns.push_back({slot, select(slot), {}});
  return static_cast<int>(turns.size()) - 1;
}

int CarriedMass::add_body(const Vector3d& x, double m, const Vector3d& S, const Matrix3d& E,
                          const Eigen::Ref<const Matrix3Xd>& U, const Eigen::Ref<const Matrix3Xd>& Theta, int slot,
                          bool has_turn) {
  const int place = add_point(true, x, U);
  mu(place, place) = m;
  if (S.isZero(0) && E.isZero(0)) return place;
  CarriedTurn turn{slot, Theta, {}};
  for (int a = 0; a < 3; ++a) {
    const Vector3d arm = Vector3d::Unit(a);
    turn.parts.push_back({add_point(false, arm, -skew(arm) * Theta), arm, Matrix3d::Identity()});
  }
  mu.block<3, 1>(place + 1, place) = S;
  mu.block<1, 3>(place, place + 1) = S.transpose();
  mu.block<3, 3>(place + 1, place + 1) = E;
  if (has_turn) turns.push_back(std::move(turn));
  return place;
}

void CarriedMass::add_grid_body(const Vector3d& x, double m, const Vector3d& S, const Matrix3d& E, int first) {
  add_body(x, m, S, E, select(first), select(first + 3), first + 3);
}

namespace {

using Matrix39d = Eigen::Matrix<double, 3, 9>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// out_a += factor (P z × Q z)_a.
void add_product(const Matrix39d& P, const Matrix39d& Q, double factor, std::array<Matrix9d, 3>& out) {
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    out[static_cast<std::size_t>(a)] += factor * (P.row(b).transpose() * Q.row(c) - P.row(c).transpose() * Q.row(b));
  }
}

}  // namespace

/// Places are x_A + u_A + R (X + D q), D q the motion by the end dofs seen in the frame, R = exp(θ): of second order
/// are ½ θ×(θ×X) + θ×(D q), and what D makes of the second order of q: -θ×d + ½ θ×(θ×chord) of end B, -½ θ×θ_k of the
/// end rotations. An arm turns by R exp(θ_own) with θ_own of the deformation.
void CarriedMass::add_chord_field(const Vector3d& x_a, const Vector3d& chord, const Eigen::Ref<const MatrixXd>& ends,
                                  const std::vector<ChordPoint>& moved) {
  Matrix39d theta_a = Matrix39d::Zero(), d = theta_a, theta_b = theta_a;
  theta_a.leftCols<3>().setIdentity();
  d.middleCols<3>(3).setIdentity();
  theta_b.rightCols<3>().setIdentity();
  const Matrix39d theta = 0.5 * (theta_a + theta_b);
  Eigen::Matrix<double, 12, 9> ends_seen = Eigen::Matrix<double, 12, 9>::Zero();  // first order, in the frame
  ends_seen.middleRows<3>(3) = theta_a - theta;
  ends_seen.middleRows<3>(6) = d + skew(chord) * theta;
  ends_seen.bottomRows<3>() = theta_b - theta;
  std::array<std::array<Matrix9d, 3>, 3> second;  // of θ_A, end B, θ_B
  for (auto& part : second) part.fill(Matrix9d::Zero());
  const Matrix39d turned_chord = -skew(chord) * theta;
  add_product(theta, theta_a, -0.5, second[0]);
  add_product(theta, d, -1, second[1]);
  add_product(theta, turned_chord, 0.5, second[1]);
  add_product(theta, theta_b, -0.5, second[2]);

  CarriedField field;
  field.L.resize(9, num_dofs);
  field.L << ends.middleRows<3>(3), ends.middleRows<3>(6) - ends.topRows<3>(), ends.bottomRows<3>();
  for (const auto& p : moved) {
    const auto& point = points[static_cast<std::size_t>(p.point)];
    const Vector3d X = point.is_place ? Vector3d(point.x - x_a) : point.x;
    CarriedField::Part part{p.point, {}};
    part.Q.fill(Matrix9d::Zero());
    const Matrix39d turned = -skew(X) * theta;
    add_product(theta, turned, 0.5, part.Q);
    add_product(theta, p.motion * ends_seen, 1, part.Q);
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          part.Q[static_cast<std::size_t>(a)] +=
              p.motion(a, 3 + 3 * k + b) * second[static_cast<std::size_t>(k)][static_cast<std::size_t>(b)];
    if (!point.is_place) {
      const Matrix39d own = p.turn * ends_seen, own_arm = -skew(X) * own;
      add_product(own, own_arm, 0.5, part.Q);
    }
    field.parts.push_back(std::move(part));
  }
  field.x_a = x_a;
  field.chord = chord;
  field.moved = moved;
  if (num_dofs == 12)  // blocks -w̃
    field.arms = {Vector3d(ends(1, 5), ends(2, 3), ends(0, 4)), Vector3d(ends(7, 11), ends(8, 9), ends(6, 10))};
  fields.push_back(std::move(field));
  chord_points = moved;
}

Matrix3Xd CarriedMass::select(int first) const {
  Matrix3Xd H = Matrix3Xd::Zero(3, num_dofs);
  H.middleCols<3>(first).setIdentity();
  return H;
}

MatrixXd CarriedMass::calc_mass() const {
  MatrixXd M = MatrixXd::Zero(num_dofs, num_dofs);
  for (Eigen::Index r = 0; r < mu.rows(); ++r)
    for (Eigen::Index s = 0; s < mu.cols(); ++s)
      if (mu(r, s) != 0)
        M += mu(r, s) * points[static_cast<std::size_t>(r)].H.transpose() * points[static_cast<std::size_t>(s)].H;
  return M;
}

bool find_moments(const Eigen::Matrix<double, 6, 6>& M, MassMoments& moments) {
  moments.m = M(0, 0);
  moments.S = Vector3d(M(1, 5), M(2, 3), M(0, 4));  // of -S̃ above
  const Matrix3d J = M.bottomRightCorner<3, 3>();
  moments.E = 0.5 * J.trace() * Matrix3d::Identity() - J;
  const double size = M.topLeftCorner<3, 3>().cwiseAbs().maxCoeff();
  if ((M.topLeftCorner<3, 3>() - moments.m * Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-9 * size) return false;
  const Matrix3d coupling = M.topRightCorner<3, 3>();
  return (coupling + skew(moments.S)).cwiseAbs().maxCoeff() <= 1e-9 * coupling.cwiseAbs().maxCoeff();
}

Matrix3d calc_arm_stiffness(const Vector3d& f, const Vector3d& arm) {
  const Matrix3d outer = f * arm.transpose();
  return f.dot(arm) * Matrix3d::Identity() - 0.5 * (outer + outer.transpose());
}

}  // namespace bough::fe
