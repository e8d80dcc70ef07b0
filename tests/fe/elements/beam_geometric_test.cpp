/// K_G of a beam against the second derivative of the work of given section forces on exact finite strains.
#include "small_model.hpp"

namespace bough::fe::test {
namespace {

using Vector12d = Eigen::Matrix<double, 12, 1>;

constexpr double kL = 1.3, kA = 0.4, kI1 = 0.02, kI2 = 0.05;

/// Hermite field of an Euler-Bernoulli element: [u v w θx θy θz] at x, written out by hand.
Eigen::Matrix<double, 6, 1> calc_field(const Vector12d& q, double x) {
  const double t = x / kL;
  const double h0 = 1 - 3 * t * t + 2 * t * t * t, h1 = kL * t * (1 - t) * (1 - t), h2 = 3 * t * t - 2 * t * t * t,
               h3 = kL * t * t * (t - 1);
  const double d0 = (6 * t * t - 6 * t) / kL, d1 = 1 - 4 * t + 3 * t * t, d3 = 3 * t * t - 2 * t;
  Eigen::Matrix<double, 6, 1> f;
  f[0] = (1 - t) * q[0] + t * q[6];
  f[1] = h0 * q[1] + h1 * q[5] + h2 * q[7] + h3 * q[11];
  f[2] = h0 * q[2] - h1 * q[4] + h2 * q[8] - h3 * q[10];
  f[3] = (1 - t) * q[3] + t * q[9];
  f[4] = -(d0 * q[2] - d1 * q[4] - d0 * q[8] - d3 * q[10]);
  f[5] = d0 * q[1] + d1 * q[5] - d0 * q[7] + d3 * q[11];
  return f;
}

/// Work of constant N V T and linear M on the exact strains: Green's for N (with Wagner's ½ r0² κx²), the director
/// strains r'·R e_y, r'·R e_z for the shears, and the curvature RᵀR' for the moments.
double calc_work(const Vector12d& q, const VectorXd& force) {
  const int num_slices = 200;
  const double h = 1e-5 * kL;
  double work = 0;
  for (int k = 0; k < num_slices; ++k) {
    const double x = kL * (k + 0.5) / num_slices, t = x / kL;
    const Eigen::Matrix<double, 6, 1> f = calc_field(q, x),
                                      slope = (calc_field(q, x + h) - calc_field(q, x - h)) / (2 * h);
    const Matrix3d R = calc_rotation_exp(f.tail<3>());
    const Vector3d r = Vector3d::UnitX() + slope.head<3>();
    const Vector3d kappa = R.transpose() * (calc_rotation_tangent(f.tail<3>()) * slope.tail<3>());
    const double r2 = (kI1 + kI2) / kA;
    double density = force[0] * (0.5 * (r.squaredNorm() - 1) + 0.5 * r2 * kappa[0] * kappa[0]);
    density += force[1] * r.dot(R.col(1)) + force[2] * r.dot(R.col(2)) + force[3] * kappa[0];
    density += ((1 - t) * force[4] + t * force[6]) * kappa[1] + ((1 - t) * force[5] + t * force[7]) * kappa[2];
    work += density * kL / num_slices;
  }
  return work;
}

TEST(BeamGeometricStiffness, IsTheSecondDerivativeOfFiniteStrainWork) {
  ChainOptions options;
  options.num_elements = 1;
  options.length = kL;
  options.section.A = kA, options.section.I1 = kI1, options.section.I2 = kI2, options.section.J = 0.03;
  const SmallModel model = make_bar_chain(options);
  std::mt19937 random(31);
  std::normal_distribution<double> normal;
  for (int component = 0; component < 8; ++component) {
    const VectorXd force = VectorXd::Unit(8, component);
    MatrixXd K_G = MatrixXd::Zero(12, 12);
    model.elements[0]->stress_state()->add_geometric_stiffness(force, 1, K_G);
    for (int trial = 0; trial < 3; ++trial) {
      Vector12d q;
      for (double& value : q) value = normal(random);
      // N does no second-order work on a stretch in K_G (u'² is left out beside 1): compare without stretch.
      if (component == 0) q[6] = q[0];
      // Three points and five combined: error of order step⁴.
      const auto second = [&](double e) {
        return (calc_work(e * q, force) - 2 * calc_work(0 * q, force) + calc_work(-e * q, force)) / (e * e);
      };
      const double expected = (4 * second(0.01) - second(0.02)) / 3;
      EXPECT_NEAR(q.dot(K_G * q), expected, 1e-4 * q.squaredNorm() * K_G.norm()) << component;
    }
  }
}

}  // namespace
}  // namespace bough::fe::test
