/// What shells and solids owe, over distorted elements in random orientation: symmetry, rigid motions, rank, mass, K_G,
/// patch tests.
#include <functional>

#include "element_checks.hpp"
#include "fe/elements/solid.hpp"

namespace bough::fe::test {
namespace {

const Matrix3d kR = make_rotation(31);
const Vector3d kOrigin(3, -2, 1);

void add_shell_and_solid(SmallModel& m, double t) {
  add_isotropic(m, t);
  m.deck.psolid.push_back({1, 1, 0, {}});
}

/// drilling: CQUADR or CTRIAR.
void add_shell(SmallModel& m, std::vector<int> grids, double z_offset = 0, bool drilling = false) {
  records::ShellElement e;
  e.id = static_cast<int>(m.deck.shells.size()) + 1, e.pid = 1, e.z_offset = z_offset;
  e.card = grids.size() == 4 ? (drilling ? "CQUADR" : "CQUAD4") : (drilling ? "CTRIAR" : "CTRIA3");
  e.grids = std::move(grids);
  m.deck.shells.push_back(e);
}

/// Points in a local frame become grids 1, 2, ... in a random orientation with random displacement axes.
void add_grids(SmallModel& m, const std::vector<Vector3d>& points) {
  for (const auto& p : points) {
    const int id = m.nodes.num_nodes() + 1;
    m.nodes.add_grid(id, kOrigin + kR * p, make_rotation(static_cast<unsigned>(50 + id)));
  }
}

struct Case {
  std::string name;
  int rank;
  std::function<void(SmallModel&)> fill;
};

void PrintTo(const Case& test, std::ostream* out) { *out << test.name; }

const std::vector<Vector3d> kFlat = {{0, 0, 0}, {1.2, 0.1, 0}, {1.1, 0.9, 0}, {-0.1, 1.1, 0}};
const std::vector<Vector3d> kWarped = {{0, 0, 0.03}, {1.2, 0.1, -0.02}, {1.1, 0.9, 0.04}, {-0.1, 1.1, -0.03}};

Case make_shell_case(const char* name, std::vector<Vector3d> x, double t, double z_offset, bool drilling = false) {
  const int n = static_cast<int>(x.size());
  return {name, 6 * n - 6, [=](SmallModel& m) {
            add_shell_and_solid(m, t);
            add_grids(m, x);
            std::vector<int> grids;
            for (int i = 1; i <= n; ++i) grids.push_back(i);
            add_shell(m, grids, z_offset, drilling);
          }};
}

/// midsides: 0 none, 1 all, 2 some.
void add_solid(SmallModel& m, const char* card, int midsides) {
  const std::string name = card;
  const SolidKind kind = name == "CHEXA" ? SolidKind::Hexa : name == "CPENTA" ? SolidKind::Penta : SolidKind::Tetra;
  std::vector<Vector3d> x;
  if (kind == SolidKind::Hexa)
    x = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  else if (kind == SolidKind::Penta)
    x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  else
    x = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.1, 0.1);
  for (auto& p : x)
    for (double& v : p) v += jitter(random);
  records::SolidElement e;
  e.id = 1, e.pid = 1, e.card = card;
  const int corners = static_cast<int>(x.size());
  for (int i = 1; i <= corners; ++i) e.corners.push_back(i);
  int edge = 0;
  for (const auto& [a, b] : get_edges(kind)) {
    const bool present = midsides == 1 || (midsides == 2 && edge % 3 != 1);
    ++edge;
    if (midsides == 0) break;
    e.midsides.push_back(present ? static_cast<int>(x.size()) + 1 : 0);
    if (present) {
      Vector3d p = (x[static_cast<std::size_t>(a)] + x[static_cast<std::size_t>(b)]) / 2;
      for (double& v : p) v += 0.2 * jitter(random);
      x.push_back(p);
    }
  }
  add_shell_and_solid(m, 1);
  add_grids(m, x);
  m.deck.solids.push_back(e);
}

std::vector<Case> make_shell_cases() {
  const std::vector<Vector3d> tri(kFlat.begin(), kFlat.begin() + 3);
  return {make_shell_case("quad_thick", kFlat, 0.3, 0),
          make_shell_case("quad_thin", kFlat, 1e-3, 0),
          make_shell_case("quad_warped", kWarped, 0.1, 0),
          make_shell_case("quad_warped_offset", kWarped, 0.1, 0.2),
          make_shell_case("tri_thick", tri, 0.3, 0),
          make_shell_case("tri_thin_offset", tri, 1e-2, -0.05),
          make_shell_case("quadr_thick", kFlat, 0.3, 0, true),
          make_shell_case("quadr_warped_offset", kWarped, 0.1, 0.2, true),
          make_shell_case("triar_thick", tri, 0.3, 0, true),
          make_shell_case("triar_thin_offset", tri, 1e-2, -0.05, true),
          {"laminate", 18,
           [](SmallModel& m) {
             add_shell_and_solid(m, 0.1);
             add_grids(m, kFlat);
             m.deck.mat8.push_back({5, 4, 0.4, 0.3, 0.2, 0.2, 0.1, 1.5, {}});
             records::Pcomp p;
             p.id = 2, p.z0 = -0.02, p.plies = {{5, 0.03, 0}, {5, 0.02, 35}, {1, 0.01, 0}};
             m.deck.pcomp.push_back(p);
             add_shell(m, {1, 2, 3, 4});
             m.deck.shells[0].pid = 2, m.deck.shells[0].theta_deg = 20;
           }},
          {"folded_pair", 30, [](SmallModel& m) {
             // Ten degrees between the two: the nodes of the fold get one normal.
             add_shell_and_solid(m, 0.05);
             add_grids(m, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1.98, 0, 0.17}, {1.98, 1, 0.17}});
             add_shell(m, {1, 2, 3, 4});
             add_shell(m, {2, 5, 6, 3});
           }}};
}

std::vector<Case> make_solid_cases() {
  std::vector<Case> cases;
  for (const char* card : {"CHEXA", "CPENTA", "CTETRA"})
    for (int midsides : {0, 1, 2}) {
      const int corners = card[1] == 'H' ? 8 : card[1] == 'P' ? 6 : 4, edges = corners == 8 ? 12 : corners == 6 ? 9 : 6;
      const int absent = (edges + 1) / 3;  // edges 1, 4, 7, ...
      const int nodes = corners + (midsides == 0 ? 0 : midsides == 1 ? edges : edges - absent);
      cases.push_back({std::string(card) + (midsides == 0   ? "_linear"
                                            : midsides == 1 ? "_quadratic"
                                                            : "_mixed"),
                       3 * nodes - 6, [=](SmallModel& m) { add_solid(m, card, midsides); }});
    }
  return cases;
}

SmallModel make_model(const Case& c) {
  SmallModel m;
  c.fill(m);
  m.make();
  return m;
}

class Continua : public testing::TestWithParam<Case> {};

TEST_P(Continua, StiffnessIsSymmetricWithSixRigidMotionsAndNoOther) {
  expect_sound_stiffness(make_model(GetParam()), GetParam().rank);
}

TEST_P(Continua, MassesAgreeInMassAndFirstMoments) {
  const SmallModel m = make_model(GetParam());
  const MatrixXd rigid[2] = {check_mass(m, MassKind::Lumped), check_mass(m, MassKind::Consistent)};
  const double mass = rigid[1](0, 0);
  EXPECT_LT((rigid[0] - rigid[1]).topLeftCorner(3, 3).cwiseAbs().maxCoeff(), 1e-13 * mass);
  EXPECT_LT((rigid[1].topLeftCorner(3, 3) - mass * Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-13 * mass);
  // Scaled diagonals of distorted or quadratic solids keep the mass alone.
  if (GetParam().name[0] != 'C') {
    EXPECT_LT((rigid[0] - rigid[1]).topRows(3).cwiseAbs().maxCoeff(), 1e-12 * rigid[1].cwiseAbs().maxCoeff());
  }
}

TEST_P(Continua, GeometricStiffnessIsSymmetricLinearAndBlindToTranslation) {
  const SmallModel m = make_model(GetParam());
  const VectorXd u = make_random(21, m.nodes.num_gdofs());
  EXPECT_GT(m.calc_geometric_stiffness(u).cwiseAbs().maxCoeff(), 0);
  expect_sound_geometric(m, u);
}

TEST_P(Continua, ThirdDerivativeIsGeometricStiffness) {
  expect_third_derivative_of_geometric(make_model(GetParam()), GetParam().name[0] == 'C' ? 1e-9 : 0.1);
}

TEST_P(Continua, AddsScaledIntoStorage) { expect_scaled_additions(make_model(GetParam())); }

INSTANTIATE_TEST_SUITE_P(Shells, Continua, testing::ValuesIn(make_shell_cases()),
                         [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Solids, Continua, testing::ValuesIn(make_solid_cases()),
                         [](const auto& test) { return test.param.name; });

/// A displacement u = H (x - origin) of the grids, rotations those of H's antisymmetric part.
VectorXd make_linear_field(const SmallModel& m, const Matrix3d& H) {
  VectorXd u(m.nodes.num_gdofs());
  const Matrix3d W = 0.5 * (H - H.transpose());
  for (int k = 0; k < m.nodes.num_nodes(); ++k) {
    u.segment<3>(6 * k) = H * (m.nodes.node(k).x - kOrigin);
    u.segment<3>(6 * k + 3) = Vector3d(W(2, 1), W(0, 2), W(1, 0));
  }
  return u;
}

/// A constant strain gives the exact stresses, the exact energy, and nodal forces that a rigid rotation turns.
TEST(SolidPatch, ConstantStrain) {
  Matrix3d H;
  H << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  for (const Case& c : make_solid_cases()) {
    const SmallModel m = make_model(c);
    const VectorXd u = make_linear_field(m, H);
    const Matrix3d strain = 0.5 * (H + H.transpose());
    const double lambda = 3 * 0.3 / 1.3 / 0.4, G = 3 / 2.6;
    const Matrix3d stress = lambda * strain.trace() * Matrix3d::Identity() + 2 * G * strain;
    const Element& e = *m.elements[0];
    VectorXd u_e(e.num_dofs()), s(e.stress_state()->num_internal_forces());
    for (int i = 0; i < e.num_dofs(); ++i) u_e[i] = u[e.gdofs()[static_cast<std::size_t>(i)]];
    e.stress_state()->calc_internal_forces(u_e, s);
    for (int q = 0; q < s.size(); q += 6) {
      Eigen::Matrix<double, 6, 1> expected;
      expected << stress(0, 0), stress(1, 1), stress(2, 2), stress(0, 1), stress(1, 2), stress(2, 0);
      EXPECT_LT((s.segment<6>(q) - expected).norm(), 1e-12 * expected.norm()) << c.name;
    }
    const MatrixXd K = m.calc_stiffness();
    const double volume = dynamic_cast<const Solid&>(e).calc_volume();
    EXPECT_NEAR(u.dot(K * u) / (volume * (stress.cwiseProduct(strain)).sum()), 1, 1e-12) << c.name;
    const VectorXd f = K * u;
    const MatrixXd K_G = m.calc_geometric_stiffness(u), Phi_R = m.nodes.calc_rigid_modes();
    for (int axis = 0; axis < 3; ++axis) {
      VectorXd expected = VectorXd::Zero(f.size());
      for (int i = 0; i < f.size(); i += 6) expected.segment<3>(i) = Vector3d::Unit(axis).cross(f.segment<3>(i));
      EXPECT_LT((K_G * Phi_R.col(3 + axis) - expected).norm(), 1e-11 * expected.norm()) << c.name;
    }
  }
}

/// The patch of Macneal and Harder (1985): 0.24 x 0.12, five distorted quadrilaterals about four inner grids.
SmallModel make_patch(bool triangles, double t, double shear_ratio = 5.0 / 6, bool drilling = false) {
  SmallModel m;
  add_shell_and_solid(m, t);
  m.deck.pshell[0].shear_ratio = shear_ratio;
  add_grids(m, {{0, 0, 0},
                {0.24, 0, 0},
                {0.24, 0.12, 0},
                {0, 0.12, 0},
                {0.04, 0.02, 0},
                {0.18, 0.03, 0},
                {0.16, 0.08, 0},
                {0.08, 0.08, 0}});
  for (const auto& q :
       std::vector<std::vector<int>>{{1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}, {5, 6, 7, 8}}) {
    if (triangles) {
      add_shell(m, {q[0], q[1], q[2]}, 0, drilling);
      add_shell(m, {q[0], q[2], q[3]}, 0, drilling);
    } else {
      add_shell(m, q, 0, drilling);
    }
  }
  m.make();
  return m;
}

/// The field at a local point: displacement and rotation in local axes.
using Field = std::function<std::pair<Vector3d, Vector3d>(const Vector3d&)>;

VectorXd sample(const SmallModel& m, const Field& field) {
  VectorXd u(m.nodes.num_gdofs());
  for (int k = 0; k < m.nodes.num_nodes(); ++k) {
    const auto [d, r] = field(kR.transpose() * (m.nodes.node(k).x - kOrigin));
    u.segment<3>(6 * k) = kR * d;
    u.segment<3>(6 * k + 3) = kR * r;
  }
  return u;
}

/// Inner grids solve to the field given on the outer four (and on the dofs held).
void expect_patch(const SmallModel& m, const Field& field, double tolerance, const char* what) {
  const VectorXd exact = sample(m, field);
  const MatrixXd K = m.calc_stiffness();
  const MatrixXd inner = K.bottomRightCorner(24, 24);
  const VectorXd solved = inner.ldlt().solve(-K.bottomLeftCorner(24, 24) * exact.head(24));
  EXPECT_LT((solved - exact.tail(24)).norm(), tolerance * exact.norm()) << what;
}

TEST(ShellPatch, MembraneAndBendingOfDistortedElements) {
  for (int kind = 0; kind < 4; ++kind)
    for (double t : {1e-4, 1e-3, 1e-2}) {
      const SmallModel m = make_patch(kind % 2, t, 5.0 / 6, kind > 1);
      const double tolerance = 1e-13 * std::pow(0.24 / t, 2);  // of membrane to bending: the condition of K
      expect_patch(
          m,
          [](const Vector3d& x) {
            return std::pair(Vector3d(1e-3 * (x.x() + 0.8 * x.y()), 1e-3 * (x.y() + 0.2 * x.x()), 0),
                             Vector3d(0, 0, 1e-3 * 0.5 * (0.2 - 0.8)));
          },
          tolerance, "membrane");
      expect_patch(
          m,
          [](const Vector3d& x) {
            const double w = 0.5e-3 * (x.x() * x.x() + x.x() * x.y() + x.y() * x.y());
            return std::pair(Vector3d(0, 0, w),
                             Vector3d(1e-3 * (0.5 * x.x() + x.y()), -1e-3 * (x.x() + 0.5 * x.y()), 0));
          },
          tolerance, "bending");
    }
}

/// A drilling moment is carried: in a plate with true drilling rotations PARAM,K6ROT changes nothing.
TEST(ShellPatch, DrillingRotationsDoNotUseK6rot) {
  for (bool triangles : {false, true})
    for (bool drilling : {false, true}) {
      MatrixXd K[2];
      for (int i = 0; i < 2; ++i) {
        SmallModel m;
        add_shell_and_solid(m, 0.1);
        add_grids(m, kFlat);
        add_shell(m, triangles ? std::vector<int>{1, 2, 3} : std::vector<int>{1, 2, 3, 4}, 0, drilling);
        m.deck.params.push_back({"K6ROT", i ? "1.E6" : "0.", {}});
        m.make();
        K[i] = m.calc_stiffness();
      }
      EXPECT_EQ((K[0] - K[1]).norm() > 1e-6 * K[0].norm(), !drilling);
    }
}

/// Rotations held at zero everywhere and w linear on the outside: where shear is soft (else the sides bend: Kirchhoff)
/// a pure transverse shear, so w is linear inside.
TEST(ShellPatch, TransverseShear) {
  for (bool triangles : {false, true}) {
    const SmallModel m = make_patch(triangles, 0.05, 1e-7);
    const auto field = [](const Vector3d& x) {
      return std::pair(Vector3d(0, 0, 1e-3 * (x.x() - 0.7 * x.y())), Vector3d(0, 0, 0));
    };
    const VectorXd exact = sample(m, field);
    const MatrixXd K = m.calc_stiffness();
    MatrixXd w = MatrixXd::Zero(m.nodes.num_gdofs(), 4);  // the inner deflections
    VectorXd outer = exact;
    for (int k = 4; k < 8; ++k) {
      w.block<3, 1>(6 * k, k - 4) = kR.col(2);
      outer.segment<6>(6 * k).setZero();
    }
    const VectorXd solved = (w.transpose() * K * w).ldlt().solve(-w.transpose() * K * outer);
    EXPECT_LT((solved - w.transpose() * exact).norm(), 1e-6 * exact.norm());
    // γ = ∇w everywhere: energy ½ S γ² A with S = 1e-7 G t.
    const double expected = 0.24 * 0.12 * 1e-7 * (3 / 2.6) * 0.05 * 1e-6 * (1 + 0.49);
    EXPECT_NEAR(exact.dot(K * exact) / expected, 1, 1e-6);
  }
}

/// Under a constant membrane force N the energy of a rigid rotation θ is ∫ N_ab (θ×e_a)·(θ×e_b) dA.
TEST(ShellGeometric, RigidRotationUnderConstantForce) {
  for (bool triangles : {false, true}) {
    const SmallModel m = make_patch(triangles, 0.01);
    const VectorXd u = sample(m, [](const Vector3d& x) {
      return std::pair(Vector3d(2 * x.x() + 0.5 * x.y(), 0.5 * x.x() - x.y(), 0), Vector3d(0, 0, 0));
    });
    const double c = 3 / (1 - 0.09) * 0.01;
    Eigen::Matrix2d N;
    N << c * (2 - 0.3), 3 / 2.6 * 0.01, 3 / 2.6 * 0.01, c * (-1 + 0.6);
    const MatrixXd K_G = m.calc_geometric_stiffness(u), Phi_R = m.nodes.calc_rigid_modes();
    for (int axis = 0; axis < 3; ++axis) {
      double expected = 0;
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b)
          expected += 0.24 * 0.12 * N(a, b) *
                      Vector3d::Unit(axis).cross(Vector3d::Unit(a)).dot(Vector3d::Unit(axis).cross(Vector3d::Unit(b)));
      const VectorXd turn = Phi_R.rightCols<3>() * kR.col(axis);
      EXPECT_NEAR(turn.dot(K_G * turn), expected, 1e-12) << triangles << axis;
    }
  }
}

/// Work of a rigid rotation b on K_G times a rigid rotation a: with f = K u of any state, (b×x)·(a×f) + ½ b·(a×m) over
/// the nodes, in warped, offset, laminated and folded shells too (SNORM 0: leaning normals turn only to first order).
TEST(ShellGeometric, RigidRotationsUnderAnyState) {
  for (const Case& c : make_shell_cases()) {
    SmallModel m;
    c.fill(m);
    m.deck.params.push_back({"K6ROT", "0.", {}});
    m.deck.params.push_back({"SNORM", "0.", {}});
    m.make();
    const int n = m.nodes.num_gdofs();
    const VectorXd u = make_random(6, n), f = m.calc_stiffness() * u;
    const MatrixXd Phi_R = m.nodes.calc_rigid_modes();
    const MatrixXd found = Phi_R.transpose() * m.calc_geometric_stiffness(u) * Phi_R;
    Matrix3d expected = Matrix3d::Zero();
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < n; k += 6) {
        const Vector3d x = m.nodes.node(k / 6).x, axis = Vector3d::Unit(a);
        expected.col(a) += x.cross(axis.cross(f.segment<3>(k))) + 0.5 * axis.cross(Vector3d(f.segment<3>(k + 3)));
      }
    EXPECT_LT((found.bottomRightCorner<3, 3>() - expected).norm(), 1e-10 * f.norm()) << c.name;
    EXPECT_GT(expected.norm(), 1e-3 * f.norm()) << c.name;
  }
}

/// An offset shell is the shell at the offset, joined to its grids by rigid arms w: stiffness, both masses, and K_G
/// with the second order ½ θ×(θ×w) of the arms under the forces of the shell.
TEST(ShellOffset, IsARigidArm) {
  for (int corners : {3, 4})
    for (bool drilling : {false, true}) {
      const std::vector<Vector3d> x(kFlat.begin(), kFlat.begin() + corners);
      const double d = 0.15;
      std::vector<Vector3d> raised = x;
      for (auto& p : raised) p.z() += d;
      const auto make = [&](const char* name, const std::vector<Vector3d>& at, double z_offset) {
        Case c = make_shell_case(name, at, 0.05, z_offset, drilling);
        SmallModel m;
        c.fill(m);
        m.deck.params.push_back({"K6ROT", "0.", {}});  // its forces are not among the internal forces
        m.make();
        return m;
      };
      const SmallModel offset = make("offset", x, d), plain = make("plain", raised, 0);
      MatrixXd T = MatrixXd::Identity(6 * corners, 6 * corners);
      const Vector3d w = d * kR.col(2);
      for (int k = 0; k < corners; ++k) T.block<3, 3>(6 * k, 6 * k + 3) = -skew(w);
      const auto expect_equal = [&](const MatrixXd& a, const MatrixXd& b, const char* what) {
        EXPECT_LT((a - b).norm(), 1e-12 * a.norm()) << what;
      };
      expect_equal(offset.calc_stiffness(), T.transpose() * plain.calc_stiffness() * T, "stiffness");
      for (MassKind kind : {MassKind::Lumped, MassKind::Consistent})
        expect_equal(offset.calc_mass(kind), T.transpose() * plain.calc_mass(kind) * T, "mass");
      const VectorXd u = make_random(3, 6 * corners);
      VectorXd f = plain.calc_stiffness() * (T * u);
      MatrixXd expected = T.transpose() * plain.calc_geometric_stiffness(T * u) * T;
      for (int k = 0; k < corners; ++k) {
        const Vector3d force = f.segment<3>(6 * k);
        const Matrix3d fw = force * w.transpose();
        expected.block<3, 3>(6 * k + 3, 6 * k + 3) += 0.5 * (fw + fw.transpose()) - force.dot(w) * Matrix3d::Identity();
      }
      expect_equal(offset.calc_geometric_stiffness(u), expected, "geometric");
    }
}

/// Mass, centre and inertia of a square plate under rigid motion, exactly those of the body.
TEST(ShellMass, RigidBodyIsExact) {
  const SmallModel m = make_model(make_shell_case("square", {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, 0.2, 0));
  const double mass = 2 * (0.8 * 0.2 + 0.1), rotary = 2 * 0.8 * 0.008 / 12;
  MatrixXd local = MatrixXd::Zero(24, 6);  // rigid motions about the corner in local axes
  for (int k = 0; k < 4; ++k) {
    const Vector3d p = m.nodes.node(k).x - kOrigin;
    local.block<3, 3>(6 * k, 0) = kR;
    local.block<3, 3>(6 * k, 3) = -skew(p) * kR;
    local.block<3, 3>(6 * k + 3, 3) = kR;
  }
  const MatrixXd rigid = local.transpose() * m.calc_mass(MassKind::Consistent) * local;
  Eigen::Matrix<double, 6, 6> expected = Eigen::Matrix<double, 6, 6>::Zero();
  expected.topLeftCorner<3, 3>() = mass * Matrix3d::Identity();
  expected.bottomLeftCorner<3, 3>() = mass * skew(Vector3d(1, 0.5, 0));
  expected.topRightCorner<3, 3>() = expected.bottomLeftCorner<3, 3>().transpose();
  expected(3, 3) = mass / 3 + rotary, expected(4, 4) = mass * 4 / 3 + rotary, expected(5, 5) = mass * 5 / 3;
  expected(3, 4) = expected(4, 3) = -mass / 2;
  EXPECT_LT((rigid - expected).norm(), 1e-13 * expected.norm()) << rigid;
}

}  // namespace
}  // namespace bough::fe::test
