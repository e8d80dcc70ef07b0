/// Rotating uniform cantilever from K + Σ A_I K_G1: Wright, Smith, Thresher & Wang, J. Appl. Mech. 49 (1982) 197,
/// recomputed by power series.
#include <gtest/gtest.h>

#include <cmath>

#include "stiffening/reduce.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

/// Unit beam: γ and η are rad/s themselves. Slender enough for Euler-Bernoulli; axial and torsional modes far above.
class RotatingBeam : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    Diagnostics diagnostics;
    const test::Section unit = {1e8, 1e8, 1, 1, 1e-8, 1e-8, 1};
    const auto maker = test::make_cantilever(unit, 1, 80);
    records::BodySpec spec;
    spec.num_modes = 20;
    spec.inertial_loads = {InertialLoad::ax, InertialLoad::wz2};
    body_ = new records::FlexBody(stiffening::reduce(maker.deck, spec, {}, diagnostics).body);
  }
  static void TearDownTestSuite() {
    delete body_;
    body_ = nullptr;
  }

  /// Frequencies of the modes that bend in `axis` (1: in the plane of rotation, 2: out of it), ascending.
  static VectorXd calc_frequencies(double eta, double delta, int axis) {
    std::vector<int> kept;
    for (int j = 0; j < body_->num_modes(); ++j) {
      double own = 0, all = 0;
      for (const auto& phi : body_->phi) {
        own += phi(axis, j) * phi(axis, j);
        all += phi.topRows(3).col(j).squaredNorm();
      }
      if (own > 0.5 * all) kept.push_back(j);
    }
    EXPECT_GE(kept.size(), 8u);
    // Spin about z; the root's centripetal acceleration is -Ω²δL along x.
    const MatrixXd& spin = body_->kg_inertial[static_cast<int>(InertialLoad::wz2)];
    const MatrixXd& pull = body_->kg_inertial[static_cast<int>(InertialLoad::ax)];
    MatrixXd K = body_->modal_stiffness + eta * eta * (spin - delta * pull);
    // Spin softening: the second-order inertia about z, ½ηᵀ Γ4 η Ω².
    for (int j = 0; j < K.rows(); ++j)
      for (int k = 0; k < K.cols(); ++k) K(j, k) -= eta * eta * body_->exact.gamma4[j][k](2, 2);
    const MatrixXd reduced = K(kept, kept);
    return Eigen::SelfAdjointEigenSolver<MatrixXd>(0.5 * (reduced + reduced.transpose())).eigenvalues().cwiseSqrt();
  }

  static records::FlexBody* body_;
};
records::FlexBody* RotatingBeam::body_ = nullptr;

const double kFlap0[12][3] = {
    {3.68165, 22.18101, 61.84176},  {4.13732, 22.61492, 62.27318},  {4.79728, 23.32026, 62.98497},
    {5.58500, 24.27335, 63.96676},  {6.44954, 25.44608, 65.20504},  {7.36037, 26.80908, 66.68391},
    {8.29964, 28.33408, 68.38595},  {9.25684, 29.99538, 70.29296},  {10.22569, 31.77051, 72.38668},
    {11.20233, 33.64037, 74.64929}, {12.18434, 35.58897, 77.06384}, {13.17015, 37.60311, 79.61448}};
const double kChord0[12] = {3.54324, 3.62180, 3.74351, 3.89772, 4.07390, 4.26323,
                            4.45914, 4.65715, 4.85434, 5.04897, 5.24005, 5.42705};
const double kFlap1[12] = {3.88882,  4.83369,  6.08175,  7.47505,  8.94036,  10.44387,
                           11.96907, 13.50739, 15.05408, 16.60636, 18.16255, 19.72154};
const double kChord1[12] = {3.75805, 4.40052,  5.29034,  6.31477,  7.41148,  8.54835,
                            9.70869, 10.88345, 12.06753, 13.25788, 14.45262, 15.65053};

TEST_F(RotatingBeam, FlapHubRadiusZero) {
  for (int i = 0; i < 12; ++i) {
    const VectorXd f = calc_frequencies(i + 1, 0, 2);
    EXPECT_NEAR(f(0) / kFlap0[i][0], 1, 1e-3) << i + 1;
    EXPECT_NEAR(f(1) / kFlap0[i][1], 1, 1e-3) << i + 1;
    EXPECT_NEAR(f(2) / kFlap0[i][2], 1, 2e-3) << i + 1;
  }
}

TEST_F(RotatingBeam, ChordHubRadiusZero) {
  for (int i = 0; i < 12; ++i) {
    const VectorXd f = calc_frequencies(i + 1, 0, 1);
    const double second = std::sqrt(kFlap0[i][1] * kFlap0[i][1] - (i + 1) * (i + 1));
    EXPECT_NEAR(f(0) / kChord0[i], 1, 1e-3) << i + 1;
    EXPECT_NEAR(f(1) / second, 1, 1e-3) << i + 1;
  }
}

/// (η, second flap frequency) at δ = 1.
const double kSecondFlap1[][2] = {{1, 22.37501}, {2, 23.36604}, {6, 32.02724}, {12, 51.07013}};

TEST_F(RotatingBeam, FlapHubRadiusOne) {
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(calc_frequencies(i + 1, 1, 2)(0) / kFlap1[i], 1, 1e-3) << i + 1;
  for (const auto& [eta, expected] : kSecondFlap1)
    EXPECT_NEAR(calc_frequencies(eta, 1, 2)(1) / expected, 1, 5e-3) << eta;
}

TEST_F(RotatingBeam, ChordHubRadiusOne) {
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(calc_frequencies(i + 1, 1, 1)(0) / kChord1[i], 1, 1e-3) << i + 1;
  // Chordwise squared is flapwise squared less η², whatever the hub radius.
  for (const auto& [eta, flap] : kSecondFlap1)
    EXPECT_NEAR(calc_frequencies(eta, 1, 1)(1) / std::sqrt(flap * flap - eta * eta), 1, 5e-3) << eta;
}

}  // namespace
}  // namespace bough
