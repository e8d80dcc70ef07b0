/// What CQUAD8 and CTRIA6 owe: symmetry, rigid motions, rank, mass, K_G, patch tests, material axes.
#include <functional>

#include "element_checks.hpp"
#include "fe/elements/curved_shell.hpp"

namespace bough::fe::test {
namespace {

const Matrix3d kR = make_rotation(31);
const Vector3d kOrigin(3, -2, 1);

struct Case {
  std::string name;
  std::vector<Vector3d> corners;
  double t = 0.1, z_offset = 0;
  double bow = 0;  ///< a paraboloid of this height over the unit square
  std::vector<char> absent = {};
  bool laminate = false, has_corner_thickness = false, triangle = false;
};

void PrintTo(const Case& test, std::ostream* out) { *out << test.name; }

const std::vector<Vector3d> kCorners = {{0, 0, 0}, {1.2, 0.1, 0}, {1.1, 0.9, 0}, {-0.1, 1.1, 0}};

void add_shell_and_laminate(SmallModel& m, double t) {
  add_isotropic(m, t);
  m.deck.mat8.push_back({5, 4, 0.4, 0.3, 0.2, 0.2, 0.1, 1.5, {}});
  records::Pcomp c;
  c.id = 2, c.z0 = -0.02, c.plies = {{5, 0.03, 0}, {5, 0.02, 35}, {1, 0.01, 0}};
  m.deck.pcomp.push_back(c);
}

int add_grid(SmallModel& m, const Vector3d& local) {
  const int id = m.nodes.num_nodes() + 1;
  return m.nodes.add_grid(id, kOrigin + kR * local, make_rotation(static_cast<unsigned>(50 + id))) + 1;
}

SmallModel make_model(const Case& c, const char* k6rot = "100.") {
  SmallModel m;
  m.deck.params.push_back({"K6ROT", k6rot, {}});
  add_shell_and_laminate(m, c.t);
  const auto place = [&](Vector3d p) {
    p.z() += c.bow * (p.x() * (1 - p.x()) + 0.6 * p.y() * (1 - p.y()) + 0.3 * p.x() * p.y());
    return p;
  };
  records::ShellElement e;
  e.id = 1, e.pid = c.laminate ? 2 : 1, e.z_offset = c.z_offset, e.theta_deg = 20;
  const std::size_t n = c.triangle ? 3 : 4;
  e.card = n == 4 ? "CQUAD8" : "CTRIA6";
  for (std::size_t i = 0; i < n; ++i) e.grids.push_back(add_grid(m, place(c.corners[i])));
  for (std::size_t i = 0; i < n; ++i)
    e.midsides.push_back(
        i < c.absent.size() && c.absent[i] ? 0 : add_grid(m, place((c.corners[i] + c.corners[(i + 1) % n]) / 2)));
  if (c.has_corner_thickness) e.t = {0.1, 0.12, 0.15, 0.11}, e.t.resize(n);
  m.deck.shells.push_back(e);
  m.make();
  return m;
}

std::vector<Case> make_cases() {
  std::vector<Case> cases;
  for (bool tri : {false, true}) {
    const std::string card = tri ? "tri_" : "quad_";
    const auto add = [&](const char* name, Case c) {
      c.name = card + name;
      c.triangle = tri;
      c.corners = kCorners;
      cases.push_back(c);
    };
    add("thick", {.name = {}, .corners = {}, .t = 0.3});
    add("thin", {.name = {}, .corners = {}, .t = 1e-3});
    add("offset", {.name = {}, .corners = {}, .z_offset = 0.2});
    add("curved", {.name = {}, .corners = {}, .bow = 0.2});
    add("curved_offset", {.name = {}, .corners = {}, .z_offset = 0.1, .bow = 0.2});
    add("one_absent", {.name = {}, .corners = {}, .absent = {0, 1, 0, 0}});
    add("two_absent_curved", {.name = {}, .corners = {}, .bow = 0.1, .absent = {1, 0, 1, 0}});
    add("laminate", {.name = {}, .corners = {}, .bow = 0.1, .laminate = true});
    add("corner_thickness", {.name = {}, .corners = {}, .has_corner_thickness = true});
  }
  return cases;
}

class CurvedShells : public testing::TestWithParam<Case> {};

TEST_P(CurvedShells, StiffnessIsSymmetricWithSixRigidMotionsAndNoOther) {
  const SmallModel m = make_model(GetParam());
  expect_sound_stiffness(m, m.nodes.num_gdofs() - 6);
}

TEST_P(CurvedShells, MassIsPositiveAndComplete) {
  const SmallModel m = make_model(GetParam());
  double mass[2];
  for (MassKind kind : {MassKind::Lumped, MassKind::Consistent}) {
    const MatrixXd M = m.calc_mass(kind);
    for (int i = 0; i < M.rows(); i += 6) EXPECT_GT(M(i, i), 0);
    const MatrixXd rigid = check_mass(m, kind);
    mass[kind == MassKind::Lumped ? 0 : 1] = rigid(0, 0);
    EXPECT_LT((rigid.topLeftCorner(3, 3) - rigid(0, 0) * Matrix3d::Identity()).norm(), 1e-13 * rigid(0, 0));
  }
  EXPECT_NEAR(mass[0] / mass[1], 1, 1e-13);
  const Case& c = GetParam();
  if (c.bow != 0 || c.has_corner_thickness) return;
  const double area = c.triangle ? 0.5 * (kCorners[1] - kCorners[0]).cross(kCorners[2] - kCorners[0]).norm()
                                 : 0.5 * (kCorners[2] - kCorners[0]).cross(kCorners[3] - kCorners[1]).norm();
  EXPECT_NEAR(mass[1], area * (0.8 * c.t + 0.1), 1e-13);
}

/// K u is the gradient of the energy of the internal forces; energy by finite compliance of the section's law.
TEST_P(CurvedShells, InternalForcesAreLinearAndRigidMotionsGiveNone) {
  const SmallModel m = make_model(GetParam());
  const StressState& e = *m.elements[0]->stress_state();
  VectorXd s1(e.num_internal_forces()), s2 = s1, s3 = s1;
  const int num_dofs = m.elements[0]->num_dofs();
  const VectorXd u = make_random(3, num_dofs), v = make_random(4, num_dofs);
  e.calc_internal_forces(u, s1);
  e.calc_internal_forces(v, s2);
  e.calc_internal_forces(2 * u - 3 * v, s3);
  EXPECT_LT((s3 - 2 * s1 + 3 * s2).norm(), 1e-12 * s3.norm());
  const MatrixXd Phi_R = m.nodes.calc_rigid_modes();
  for (int k = 0; k < 6; ++k) {
    e.calc_internal_forces(Phi_R.col(k), s2);
    EXPECT_LT(s2.norm(), 1e-11 * s1.norm());
  }
  EXPECT_EQ(e.internal_force_names().size(), static_cast<std::size_t>(e.num_internal_forces()));
}

/// A rigid rotation turns the forces of any state and half the moments (semitangential); exact where the element is
/// flat and whole. The bubbles move in one tangent plane, and an absent grid's side is straight: second-order small
/// there.
TEST_P(CurvedShells, GeometricStiffnessIsSymmetricLinearAndTurnsTheForces) {
  const SmallModel m = make_model(GetParam());
  const VectorXd u = make_random(21, m.nodes.num_gdofs());
  EXPECT_GT(m.calc_geometric_stiffness(u).cwiseAbs().maxCoeff(), 0);
  expect_sound_geometric(m, u);
  if (!GetParam().absent.empty()) return;
  for (const char* k6rot : {"0.", "100.", "1.E6"}) {  // the last: most of the forces are those of the drilling
    const SmallModel stiff = make_model(GetParam(), k6rot);
    const VectorXd f = stiff.calc_stiffness() * u;
    const MatrixXd turned = stiff.calc_geometric_stiffness(u) * m.nodes.calc_rigid_modes().rightCols<3>();
    for (int axis = 0; axis < 3; ++axis) {
      const VectorXd expected = turn_forces(Vector3d::Unit(axis), f);
      EXPECT_LT((turned.col(axis) - expected).norm() / f.norm(), GetParam().bow == 0 ? 1e-11 : 0.05) << k6rot << axis;
    }
  }
}

TEST_P(CurvedShells, ThirdDerivativeIsGeometricStiffness) {
  expect_third_derivative_of_geometric(make_model(GetParam()),
                                       GetParam().bow == 0 && GetParam().absent.empty() ? 1e-9 : 0.05);
}

INSTANTIATE_TEST_SUITE_P(, CurvedShells, testing::ValuesIn(make_cases()),
                         [](const auto& test) { return test.param.name; });

/// The patch of MacNeal and Harder (1985) with midside grids, some left out.
SmallModel make_patch(bool triangles, double t, bool some_absent) {
  SmallModel m;
  add_shell_and_laminate(m, t);
  const std::vector<Vector3d> x = {{0, 0, 0},       {0.24, 0, 0},    {0.24, 0.12, 0}, {0, 0.12, 0},
                                   {0.04, 0.02, 0}, {0.18, 0.03, 0}, {0.16, 0.08, 0}, {0.08, 0.08, 0}};
  std::map<std::pair<int, int>, int> middle;
  for (const auto& p : x) add_grid(m, p);
  // The outer sides first: grids 1 to 4 and 9 to 12 bound the patch.
  for (const auto& [a, b] : {std::pair{1, 2}, {2, 3}, {3, 4}, {1, 4}})
    middle[{a, b}] = add_grid(m, (x[static_cast<std::size_t>(a - 1)] + x[static_cast<std::size_t>(b - 1)]) / 2);
  if (some_absent) middle[{5, 6}] = middle[{2, 6}] = middle[{6, 7}] = 0;
  const auto add = [&](std::vector<int> grids) {
    records::ShellElement e;
    e.id = static_cast<int>(m.deck.shells.size()) + 1, e.pid = 1;
    e.card = grids.size() == 4 ? "CQUAD8" : "CTRIA6";
    for (std::size_t i = 0; i < grids.size(); ++i) {
      const int a = grids[i], b = grids[(i + 1) % grids.size()];
      const auto [at, is_new] = middle.try_emplace({std::min(a, b), std::max(a, b)}, 0);
      if (is_new)
        at->second = add_grid(m, (x[static_cast<std::size_t>(a - 1)] + x[static_cast<std::size_t>(b - 1)]) / 2);
      e.midsides.push_back(at->second);
    }
    e.grids = std::move(grids);
    m.deck.shells.push_back(e);
  };
  for (const auto& q :
       std::vector<std::vector<int>>{{1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}, {5, 6, 7, 8}}) {
    if (triangles) {
      add({q[0], q[1], q[2]});
      add({q[0], q[2], q[3]});
    } else {
      add(q);
    }
  }
  m.make();
  return m;
}

/// Inner grids solve to the field given on the outer eight.
void expect_patch(const SmallModel& m, const std::function<std::pair<Vector3d, Vector3d>(const Vector3d&)>& field,
                  double tolerance) {
  VectorXd exact(m.nodes.num_gdofs());
  std::vector<int> outer, inner;
  for (int k = 0; k < m.nodes.num_nodes(); ++k) {
    const auto [d, r] = field(kR.transpose() * (m.nodes.node(k).x - kOrigin));
    exact.segment<3>(6 * k) = kR * d;
    exact.segment<3>(6 * k + 3) = kR * r;
    for (int c = 0; c < 6; ++c) (k < 4 || (k >= 8 && k < 12) ? outer : inner).push_back(6 * k + c);
  }
  const MatrixXd K = m.calc_stiffness();
  const VectorXd solved = MatrixXd(K(inner, inner)).ldlt().solve(-K(inner, outer) * exact(outer));
  EXPECT_LT((solved - exact(inner)).norm(), tolerance * exact.norm());
}

TEST(CurvedShellPatch, MembraneAndBendingOfDistortedElements) {
  for (bool tri : {false, true})
    for (bool absent : {false, true})
      for (double t : {1e-4, 1e-3, 1e-2}) {
        const SmallModel m = make_patch(tri, t, absent);
        const double tolerance = 1e-12 * std::pow(0.24 / t, 2);
        SCOPED_TRACE(testing::Message() << (tri ? "CTRIA6" : "CQUAD8") << (absent ? " some absent" : "") << " t=" << t);
        expect_patch(
            m,
            [](const Vector3d& x) {
              return std::pair(Vector3d(1e-3 * (x.x() + 0.8 * x.y()), 1e-3 * (x.y() + 0.2 * x.x()), 0),
                               Vector3d(0, 0, 1e-3 * 0.5 * (0.2 - 0.8)));
            },
            tolerance);
        expect_patch(
            m,
            [](const Vector3d& x) {
              return std::pair(Vector3d(0, 0, 1e-3 * (x.x() * x.x() + x.x() * x.y() + x.y() * x.y()) / 2),
                               Vector3d(1e-3 * (0.5 * x.x() + x.y()), -1e-3 * (x.x() + 0.5 * x.y()), 0));
            },
            tolerance);
      }
}

/// Constant membrane strain and curvature give the section's N and M at every point, whatever THETA.
TEST(CurvedShellPatch, ForcesOfALaminate) {
  for (bool tri : {false, true}) {
    Case c{.name = "", .corners = kCorners, .laminate = true, .triangle = tri};
    c.corners[1].y() = 0;  // side 1-2 along x: the frame's x-axis where s is constant needs straight parallel sides
    c.corners[2] = {1.2, 0.9, 0}, c.corners[3] = {0, 0.9, 0};
    const SmallModel m = make_model(c);
    const Eigen::Vector3d e(1, 0.4, -0.6), k(0.7, -0.2, 0.5);
    VectorXd u(m.nodes.num_gdofs());
    for (int i = 0; i < m.nodes.num_nodes(); ++i) {
      const Vector3d x = kR.transpose() * (m.nodes.node(i).x - kOrigin);
      const Vector3d d(e[0] * x.x() + 0.5 * e[2] * x.y(), e[1] * x.y() + 0.5 * e[2] * x.x(),
                       -0.5 * (k[0] * x.x() * x.x() + k[1] * x.y() * x.y() + k[2] * x.x() * x.y()));
      const Eigen::Vector2d slope(-k[0] * x.x() - 0.5 * k[2] * x.y(), -k[1] * x.y() - 0.5 * k[2] * x.x());
      u.segment<3>(6 * i) = kR * d;
      u.segment<3>(6 * i + 3) = kR * Vector3d(slope.y(), -slope.x(), 0);
    }
    // The stack by hand: Q̄ of each ply turned by its angle + THETA.
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero(), B = A, D = A;
    double z = -0.02;
    for (const auto& [t, degrees, is_iso] : {std::tuple{0.03, 20.0, false}, {0.02, 55.0, false}, {0.01, 20.0, true}}) {
      Eigen::Matrix3d Q;
      const double E1 = is_iso ? 3 : 4, E2 = is_iso ? 3 : 0.4, G = is_iso ? 3 / 2.6 : 0.2, nu = 0.3;
      const double n = 1 - nu * nu * E2 / E1;
      Q << E1 / n, nu * E2 / n, 0, nu * E2 / n, E2 / n, 0, 0, 0, G;
      const double a = degrees * M_PI / 180, cs = std::cos(a), sn = std::sin(a);
      Eigen::Matrix3d T;  // strains along the fibre from strains in x, y
      T << cs * cs, sn * sn, cs * sn, sn * sn, cs * cs, -cs * sn, -2 * cs * sn, 2 * cs * sn, cs * cs - sn * sn;
      const Eigen::Matrix3d bar = T.transpose() * Q * T;
      A += bar * t, B += bar * t * (z + t / 2), D += bar * (std::pow(z + t, 3) - std::pow(z, 3)) / 3;
      z += t;
    }
    const StressState& element = *m.elements[0]->stress_state();
    VectorXd s(element.num_internal_forces());
    element.calc_internal_forces(u, s);
    const Eigen::Vector3d N = A * e + B * k, M = B * e + D * k;
    for (int q = 0; q < 8 * (s.size() / 9); q += 8) {
      EXPECT_LT((s.segment<3>(q) - N).norm(), 1e-11 * N.norm());
      EXPECT_LT((s.segment<3>(q + 3) - M).norm(), 1e-11 * N.norm());
      EXPECT_LT(s.segment<2>(q + 6).norm(), 1e-9 * N.norm());
    }
  }
}

TEST(CurvedShell, FoldedSurfaceIsRefused) {
  Case c{.name = "", .corners = kCorners};
  SmallModel m = make_model(c);
  // Two midside grids far out of their places.
  const int a = m.nodes.add_grid(20, m.nodes.node(4).x + 1.5 * (m.nodes.node(6).x - m.nodes.node(4).x)) + 1;
  ASSERT_GT(a, 0);
  m.deck.shells[0].midsides[0] = 20;
  Diagnostics diagnostics;
  EXPECT_TRUE(make_elements(m.deck, m.nodes, diagnostics).elements.empty());
  ASSERT_EQ(diagnostics.items().size(), 1u);
  EXPECT_EQ(diagnostics.items()[0].id, "fe.bad-facet");
}

/// Without midside grids the card is the flat element.
TEST(CurvedShell, WithoutMidsideGridsItIsFlat) {
  Case c{.name = "", .corners = kCorners};
  SmallModel m = make_model(c);
  m.deck.shells[0].midsides.clear();
  m.make();
  ASSERT_EQ(m.elements.size(), 1u);
  EXPECT_EQ(m.elements[0]->shape().type, "quad4");
  EXPECT_EQ(m.elements[0]->card(), "CQUAD8");
  m.deck.shells[0].card = "CQUAD4";
  const MatrixXd K8 = m.calc_stiffness();
  m.make();
  EXPECT_EQ((m.calc_stiffness() - K8).norm(), 0);
}

}  // namespace
}  // namespace bough::fe::test
