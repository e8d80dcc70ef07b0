#include "solver/hinges/hinge.hpp"

#include <gtest/gtest.h>

#include "tests/solver/support/models.hpp"

namespace bough::solver::testing {
namespace {

using records::HingeType;

struct HingeCase {
  HingeType type;
  const char *rotations, *translations;
};

// The name of a test in the list of ctest; else the bytes of the structure.
void PrintTo(const HingeCase& c, std::ostream* out) {
  constexpr const char* kNames[] = {"fixed",  "revolute",  "prismatic", "universal", "cylindrical",
                                    "planar", "spherical", "free",      "screw",     "general"};
  *out << kNames[static_cast<int>(c.type)];
  if (*c.rotations != 0) *out << "_turns_" << c.rotations;
  if (*c.translations != 0) *out << "_moves_" << c.translations;
}

class HingeTest : public ::testing::TestWithParam<HingeCase> {
 protected:
  HingeTest() {
    Random random(17);
    auto record = make_hinge_record("h", GetParam().type, "ground", "b");
    record.rotations = GetParam().rotations;
    record.translations = GetParam().translations;
    record.pitch = 0.7;
    record.axis = random.vector();
    record.axis2 = random.vector();
    Diagnostics diagnostics;
    hinge_ = make_hinge(record, diagnostics);
    q_ = random.vector_n(hinge_->num_q());
    u_ = random.vector_n(hinge_->num_u());
    u_dot_ = random.vector_n(hinge_->num_u());
    if (!hinge_->has_independent_coordinates()) q_.head<4>().normalize();
  }
  HingeMotion motion_at(const VectorXd& q, const VectorXd& u) const {
    HingeMotion m;
    hinge_->calc_motion(q.data(), u.data(), m);
    return m;
  }
  VectorXd q_dot(const VectorXd& q, const VectorXd& u) const {
    VectorXd rate(hinge_->num_q());
    hinge_->calc_q_dot(q.data(), u.data(), rate.data());
    return rate;
  }
  // q after dt with u(t) = u + u̇ t, by Runge-Kutta.
  VectorXd advance(double dt) const {
    const VectorXd half = u_ + 0.5 * dt * u_dot_, end = u_ + dt * u_dot_;
    const VectorXd k1 = q_dot(q_, u_), k2 = q_dot(q_ + 0.5 * dt * k1, half), k3 = q_dot(q_ + 0.5 * dt * k2, half);
    return q_ + dt / 6 * (k1 + 2 * k2 + 2 * k3 + q_dot(q_ + dt * k3, end));
  }
  std::unique_ptr<const Hinge> hinge_;
  VectorXd q_, u_, u_dot_;
  static constexpr double kStep = 1e-4;
};

TEST_P(HingeTest, VelocityIsTheRateOfThePose) {
  const HingeMotion m = motion_at(q_, u_), plus = motion_at(advance(kStep), u_), minus = motion_at(advance(-kStep), u_);
  const Vector6d V = m.H.leftCols(hinge_->num_u()) * u_;
  EXPECT_LT((V.head<3>() - (plus.p_HpHc - minus.p_HpHc) / (2 * kStep)).norm(), 1e-7);
  const Matrix3d R_dot = (plus.R_HpHc - minus.R_HpHc) / (2 * kStep);
  EXPECT_LT((skew(V.tail<3>()) * m.R_HpHc - R_dot).norm(), 1e-7);
}

TEST_P(HingeTest, BiasIsTheRestOfTheAcceleration) {
  auto velocity = [&](double dt) {
    const VectorXd u = u_ + dt * u_dot_;
    return Vector6d(motion_at(advance(dt), u).H.leftCols(hinge_->num_u()) * u);
  };
  const HingeMotion m = motion_at(q_, u_);
  const Vector6d A = m.H.leftCols(hinge_->num_u()) * u_dot_ + m.bias;
  EXPECT_LT((A - (velocity(kStep) - velocity(-kStep)) / (2 * kStep)).norm(), 1e-7);
}

TEST_P(HingeTest, NeutralCoordinatesPutHcOnHp) {
  hinge_->set_neutral(q_.data());
  const HingeMotion m = motion_at(q_, u_);
  EXPECT_LT((m.R_HpHc - Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_EQ(m.p_HpHc, Vector3d::Zero());
}

TEST_P(HingeTest, SpeedsAreIndependent) {
  const HingeMotion m = motion_at(q_, u_);
  if (hinge_->num_u() > 0) {
    Eigen::JacobiSVD<MatrixXd> svd(m.H.leftCols(hinge_->num_u()));
    EXPECT_GT(svd.singularValues().minCoeff(), 1e-2);
  }
}

TEST_P(HingeTest, SpringForceIsTheGradientOfItsEnergy) {
  const int nu = hinge_->num_u();
  Random random(5);
  VectorXd null = random.vector_n(hinge_->num_q());
  if (!hinge_->has_independent_coordinates()) null.head<4>().normalize();
  VectorXd force(nu), unused(nu);
  const VectorXd k = VectorXd::LinSpaced(nu, 1, 3);  // anisotropic
  const double energy = hinge_->calc_spring(q_.data(), null.data(), k.data(), force.data());
  const VectorXd plus = advance(kStep), minus = advance(-kStep);
  const double rate = (hinge_->calc_spring(plus.data(), null.data(), k.data(), unused.data()) -
                       hinge_->calc_spring(minus.data(), null.data(), k.data(), unused.data())) /
                      (2 * kStep);
  EXPECT_NEAR(force.dot(u_), -rate, 1e-7);
  EXPECT_GE(energy, 0);
  EXPECT_NEAR(hinge_->calc_spring(null.data(), null.data(), k.data(), force.data()), 0, 1e-15);
  EXPECT_LT(force.norm(), 1e-15);
}

TEST_P(HingeTest, FileOrderRoundTrips) {
  VectorXd file(hinge_->num_q()), back(hinge_->num_q());
  hinge_->get_for_file(q_.data(), file.data());
  hinge_->set_from_file(file.data(), back.data());
  EXPECT_EQ(back, q_);
  if (!hinge_->has_independent_coordinates()) {
    EXPECT_EQ(file[0], q_[3]);  // w first in files
    EXPECT_EQ(file[1], q_[0]);
  }
}

std::vector<HingeCase> make_cases() {
  std::vector<HingeCase> cases;
  for (const HingeType type : kAllHinges) cases.push_back({type, "", ""});
  cases.push_back({HingeType::Screw, "", ""});
  for (const char* rotations : {"", "y", "xz", "xyz", "zxz", "q"}) {
    for (const char* translations : {"", "y", "zx", "xyz"}) {
      if (*rotations || *translations) cases.push_back({HingeType::General, rotations, translations});
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(AllTypes, HingeTest, ::testing::ValuesIn(make_cases()));

TEST(Hinges, GeneralAxesAreChecked) {
  const auto is_made = [](const std::string& rotations, const std::string& translations) {
    auto record = make_hinge_record("h", HingeType::General, "ground", "b");
    record.rotations = rotations;
    record.translations = translations;
    Diagnostics diagnostics;
    const auto hinge = make_hinge(record, diagnostics);
    EXPECT_EQ(hinge == nullptr, diagnostics.has("system.bad-axes"));
    return hinge != nullptr;
  };
  EXPECT_TRUE(is_made("zxz", "y"));
  EXPECT_FALSE(is_made("", ""));
  EXPECT_FALSE(is_made("xxz", ""));
  EXPECT_FALSE(is_made("xyzx", ""));
  EXPECT_FALSE(is_made("q", "xx"));
  EXPECT_FALSE(is_made("w", ""));
}

HingeMotion calc(HingeType type, const std::vector<double>& q, const Vector3d& axis) {
  auto record = make_hinge_record("h", type, "ground", "b");
  record.axis = axis;
  Diagnostics diagnostics;
  const auto hinge = make_hinge(record, diagnostics);
  const std::vector<double> u(6, 0.0);
  HingeMotion m;
  hinge->calc_motion(q.data(), u.data(), m);
  return m;
}

TEST(Hinges, PlanarWithNormalZMovesAlongXAndY) {
  const HingeMotion m = calc(HingeType::Planar, {2, 3, 0.5}, {0, 0, 4});
  EXPECT_LT((m.p_HpHc - Vector3d(2, 3, 0)).norm(), 1e-15);
  EXPECT_LT((m.R_HpHc * Vector3d::UnitX() - Vector3d(std::cos(0.5), std::sin(0.5), 0)).norm(), 1e-15);
  EXPECT_LT((calc(HingeType::Planar, {2, 3, 0}, {1, 0, 0}).p_HpHc - Vector3d(0, -3, 2)).norm(), 1e-15);
}

TEST(Hinges, RevoluteTurnsByTheRightHandRule) {
  const HingeMotion m = calc(HingeType::Revolute, {0.3}, {0, 2, 0});
  EXPECT_LT((m.R_HpHc * Vector3d::UnitZ() - Vector3d(std::sin(0.3), 0, std::cos(0.3))).norm(), 1e-15);
}

TEST(Hinges, LengthOfTheQuaternionDoesNotMatter) {
  const HingeMotion a = calc(HingeType::Free, {0.1, 0.2, 0.3, 0.4, 5, 6, 7}, Vector3d::UnitZ());
  const HingeMotion b = calc(HingeType::Free, {0.3, 0.6, 0.9, 1.2, 5, 6, 7}, Vector3d::UnitZ());
  EXPECT_LT((a.R_HpHc - b.R_HpHc).norm(), 1e-15);
  EXPECT_LT((a.R_HpHc * a.R_HpHc.transpose() - Matrix3d::Identity()).norm(), 1e-15);
}

TEST(Hinges, EqualSphericalSpringsPullStraightBack) {
  auto record = make_hinge_record("h", HingeType::Spherical, "ground", "b");
  Diagnostics diagnostics;
  const auto hinge = make_hinge(record, diagnostics);
  const Vector3d theta(0.4, -0.9, 1.3);
  const Eigen::Quaterniond q(calc_rotation_exp(theta));
  const Eigen::Vector4d null(0, 0, 0, 1);
  const Vector3d k(2, 2, 2);
  Vector3d torque;
  EXPECT_NEAR(hinge->calc_spring(q.coeffs().data(), null.data(), k.data(), torque.data()), theta.squaredNorm(), 1e-14);
  EXPECT_LT((torque + 2 * theta).norm(), 1e-14);
}

TEST(Hinges, AxesAreChecked) {
  Diagnostics diagnostics;
  auto record = make_hinge_record("h", HingeType::Revolute, "ground", "b");
  record.axis.setZero();
  EXPECT_EQ(make_hinge(record, diagnostics), nullptr);
  EXPECT_TRUE(diagnostics.has("system.zero-axis"));
  record.type = HingeType::Universal;
  record.axis = {0, 0, 1};
  record.axis2 = {0, 0, -2};
  EXPECT_EQ(make_hinge(record, diagnostics), nullptr);
  EXPECT_TRUE(diagnostics.has("system.parallel-axes"));
  EXPECT_EQ(diagnostics.num_errors(), 2);
}

}  // namespace
}  // namespace bough::solver::testing
