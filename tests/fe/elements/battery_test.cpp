/// What every element owes, over every kind of element in a random orientation: symmetry, rigid motions, mass, K_G.
#include <functional>

#include "element_checks.hpp"

namespace bough::fe::test {
namespace {

using records::BeamElement;

struct Case {
  std::string name;
  int rank;  ///< of K
  bool has_mass;
  std::function<void(SmallModel&)> fill;
};

void PrintTo(const Case& test, std::ostream* out) { *out << test.name; }

void add_conrod(SmallModel& m) { m.deck.conrod.push_back({5, 1, 2, 1, 0.4, 0.02, 0, 0.1, {}}); }

void add_pbar(SmallModel& m, double I12, bool shear) {
  records::Pbar p;
  p.id = 9, p.mid = 1, p.A = 0.5, p.I1 = 0.04, p.I2 = 0.07, p.I12 = I12, p.J = 0.05, p.nsm = 0.3;
  if (shear) p.k1 = 0.8, p.k2 = 0.6;
  m.deck.pbar.push_back(p);
}

void add_pbeam(SmallModel& m) {
  records::Pbeam p;
  p.id = 9, p.mid = 1;
  p.stations.resize(3);
  for (std::size_t k = 0; k < 3; ++k) {
    const double f = 1 - 0.25 * static_cast<double>(k);
    auto& s = p.stations[k];
    s.x_over_L = std::array{0.0, 0.4, 1.0}[k];
    s.A = 0.5 * f, s.I1 = 0.04 * f * f, s.I2 = 0.07 * f * f, s.I12 = 0.01 * f * f, s.J = 0.05 * f * f, s.nsm = 0.2 * f;
  }
  p.nsi_a = 0.05, p.nsi_b = 0.02;
  p.n1_a = 0.1, p.n2_a = -0.15, p.n1_b = 0.05, p.n2_b = 0.02;
  p.m1_a = -0.1, p.m2_a = 0.05, p.m1_b = 0.2, p.m2_b = 0.1;
  m.deck.pbeam.push_back(p);
}

std::vector<Case> make_cases() {
  const auto offsets = [](BeamElement e) {
    e.wa = Vector3d(0.2, 0.3, -0.1), e.wb = Vector3d(-0.3, 0.1, 0.25);
    return e;
  };
  return {
      {"bar", 6, true, [](SmallModel& m) { add_pbar(m, 0, false), m.deck.beams.push_back(make_beam(false)); }},
      {"bar_shear_offset", 6, true,
       [=](SmallModel& m) { add_pbar(m, 0, true), m.deck.beams.push_back(offsets(make_beam(false))); }},
      {"bar_unsymmetric_element_offset", 6, true,
       [=](SmallModel& m) {
         add_pbar(m, 0.02, false);
         BeamElement e = offsets(make_beam(false));
         e.offt = "BOG";
         m.deck.beams.push_back(e);
       }},
      {"bar_pinned", 3, true,
       [=](SmallModel& m) {
         add_pbar(m, 0, true);
         BeamElement e = offsets(make_beam(false));
         e.pin_a = 0b110000, e.pin_b = 0b001000;
         m.deck.beams.push_back(e);
       }},
      {"bar_one_plane", 4, true,
       [](SmallModel& m) {
         add_pbar(m, 0, true), m.deck.pbar.back().I2 = 0;
         m.deck.beams.push_back(make_beam(false));
       }},
      {"beam_tapered_offset", 6, true,
       [=](SmallModel& m) { add_pbeam(m), m.deck.beams.push_back(offsets(make_beam(true))); }},
      {"beam_library", 6, true,
       [](SmallModel& m) {
         auto& p = m.deck.pbeaml.emplace_back();
         p.id = 9, p.mid = 1, p.shape = "L";
         p.stations = {{0, {0.6, 0.8, 0.1, 0.12}, 0.1}, {1, {0.4, 0.5, 0.1, 0.12}, 0.1}};
         m.deck.beams.push_back(make_beam(true));
       }},
      {"rod", 2, true,
       [](SmallModel& m) {
         m.deck.prod.push_back({9, 1, 0.4, 0.02, 0, 0.1, {}});
         m.deck.crod.push_back({5, 9, 1, 2, {}});
       }},
      {"conrod", 2, true, [](SmallModel& m) { add_conrod(m); }},
      {"tube_tapered", 2, true,
       [](SmallModel& m) {
         m.deck.ptube.push_back({9, 1, 0.5, 0.1, 0.2, 0.3, {}});
         m.deck.ctube.push_back({5, 9, 1, 2, {}});
       }},
      {"bush", 6, true,
       [](SmallModel& m) {
         records::Pbush p;
         p.id = 9, p.k = {1, 2, 3, 0.4, 0.5, 0.6}, p.mass = 2;
         m.deck.pbush.push_back(p);
         records::Cbush e;
         e.id = 5, e.pid = 9, e.ga = 1, e.gb = 2, e.cid = 7, e.ocid = 7, e.s_offset = Vector3d(0.1, 0.2, 0.3);
         m.deck.cbush.push_back(e);
       }},
      {"point_mass", 0, true,
       [](SmallModel& m) {
         records::Conm2 e;
         e.id = 5, e.g = 1, e.cid = 7, e.m = 2, e.x = Vector3d(0.1, -0.2, 0.4), e.inertia = {3, 0.1, 2, -0.2, 0.3, 4};
         m.deck.conm2.push_back(e);
       }},
  };
}

SmallModel make_model(const Case& c) {
  SmallModel m;
  add_two_grids(m);
  add_line_material(m);
  c.fill(m);
  m.make();
  return m;
}

class Battery : public testing::TestWithParam<Case> {};

TEST_P(Battery, StiffnessIsSymmetricAndFreeOfRigidMotion) {
  expect_sound_stiffness(make_model(GetParam()), GetParam().rank, 1e-11);
}

TEST_P(Battery, MassIsSymmetricAndSemidefinite) {
  const SmallModel m = make_model(GetParam());
  MatrixXd rigid[2];
  for (MassKind kind : {MassKind::Lumped, MassKind::Consistent}) {
    ASSERT_EQ(m.calc_mass(kind).cwiseAbs().maxCoeff() > 0, GetParam().has_mass);
    rigid[kind == MassKind::Lumped ? 0 : 1] = check_mass(m, kind);
  }
  // Mass and first moments of the two agree; the same mass in every direction.
  EXPECT_LT((rigid[0] - rigid[1]).topRows<3>().cwiseAbs().maxCoeff(), 1e-13 * rigid[0].cwiseAbs().maxCoeff());
  EXPECT_LT((rigid[1].topLeftCorner<3, 3>() - rigid[1](0, 0) * Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-13);
}

TEST_P(Battery, GeometricStiffnessTurnsTheNodalForces) {
  const SmallModel m = make_model(GetParam());
  const int n = m.nodes.num_gdofs();
  const VectorXd u = make_random(21, n);
  expect_sound_geometric(m, u);
  if (!m.elements.front()->stress_state()) return;
  const VectorXd f = m.calc_stiffness() * u;
  const MatrixXd turned = m.calc_geometric_stiffness(u) * m.nodes.calc_rigid_modes().rightCols<3>();
  for (int axis = 0; axis < 3; ++axis) {
    const VectorXd expected = turn_forces(Vector3d::Unit(axis), f);
    EXPECT_LT((turned.col(axis) - expected).norm(), 1e-11 * expected.norm()) << axis;
  }
}

TEST_P(Battery, ThirdDerivativeIsGeometricStiffness) { expect_third_derivative_of_geometric(make_model(GetParam())); }

TEST_P(Battery, AddsScaledIntoStorage) { expect_scaled_additions(make_model(GetParam())); }

INSTANTIATE_TEST_SUITE_P(Elements, Battery, testing::ValuesIn(make_cases()),
                         [](const auto& test) { return test.param.name; });

/// The consistent mass under rigid motion is the body itself: sliced finely, each slice a small rigid body.
TEST(BeamMass, RigidBodyIsExact) {
  for (const Case& c : make_cases()) {
    if (c.name != "beam_tapered_offset" && c.name != "bar_shear_offset" && c.name != "bar_pinned") continue;
    const SmallModel m = make_model(c);
    const bool is_cbeam = c.name == "beam_tapered_offset";
    const Vector3d a = kPointA + make_rotation(11) * Vector3d(0.2, 0.3, -0.1),
                   b = kPointB + make_rotation(12) * Vector3d(-0.3, 0.1, 0.25);
    const Vector3d ex = (b - a).normalized(), ez = ex.cross(make_rotation(11) * Vector3d(0.2, 1, -0.3)).normalized();
    Matrix3d R;
    R << ex, ez.cross(ex), ez;
    const int num_slices = 20000;
    Eigen::Matrix<double, 6, 6> expected = Eigen::Matrix<double, 6, 6>::Zero();
    const auto add = [&](double mass, const Vector3d& p, const Matrix3d& I) {
      expected.topLeftCorner<3, 3>() += mass * Matrix3d::Identity();
      expected.topRightCorner<3, 3>() -= mass * skew(p);
      expected.bottomLeftCorner<3, 3>() += mass * skew(p);
      expected.bottomRightCorner<3, 3>() += R * I * R.transpose() - mass * skew(p) * skew(p);
    };
    const double ds = (b - a).norm() / num_slices;
    for (int k = 0; k < num_slices; ++k) {
      const double t = (k + 0.5) / num_slices;
      const Vector3d p = a + t * (b - a);
      if (!is_cbeam) {
        add((0.8 * 0.5 + 0.3) * ds, p, Matrix3d::Zero());
        continue;
      }
      const double r = t < 0.4 ? t / 0.4 : (t - 0.4) / 0.6;  // stations at 0, 0.4, 1 with factors 1, 0.75, 0.5
      const double f0 = t < 0.4 ? 1 : 0.75, f1 = t < 0.4 ? 0.75 : 0.5;
      const double f = f0 + r * (f1 - f0), ff = f0 * f0 + r * (f1 * f1 - f0 * f0);
      Matrix3d I = Matrix3d::Zero();
      I(0, 0) = 0.8 * (0.04 + 0.07) * ff, I(1, 1) = 0.8 * 0.07 * ff, I(2, 2) = 0.8 * 0.04 * ff;
      I(1, 2) = I(2, 1) = -0.8 * 0.01 * ff;
      const Vector3d n(0, 0.1 + t * (0.05 - 0.1), -0.15 + t * (0.02 + 0.15));
      const Vector3d q(0, -0.1 + t * 0.3, 0.05 + t * 0.05);
      add(0.8 * 0.5 * f * ds, p + R * n, I * ds);
      Matrix3d nsi = Matrix3d::Zero();
      nsi(0, 0) = 0.05 - 0.03 * t;
      add(0.2 * f * ds, p + R * q, nsi * ds);
    }
    const MatrixXd Phi_R = m.nodes.calc_rigid_modes();
    const MatrixXd rigid = Phi_R.transpose() * m.calc_mass(MassKind::Consistent) * Phi_R;
    EXPECT_LT((rigid - expected).norm(), 1e-8 * expected.norm()) << c.name << "\n" << rigid << "\n\n" << expected;
  }
}

}  // namespace
}  // namespace bough::fe::test
