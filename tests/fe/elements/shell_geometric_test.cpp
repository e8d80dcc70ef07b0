/// K_G of shells by moments and transverse shears: a rigid rotation turns the nodal forces and moments; the Hessian of
/// the strains of a finitely rotated element, by differences.
#include "element_checks.hpp"
#include "fe/elements/shell.hpp"

namespace bough::fe::test {
namespace {

const std::vector<Vector3d> kCorners = {{0, 0, 0}, {1.2, 0.1, 0}, {1.1, 0.9, 0}, {-0.1, 1.1, 0}};

/// One element in its own plane, in basic axes.
SmallModel make_element(const char* card, double t, bool shear, double z_offset = 0, const char* k6rot = "0.") {
  SmallModel m;
  records::Mat1 material;
  material.id = 1, material.E = 3, material.nu = 0.3, material.G = 3 / 2.6;
  m.deck.mat1.push_back(material);
  records::Pshell p;
  p.id = 1, p.mid1 = p.mid2 = 1, p.mid3 = shear ? 1 : 0, p.t = t;
  m.deck.pshell.push_back(p);
  records::ShellElement e;
  e.id = e.pid = 1, e.card = card, e.z_offset = z_offset;
  for (int i = 1; i <= (card[1] == 'Q' ? 4 : 3); ++i) {
    m.nodes.add_grid(i, kCorners[static_cast<std::size_t>(i - 1)]);
    e.grids.push_back(i);
  }
  m.deck.shells.push_back(e);
  m.deck.params.push_back({"K6ROT", k6rot, {}});
  m.make();
  return m;
}

Eigen::Matrix3d make_law() {
  const double c = 3 / 0.91;
  return (Eigen::Matrix3d() << c, 0.3 * c, 0, 0.3 * c, c, 0, 0, 0, 3 / 2.6).finished();
}

/// With f = K u and a rigid rotation θ: K_G θ = θ×f for forces, ½ θ×m for moments (semitangential), as of the beams.
TEST(ShellGeometric, RigidRotationTurnsShearsAndMoments) {
  for (const char* card : {"CQUAD4", "CTRIA3", "CQUADR", "CTRIAR"})
    for (bool shear : {false, true}) {
      const SmallModel m = make_element(card, 0.2, shear);
      const int n = m.nodes.num_gdofs();
      VectorXd u = make_random(4, n);
      for (int i = 0; i < n; i += 6) u[i] = u[i + 1] = u[i + 5] = 0;  // bending alone
      const VectorXd f = m.calc_stiffness() * u;
      const MatrixXd K_G = m.calc_geometric_stiffness(u), Phi_R = m.nodes.calc_rigid_modes();
      for (int axis = 0; axis < 3; ++axis) {
        const VectorXd expected = turn_forces(Vector3d::Unit(axis), f);
        EXPECT_LT((K_G * Phi_R.col(3 + axis) - expected).norm(), 1e-11 * f.norm()) << card << shear << axis;
      }
    }
}

/// The forces of the drilling penalty turn too, with the arms of an offset surface: a moment about the normal of a
/// plate is in equilibrium.
TEST(ShellGeometric, RigidRotationTurnsDrillingMoments) {
  for (const char* card : {"CQUAD4", "CTRIA3"})
    for (double z : {0.0, 0.15}) {
      const SmallModel m = make_element(card, 0.2, true, z, "100.");
      const int n = m.nodes.num_gdofs();
      const VectorXd random = make_random(4, n);
      VectorXd u = VectorXd::Zero(n);
      for (int i = 5; i < n; i += 6) u[i] = random[i];  // about the normal alone: no strain
      const VectorXd f = m.calc_stiffness() * u;
      ASSERT_GT(f.norm(), 0);
      const MatrixXd K_G = m.calc_geometric_stiffness(u), Phi_R = m.nodes.calc_rigid_modes();
      for (int axis = 0; axis < 3; ++axis) {
        const VectorXd expected = turn_forces(Vector3d::Unit(axis), f);
        EXPECT_LT((K_G * Phi_R.col(3 + axis) - expected).norm(), 1e-11 * f.norm()) << card << z << axis;
      }
    }
}

/// With drilling rotations each corner has its own moment about the normal, that of K u, and a rigid rotation turns it
/// by half. (The forces in the plane vary then, and the bending slopes share them out: RigidRotationsUnderAnyState.)
TEST(ShellGeometric, RigidRotationTurnsMomentsOfDrillingRotations) {
  for (const char* card : {"CQUADR", "CTRIAR"}) {
    const SmallModel m = make_element(card, 0.2, true);
    const auto& element = *m.elements[0]->stress_state();
    const int n = m.nodes.num_gdofs(), num_points = n / 6;
    VectorXd u = make_random(5, n);
    for (int i = 0; i < n; i += 6) u.segment<3>(i + 2).setZero();
    const VectorXd f = m.calc_stiffness() * u;
    VectorXd force = VectorXd::Zero(element.num_internal_forces());
    element.calc_internal_forces(u, force);
    for (int i = 0; i < num_points; ++i) EXPECT_NEAR(force[8 * num_points + i], f[6 * i + 5], 1e-12 * f.norm()) << card;
    force.head(8 * num_points).setZero();
    MatrixXd K_G = MatrixXd::Zero(n, n);
    element.add_geometric_stiffness(force, 1, K_G);
    const MatrixXd Phi_R = m.nodes.calc_rigid_modes();
    for (int axis = 0; axis < 3; ++axis) {
      const VectorXd turned = K_G * Phi_R.col(3 + axis);
      for (int i = 0; i < num_points; ++i) {
        const Vector3d expected = 0.5 * f[6 * i + 5] * Vector3d::Unit(axis).cross(Vector3d::UnitZ());
        EXPECT_LT((turned.segment<3>(6 * i + 3) - expected).norm(), 1e-12 * f.norm()) << card << axis;
      }
    }
  }
}

/// Work of given M, drilling moments and T (per side, on its mean shear) on the nonlinear strains of the element at q:
/// curvature ½(r,a·d,b + r,b·d,a) of directors exp(θ) n between the corners, shear (r_j - r_i)/L·½(d_i + d_j) of the
/// sides with the curvature of the side's bump; r is the surface, at the end of the arm exp(θ) z n of each corner.
template <int N>
double calc_work(const shell::Points<N>& points, const shell::Plate<N>& plate, const shell::Corners<N>& xy, double z,
                 const VectorXd& force, const VectorXd& q) {
  Eigen::Matrix<double, 3, N> r, d, d_x, d_y;
  for (int i = 0; i < N; ++i) {
    const Vector3d theta = q.segment<3>(6 * i + 3);
    const double angle = theta.norm();
    const Eigen::Matrix3d turn =
        angle > 0 ? Eigen::Matrix3d(Eigen::AngleAxisd(angle, theta / angle)) : Eigen::Matrix3d::Identity();
    d_x.col(i) = turn.col(0), d_y.col(i) = turn.col(1), d.col(i) = turn.col(2);
    r.col(i) = Vector3d(xy(0, i), xy(1, i), -z) + q.segment<3>(6 * i) + z * d.col(i);
  }
  double work = 0;
  for (int k = 0; k < N; ++k) {
    const auto& side = plate.sides[k];
    const double shear = (r.col(side.j) - r.col(side.i)).dot(d.col(side.i) + d.col(side.j)) / (2 * side.length);
    for (int p = 0; p < N; ++p)
      work += points[p].weight * shear *
              (plate.side_bending[k][p].dot(force.segment<3>(8 * p + 3)) +
               plate.side_shear[k][p].dot(force.segment<2>(8 * p + 6)));
  }
  for (int p = 0; p < N; ++p) {
    const Eigen::Matrix<double, 3, 2> dr = r * points[p].dshape.transpose(), dd = d * points[p].dshape.transpose();
    work +=
        points[p].weight * (force[8 * p + 3] * dr.col(0).dot(dd.col(0)) + force[8 * p + 4] * dr.col(1).dot(dd.col(1)) +
                            force[8 * p + 5] * (dr.col(0).dot(dd.col(1)) + dr.col(1).dot(dd.col(0))));
    // The triads' own axes against the surface's: ½ (x'·r,y - y'·r,x), zero in a rigid rotation.
    work += points[p].weight * force[8 * N + p] / 2 *
            ((d_x * points[p].shape).dot(dr.col(1)) - (d_y * points[p].shape).dot(dr.col(0)));
  }
  return work;
}

template <int N>
void expect_hessian(const char* card, double z) {
  const SmallModel m = make_element(card, 0.2, true, z);
  const auto& e = *m.elements[0];
  VectorXd force = make_random(8, e.stress_state()->num_internal_forces());
  for (int p = 0; p < N; ++p) force.segment<3>(8 * p).setZero();
  MatrixXd K_G = MatrixXd::Zero(6 * N, 6 * N);
  e.stress_state()->add_geometric_stiffness(force, 1, K_G);
  // In the element's axes; the section as the maker makes it (MAT1, 5/6 G t).
  ShellSection section;
  section.S = 5.0 / 6 * 0.2 * 3 / 2.6 * Eigen::Matrix2d::Identity();
  section.D = 0.008 / 12 * make_law();
  const Matrix3d R = dynamic_cast<const Shell&>(e).R_basic_element();
  Vector3d centre = Vector3d::Zero();
  for (int i = 0; i < N; ++i) centre += kCorners[static_cast<std::size_t>(i)] / N;
  shell::Corners<N> xy;
  for (int i = 0; i < N; ++i)
    xy.col(i) = (R.transpose() * (kCorners[static_cast<std::size_t>(i)] - centre)).template head<2>();
  const auto points = shell::calc_points<N>(xy);
  const auto plate = shell::calc_plate<N>(xy, points, section);
  MatrixXd turn = MatrixXd::Zero(6 * N, 6 * N);
  for (int i = 0; i < 2 * N; ++i) turn.block<3, 3>(3 * i, 3 * i) = R;
  const auto work = [&](const VectorXd& q) { return calc_work<N>(points, plate, xy, z, force, q); };
  const double h = 1e-3;
  MatrixXd expected(6 * N, 6 * N);
  for (int i = 0; i < 6 * N; ++i)
    for (int j = 0; j <= i; ++j) {
      const VectorXd a = h * VectorXd::Unit(6 * N, i), b = h * VectorXd::Unit(6 * N, j);
      expected(i, j) = expected(j, i) = (work(a + b) - work(a - b) - work(b - a) + work(-a - b)) / (4 * h * h);
    }
  EXPECT_LT((turn.transpose() * K_G * turn - expected).norm(), 3e-6 * expected.norm()) << card << " " << z;
}

TEST(ShellGeometric, IsTheHessianOfFinitelyRotatedStrains) {
  for (double z : {0.0, 0.15}) {
    expect_hessian<4>("CQUAD4", z);
    expect_hessian<3>("CTRIA3", z);
  }
}

}  // namespace
}  // namespace bough::fe::test
