// Grids at the mean of others, along curves and at finite motions: rigid-body motions, singular values, forces as
// derivatives of the work, tangents by differences.
#include "fe/corotational/mean_series.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>

#include "base/rotation.hpp"
#include "fe/corotational/mean_motion.hpp"

namespace bough::fe {
namespace {

const Vector3d kArm(0.4, -0.3, 0.7);

/// Three grids, one with its rotations, about the origin.
WeightedMean make_mean() {
  WeightedMean mean;
  mean.rotates = true;
  mean.members = {{0, {1, 0.2, 0.1}, 1, 0}, {1, {-0.3, 0.8, -0.2}, 2, 0.6}, {2, {0.1, 0.5, 0.9}, 0.7, 0}};
  Vector3d centre = Vector3d::Zero();
  double total = 0;
  for (const auto& member : mean.members) {
    centre += member.weight * member.arm;
    total += member.weight;
  }
  for (auto& member : mean.members) member.arm -= centre / total;
  return mean;
}

std::vector<MatrixXd> make_random_motion(std::size_t num, double size) {
  std::vector<MatrixXd> u;
  for (std::size_t i = 0; i < num; ++i) u.push_back(size * MatrixXd::Random(6, kSeriesTop));
  return u;
}

VectorXd sum_up(const MatrixXd& series, double epsilon) {
  VectorXd sum = VectorXd::Zero(series.rows());
  for (Eigen::Index k = 0; k < series.cols(); ++k) sum += std::pow(epsilon, k + 1) * series.col(k);
  return sum;
}

TEST(MeanSeries, RigidMotionsOfTheMembersAreThoseOfTheMean) {
  const WeightedMean mean = make_mean();
  SeriesVector along = make_zero_vector();
  along[1] = Vector3d(0.3, -0.5, 0.7);
  const SeriesMatrix R = calc_exponential(along);
  std::vector<MatrixXd> u(3, MatrixXd::Zero(6, kSeriesTop));
  for (std::size_t i = 0; i < 3; ++i) {
    for (int k = 1; k <= kSeriesTop; ++k)
      u[i].block<3, 1>(0, k - 1) = R[static_cast<std::size_t>(k)] * mean.members[i].arm + Vector3d(1, 2, 3) / k;
    u[i].block<3, 1>(3, 0) = along[1];
  }
  const MatrixXd motion = MeanSeries(mean, u).calc_motion(kArm);
  for (int k = 1; k <= kSeriesTop; ++k) {
    EXPECT_LT((motion.block<3, 1>(0, k - 1) - R[static_cast<std::size_t>(k)] * kArm - Vector3d(1, 2, 3) / k).norm(),
              1e-14);
    EXPECT_LT((motion.block<3, 1>(3, k - 1) - along[static_cast<std::size_t>(k)]).norm(), 1e-14);
  }
}

TEST(MeanSeries, IsTheBestFitOfFiniteMotions) {
  const WeightedMean mean = make_mean();
  const auto u = make_random_motion(3, 0.5);
  const MatrixXd motion = MeanSeries(mean, u).calc_motion(kArm);
  double last = 0;
  for (const double epsilon : {0.1, 0.05}) {
    Matrix3d B = Matrix3d::Zero();
    Vector3d centre = Vector3d::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& member = mean.members[i];
      const VectorXd at = sum_up(u[i], epsilon);
      centre += member.weight / 3.7 * at.head<3>();
      B += member.weight * (member.arm + at.head<3>()) * member.arm.transpose() +
           0.5 * member.turn_weight * calc_rotation_exp(at.tail<3>());
    }
    const Eigen::JacobiSVD<Matrix3d> svd(B, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
    const VectorXd found = sum_up(motion, epsilon);
    const double error =
        (found.head<3>() - centre - R * kArm + kArm).norm() + (calc_rotation_exp(found.tail<3>()) - R).norm();
    EXPECT_LT(error, 100 * std::pow(epsilon, 6));
    if (last > 0) EXPECT_NEAR(std::log2(last / error), 6, 0.3);  // orders 1 to 5 are exact
    last = error;
  }
}

TEST(MeanSeries, ForcesAreDerivativesOfTheWork) {
  const WeightedMean mean = make_mean();
  auto u = make_random_motion(3, 0.3);
  const MatrixXd forces = MatrixXd::Random(6, kSeriesTop);
  const auto on_members = MeanSeries(mean, u).calc_forces(kArm, forces);
  // The work on a change δu of order 1: Σ_i F_i δu'_(k-i), linear in δ by central differences.
  const auto change = make_random_motion(3, 1);
  const double step = 1e-5;
  std::vector<MatrixXd> ends;
  for (const double sign : {1., -1.}) {
    auto moved = u;
    for (std::size_t i = 0; i < 3; ++i) moved[i] += sign * step * change[i];
    ends.push_back(MeanSeries(mean, moved).calc_motion(kArm));
  }
  const MatrixXd moved = (ends[0] - ends[1]) / (2 * step);
  for (int order = 2; order <= kSeriesTop; ++order) {
    double of_end = 0, of_members = 0;
    for (int i = 1; i < order; ++i) {
      of_end += forces.col(i - 1).dot(moved.col(order - i - 1));
      for (std::size_t m = 0; m < 3; ++m) of_members += on_members[m].col(i - 1).dot(change[m].col(order - i - 1));
    }
    EXPECT_NEAR(of_members, of_end, 1e-8) << order;
  }
}

/// A finite motion of the members, and what it varies by.
struct FiniteMotion {
  Matrix3Xd u = Matrix3Xd::Random(3, 3);
  std::vector<Matrix3d> R;
  FiniteMotion() {
    for (int i = 0; i < 3; ++i) R.push_back(calc_rotation_exp(Vector3d(1.2, -0.9, 0.4) + 0.6 * Vector3d::Random()));
    const Matrix3d all = calc_rotation_exp(Vector3d(1.2, -0.9, 0.4));
    const WeightedMean mean = make_mean();
    for (std::size_t i = 0; i < 3; ++i)
      u.col(static_cast<Eigen::Index>(i)) =
          0.4 * u.col(static_cast<Eigen::Index>(i)) + (all - Matrix3d::Identity()) * mean.members[i].arm;
  }
  FiniteMotion move(const VectorXd& change) const {
    FiniteMotion moved = *this;
    for (Eigen::Index i = 0; i < 3; ++i) {
      moved.u.col(i) += change.segment<3>(6 * i);
      auto& turned = moved.R[static_cast<std::size_t>(i)];
      turned = calc_rotation_exp(Vector3d(change.segment<3>(6 * i + 3))) * turned;
    }
    return moved;
  }
};

TEST(MeanMotion, IsTheBestFit) {
  const WeightedMean mean = make_mean();
  const FiniteMotion at;
  Matrix3d B = Matrix3d::Zero();
  Vector3d centre = Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto& member = mean.members[static_cast<std::size_t>(i)];
    centre += member.weight / 3.7 * at.u.col(i);
    B += member.weight * (member.arm + at.u.col(i)) * member.arm.transpose() +
         0.5 * member.turn_weight * at.R[static_cast<std::size_t>(i)];
  }
  const Eigen::JacobiSVD<Matrix3d> svd(B, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
  const MeanMotion motion(mean, at.u, at.R);
  EXPECT_GT((R - Matrix3d::Identity()).norm(), 1);
  EXPECT_LT((motion.R() - R).norm(), 1e-13);
  EXPECT_LT((motion.calc_displacement(kArm) - centre - R * kArm + kArm).norm(), 1e-13);
}

/// Central differences of places and rotations, and of the forces on the members.
TEST(MeanMotion, TangentAndSlopeAreDerivatives) {
  const WeightedMean mean = make_mean();
  const FiniteMotion at;
  const MeanMotion motion(mean, at.u, at.R);
  const Vector3d force(3, -2, 1), moment(-0.5, 2, 0.7);
  Eigen::Matrix<double, 6, 1> on_end;
  on_end << force, moment;
  const MatrixXd tangent = motion.calc_tangent(kArm), slope = motion.calc_slope(kArm, force, moment);
  const double step = 1e-6;
  for (Eigen::Index j = 0; j < 18; ++j) {
    const FiniteMotion a = at.move(-step * VectorXd::Unit(18, j)), b = at.move(step * VectorXd::Unit(18, j));
    const MeanMotion before(mean, a.u, a.R), after(mean, b.u, b.R);
    const Vector3d moved = (after.calc_displacement(kArm) - before.calc_displacement(kArm)) / (2 * step);
    const Matrix3d turned = (after.R() - before.R()) / (2 * step) * motion.R().transpose();
    EXPECT_LT((moved - tangent.col(j).head<3>()).norm(), 1e-8) << j;
    EXPECT_LT((turned - skew(tangent.col(j).tail<3>())).norm(), 1e-8) << j;
    const VectorXd change = (after.calc_tangent(kArm) - before.calc_tangent(kArm)).transpose() * on_end / (2 * step);
    EXPECT_LT((change - slope.col(j)).norm(), 1e-7 * (1 + slope.norm())) << j;
  }
  // Without moment there is a potential: by spins its second derivative is symmetric but for the moments on the grids.
  const MatrixXd of_force = motion.calc_slope(kArm, force, Vector3d::Zero());
  const VectorXd on_members = tangent.topRows<3>().transpose() * force;
  MatrixXd skewed = MatrixXd::Zero(18, 18);
  for (Eigen::Index i = 0; i < 3; ++i)
    skewed.block<3, 3>(6 * i + 3, 6 * i + 3) = -skew(on_members.segment<3>(6 * i + 3));
  EXPECT_LT((of_force - of_force.transpose() - skewed).norm(), 1e-12 * of_force.norm());
}

}  // namespace
}  // namespace bough::fe
