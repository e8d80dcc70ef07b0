// Motion of points between two ends along curves: rigid-body motions, the quadratic forms of second order, and forces
// as derivatives of the work.
#include "fe/corotational/chord_series.hpp"

#include <gtest/gtest.h>

#include "base/rotation.hpp"

namespace bough::fe {
namespace {

constexpr int kNumPoints = 3;

/// A place and two arms of random linear motion, ends on arms.
CarriedMass make_points() {
  CarriedMass carried(12);
  const Vector3d x_a(0.3, -0.2, 0.1), chord(0.8, 0.4, -0.3), arms[2] = {{0.1, 0.2, -0.1}, {-0.2, 0.1, 0.15}};
  MatrixXd ends = MatrixXd::Identity(12, 12);
  ends.block<3, 3>(0, 3) = -skew(arms[0]);
  ends.block<3, 3>(6, 9) = -skew(arms[1]);
  std::vector<ChordPoint> moved;
  for (int p = 0; p < kNumPoints; ++p) {
    ChordPoint point;
    point.motion.setRandom();
    point.turn.setRandom();
    point.point = carried.add_point(p == 0, Vector3d(0.2 * p + 0.5, 0.3, -0.4), point.motion * ends);
    moved.push_back(point);
  }
  carried.add_chord_field(x_a, chord, ends, moved);
  return carried;
}

MatrixXd make_curve(const VectorXd& u) {
  MatrixXd curve = MatrixXd::Zero(12, kSeriesTop);
  curve.col(0) = u;
  return curve;
}

TEST(ChordSeries, RigidMotionsOfTheEndsAreThoseOfThePoints) {
  const CarriedMass carried = make_points();
  const CarriedField& field = carried.fields.front();
  const Vector3d theta(0.3, -0.5, 0.7);
  SeriesVector along = make_zero_vector();
  along[1] = theta;
  const SeriesMatrix R = calc_exponential(along);
  // Grids and ends turn about the origin by exp(ε θ).
  const Vector3d grids[2] = {field.x_a - field.arms[0], field.x_a + field.chord - field.arms[1]};
  MatrixXd u = MatrixXd::Zero(12, kSeriesTop);
  for (int k = 1; k <= kSeriesTop; ++k) {
    for (int end = 0; end < 2; ++end) u.block<3, 1>(6 * end, k - 1) = R[static_cast<std::size_t>(k)] * grids[end];
  }
  for (int end = 0; end < 2; ++end) u.block<3, 1>(6 * end + 3, 0) = theta;
  const ChordSeries chord(carried, u);
  for (std::size_t p = 0; p < kNumPoints; ++p) {
    const SeriesVector motion = chord.calc_motion(p);
    for (std::size_t k = 1; k <= kSeriesTop; ++k)
      EXPECT_LT((motion[k] - R[k] * carried.points[p].x).norm(), 1e-14) << p << " order " << k;
  }
}

TEST(ChordSeries, SecondOrderIsThatOfTheQuadraticForms) {
  const CarriedMass carried = make_points();
  const CarriedField& field = carried.fields.front();
  const VectorXd u = VectorXd::Random(12);
  const ChordSeries chord(carried, make_curve(u));
  // The forms are of the ends: those of grids that turn arms have ½ θ×(θ×w) more.
  VectorXd end_motion = VectorXd::Zero(12);
  for (int end = 0; end < 2; ++end) {
    const Vector3d theta = u.segment<3>(6 * end + 3);
    end_motion.segment<3>(6 * end) = 0.5 * theta.cross(theta.cross(field.arms[static_cast<std::size_t>(end)]));
  }
  const VectorXd z = field.L * u;
  for (std::size_t p = 0; p < kNumPoints; ++p) {
    const auto& part = field.parts[p];
    Vector3d expected;
    for (int a = 0; a < 3; ++a) expected[a] = z.dot(part.Q[static_cast<std::size_t>(a)] * z);
    expected += field.moved[p].motion.middleCols<3>(6) * (end_motion.segment<3>(6) - end_motion.head<3>());
    if (carried.points[p].is_place) expected += end_motion.head<3>();
    EXPECT_LT((chord.calc_motion(p)[2] - expected).norm(), 1e-14) << p;
  }
}

TEST(ChordSeries, ForcesAreDerivativesOfTheWork) {
  const CarriedMass carried = make_points();
  const VectorXd u = VectorXd::Random(12);
  MatrixXd F = MatrixXd::Random(3, kNumPoints);
  std::vector<SeriesVector> forces(kNumPoints, make_zero_vector());
  for (std::size_t p = 0; p < kNumPoints; ++p) forces[p][1] = F.col(static_cast<Eigen::Index>(p));
  const MatrixXd f = ChordSeries(carried, make_curve(u)).calc_forces(forces);
  const auto calc_work = [&](const VectorXd& at, std::size_t order) {
    const ChordSeries chord(carried, make_curve(at));
    double work = 0;
    for (std::size_t p = 0; p < kNumPoints; ++p)
      work += F.col(static_cast<Eigen::Index>(p)).dot(chord.calc_motion(p)[order]);
    return work;
  };
  for (int k = 1; k <= kSeriesTop; ++k) {
    const auto order = static_cast<std::size_t>(k);
    for (int j = 0; j < 12; ++j) {
      // Degree k: five points are exact to degree 4.
      constexpr double h = 1e-2;
      const auto slope = [&](double step) {
        const VectorXd e = step * VectorXd::Unit(12, j);
        return (calc_work(u + e, order) - calc_work(u - e, order)) / (2 * step);
      };
      const double expected = (4 * slope(h) - slope(2 * h)) / 3;
      EXPECT_NEAR(f(j, k - 1), expected, k < 5 ? 1e-11 : 1e-6) << "order " << k << ", dof " << j;
    }
  }
}

}  // namespace
}  // namespace bough::fe
