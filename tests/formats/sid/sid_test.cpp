// Standard Input Data: a case by hand, round trips, files of others, and the motion that the blocks describe against
// the solver's.
#include "formats/sid/sid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "solver/bodies/body.hpp"
#include "tests/formats/sid/point_masses.hpp"
#include "tests/support/paths.hpp"

namespace bough::test {
namespace {

using sid::Layout;
using sid::Sid;
using sid::Taylor;

Sid make(const records::FlexBody& body, const Layout& layout = {}) {
  Diagnostics diagnostics;
  return sid::make_sid(body, layout, {"body.h5"}, diagnostics);
}

class File {
 public:
  explicit File(const std::string& text) { std::ofstream(path_) << text; }
  ~File() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_ =
      (std::filesystem::temp_directory_path() / ("bough-sid-" + std::to_string(::getpid()) + ".SID_FEM")).string();
};

void expect_same(const Taylor& a, const Taylor& b, double tolerance, const std::string& name) {
  ASSERT_EQ(a.m1.size(), b.m1.size()) << name;
  EXPECT_LE((a.m0 - b.m0).cwiseAbs().maxCoeff(), tolerance) << name;
  for (std::size_t q = 0; q < a.m1.size(); ++q)
    EXPECT_LE((a.m1[q] - b.m1[q]).cwiseAbs().maxCoeff(), tolerance) << name << " m1 " << q;
}

void expect_same(const Sid& a, const Sid& b, double tolerance) {
  EXPECT_NEAR(a.mass, b.mass, tolerance);
  EXPECT_EQ(a.mode_name, b.mode_name);
  EXPECT_EQ(a.comment, b.comment);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t k = 0; k < a.nodes.size(); ++k) {
    EXPECT_EQ(a.nodes[k].id, b.nodes[k].id);
    expect_same(a.nodes[k].origin, b.nodes[k].origin, tolerance, "origin");
    expect_same(a.nodes[k].phi, b.nodes[k].phi, tolerance, "phi");
    expect_same(a.nodes[k].psi, b.nodes[k].psi, tolerance, "psi");
    expect_same(a.nodes[k].AP, b.nodes[k].AP, tolerance, "AP");
  }
  expect_same(a.mdCM, b.mdCM, tolerance, "mdCM");
  expect_same(a.J, b.J, tolerance, "J");
  expect_same(a.Ct, b.Ct, tolerance, "Ct");
  expect_same(a.Cr, b.Cr, tolerance, "Cr");
  expect_same(a.Me, b.Me, tolerance, "Me");
  expect_same(a.Gr, b.Gr, tolerance, "Gr");
  expect_same(a.Ge, b.Ge, tolerance, "Ge");
  expect_same(a.Oe, b.Oe, tolerance, "Oe");
  expect_same(a.ksigma, b.ksigma, tolerance, "ksigma");
  expect_same(a.Ke, b.Ke, tolerance, "Ke");
  expect_same(a.De, b.De, tolerance, "De");
}

// Masses 2 at (1 0 0), 3 at (0 2 0); the mode moves the first by (0 0.5 0), the second by (0.25 0 1).
records::FlexBody make_two_masses() {
  return make_body({{2, {1, 0, 0}, Vector3d(0, 0.5, 0)}, {3, {0, 2, 0}, Vector3d(0.25, 0, 1)}});
}

TEST(Sid, TwoMassesByHand) {
  const auto body = make_two_masses();
  const Sid s = make(body);
  EXPECT_EQ(s.mass, 5);
  EXPECT_EQ(s.mdCM.m0, (MatrixXd(3, 1) << 2, 6, 0).finished());
  EXPECT_EQ(s.mdCM.m1[0], (MatrixXd(3, 1) << 0.75, 1, 3).finished());
  EXPECT_EQ(s.Ct.m0, (MatrixXd(1, 3) << 0.75, 1, 3).finished());
  // J: 2 at x = 1, 3 at y = 2. First order: Σ m (2 (p·φ) 1 - φ pᵀ - p φᵀ); p·φ = 0 at both.
  EXPECT_EQ(s.J.m0, (MatrixXd(6, 1) << 12, 2, 14, 0, 0, 0).finished());
  // -Σ m (φ pᵀ + p φᵀ): 12: -(2 · 0.5 + 3 · 0.5), 23: -(3 · 2), 13: 0.
  EXPECT_EQ(s.J.m1[0], (MatrixXd(6, 1) << 0, 0, 0, -2.5, 0, -6).finished());
  // Σ m p × φ: 2 (0 0 0.5) + 3 (2 0 -0.5).
  EXPECT_EQ(s.Cr.m0, (MatrixXd(1, 3) << 6, 0, -0.5).finished());
  // Gr = -2 Σ m p~ φ~ = 2 Σ m ((p·φ) 1 - φ pᵀ): columns 1 and 2 are -2 m p_x φ and -2 m p_y φ.
  EXPECT_EQ(s.Gr.m0, (MatrixXd(3, 3) << 0, -3, 0, -2, 0, 0, 0, -12, 0).finished());
  EXPECT_EQ(s.Ge.m0, MatrixXd::Zero(1, 3));
  EXPECT_EQ(s.Me.m0(0, 0), 2 * 0.25 + 3 * 1.0625);
  // Oe Ω = Σ m φ·(ω×(ω×p)) = Σ m ((ω·φ)(ω·p) - ω² φ·p): ω1ω2 takes 2 · 0.5 + 3 · 0.5, ω2ω3 takes 3 · 2.
  EXPECT_EQ(s.Oe.m0, (MatrixXd(1, 6) << 0, 0, 0, 2.5, 6, 0).finished());
  // First order Σ m φ·(ω×(ω×φ)) = -Σ m |ω × φ|², plus K_G: 2 · 0.25 (ω1² + ω3²) + 3 ((0.0625 + 1) ω2² + ω1² + 0.0625
  // ω3² - 2 · 0.25 ω1ω3).
  const auto G = [&](int i) { return body.kg_inertial[static_cast<std::size_t>(i)](0, 0); };
  const MatrixXd expected =
      (MatrixXd(1, 6) << -3.5 + G(6), -3.1875 + G(7), -0.6875 + G(8), G(9), G(11), 1.5 + G(10)).finished();
  EXPECT_LE((s.Oe.m1[0] - expected).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(s.Ct.m1[0], (MatrixXd(1, 3) << G(0), G(1), G(2)).finished());
  EXPECT_EQ(s.Cr.m1[0], (MatrixXd(1, 3) << G(3), G(4), G(5)).finished());
  // The stiffening by a force at node 1 comes with a minus sign; node 2 has no locators.
  for (int a = 0; a < 3; ++a)
    EXPECT_EQ(s.nodes[0].phi.m1[0](a, 0), -body.kg_external[static_cast<std::size_t>(a)](0, 0));
  EXPECT_TRUE(s.nodes[1].phi.m1.empty());
  EXPECT_EQ(s.nodes[0].origin.m1[0], MatrixXd(Vector3d(0, 0.5, 0)));
}

TEST(Sid, WriteReadIsIdentical) {
  const auto body = make_body(make_points(5, 4, 3), 3, true);
  for (const bool full : {false, true}) {
    for (const bool by_component : {false, true}) {
      const Layout layout{full, by_component, 17};
      const Sid s = make(body, layout);
      const auto text = sid::write_sid(s, layout);
      const File file(text);
      const Sid back = sid::read_sid(file.path());
      expect_same(s, back, 0);
      EXPECT_EQ(sid::write_sid(back, layout), text);
      EXPECT_EQ(sid::calc_relations(back).by_component, by_component);
    }
  }
  const Sid s = make(body);
  const File file(sid::write_sid(s, {false, false, 12}));
  expect_same(s, sid::read_sid(file.path()), 1e-10);
}

TEST(Sid, BlocksOfOnePieceHaveAStructure) {
  auto body = make_body(make_points(4, 2, 4), 4);
  body.modal_mass.setIdentity();
  const auto text = sid::write_sid(make(body), {});
  const auto at = [&](const std::string& block) {
    const auto start = text.find("           " + block + "\n");
    const auto value = text.find("structure", start);
    return text.substr(text.find('=', value) + 1, 6);
  };
  EXPECT_EQ(at("Me"), "     4");
  EXPECT_EQ(at("Ke"), "     1");
  EXPECT_EQ(at("De"), "     3");
  EXPECT_EQ(at("ksigma"), "     0");
  const File file(text);
  EXPECT_EQ(sid::read_sid(file.path()).Me.m0, MatrixXd::Identity(2, 2));
}

TEST(Sid, RelationsHoldInOurFilesAndTellADifference) {
  Sid s = make(make_body(make_points(6, 3, 5), 5));
  const auto r = sid::calc_relations(s);
  for (const double value : {r.mdCM_Ct, r.Gr_J, r.Oe_J, r.Ge_Cr, r.AP_psi, r.origin_phi}) EXPECT_LT(value, 1e-14);
  s.Oe.m0(1, 3) += 0.1;
  s.nodes[0].AP.m1[0](0, 1) += 0.1;
  EXPECT_GT(sid::calc_relations(s).Oe_J, 1e-3);
  EXPECT_GT(sid::calc_relations(s).AP_psi, 1e-3);
}

TEST(Sid, FilesOfOthers) {
  const std::filesystem::path folder = std::filesystem::path(BOUGH_SHARED_DIR) / "reference/sid";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no files of others at " << folder;
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".SID_FEM") continue;
    SCOPED_TRACE(entry.path().filename().string());
    const Sid s = sid::read_sid(entry.path().string());
    const auto r = sid::calc_relations(s);
    ++count;
    // Twelve digits in the files.
    EXPECT_LT(r.mdCM_Ct, 1e-11);
    EXPECT_LT(r.Gr_J, 1e-11);
    EXPECT_LT(r.Oe_J, 1e-11);
    EXPECT_LT(r.AP_psi, 1e-11);
    EXPECT_LT(r.origin_phi, 1e-11);
    if (s.num_modes() > 1) {
      EXPECT_LT(r.Ge_Cr, 1e-11);
      EXPECT_TRUE(r.by_component);  // docs/formats/sid.md: unlike their own readers
    }
    const File file(sid::write_sid(s, {}));
    expect_same(s, sid::read_sid(file.path()), 0);
  }
  EXPECT_EQ(count, 3);
}

/// The equations of motion as the format states them: M(q) [a; α; q̈] + h(q, q̇, ω), a the inertial acceleration of Bo.
struct Motion {
  MatrixXd M;
  VectorXd h;
};

Motion calc_motion(const Sid& s, const Vector3d& w, const VectorXd& q, const VectorXd& q_dot) {
  const auto n = q.size();
  const auto tilde = [](const Vector3d& a) {
    Matrix3d t;
    t << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return t;
  };
  const MatrixXd J6 = s.J.evaluate(q), Ct = s.Ct.evaluate(q), Cr = s.Cr.evaluate(q);
  Matrix3d J;
  J << J6(0), J6(3), J6(4), J6(3), J6(1), J6(5), J6(4), J6(5), J6(2);
  const Vector3d mc = s.mdCM.evaluate(q);
  Motion motion{MatrixXd::Zero(6 + n, 6 + n), VectorXd(6 + n)};
  motion.M << s.mass * Matrix3d::Identity(), -tilde(mc), Ct.transpose(), tilde(mc), J, Cr.transpose(), Ct, Cr, s.Me.m0;
  Matrix3d Gr = Matrix3d::Zero();
  MatrixXd Ge = MatrixXd::Zero(n, 3);
  for (Eigen::Index k = 0; k < n; ++k) {
    Gr += s.Gr.m0.middleCols(3 * k, 3) * q_dot[k];
    Ge += s.Ge.m0.middleCols(3 * k, 3) * q_dot[k];
  }
  VectorXd Omega(6);
  Omega << w.x() * w.x(), w.y() * w.y(), w.z() * w.z(), w.x() * w.y(), w.y() * w.z(), w.x() * w.z();
  motion.h.head(3) = w.cross(w.cross(mc)) + 2 * w.cross(Vector3d(s.Ct.m0.transpose() * q_dot));
  motion.h.segment(3, 3) = Gr * w + w.cross(Vector3d(J * w));
  motion.h.tail(n) = Ge * w + s.Oe.evaluate(q) * Omega + s.ksigma.m0.col(0) + s.Ke.m0 * q + s.De.m0 * q_dot;
  return motion;
}

Motion calc_solver_motion(const solver::Body& body, const Vector3d& w, const VectorXd& q, const VectorXd& q_dot) {
  auto x = body.make_inertia();
  body.calc_inertia(w, q, q_dot, x);
  return {x.make_M(), x.h};
}

// The format ends at first order in (q, q̇), the solver's energy goes on. Its derivative at rest along (q, q̇): the
// difference formula of eighth order is exact for the polynomials of degree 8 that M and h are.
template <typename F>
Motion calc_slope(const F& calc, const VectorXd& q, const VectorXd& q_dot) {
  const double weight[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280}, step = 0.25;
  const auto size = 6 + q.size();
  Motion slope{MatrixXd::Zero(size, size), VectorXd::Zero(size)};
  for (int k = 1; k <= 4; ++k) {
    const Motion plus = calc(k * step * q, k * step * q_dot), minus = calc(-k * step * q, -k * step * q_dot);
    slope.M += weight[k - 1] / step * (plus.M - minus.M);
    slope.h += weight[k - 1] / step * (plus.h - minus.h);
  }
  return slope;
}

TEST(Sid, MotionIsTheSolversToFirstOrder) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto record = make_body(make_points(7, 4, seed), seed);
    const Sid s = make(record);
    const auto body = solver::Body::make_flexible(record, -1, true, {});
    std::srand(seed);
    const VectorXd q = VectorXd::Random(4), q_dot = VectorXd::Random(4);
    const Vector3d w = Vector3d::Random();
    const auto calc_ours = [&](const VectorXd& x, const VectorXd& v) { return calc_solver_motion(body, w, x, v); };
    const auto calc_theirs = [&](const VectorXd& x, const VectorXd& v) { return calc_motion(s, w, x, v); };
    const Motion ours = calc_slope(calc_ours, q, q_dot), theirs = calc_slope(calc_theirs, q, q_dot);
    // The modes' own block has no first order in the format.
    EXPECT_LT((ours.M.leftCols(6) - theirs.M.leftCols(6)).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((ours.h - theirs.h).cwiseAbs().maxCoeff(), 1e-12);
    const VectorXd none = VectorXd::Zero(4);
    const Motion rest = calc_ours(none, none), at_rest = calc_theirs(none, none);
    EXPECT_LT((rest.M - at_rest.M).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((rest.h - at_rest.h).cwiseAbs().maxCoeff(), 1e-13);
    // A force at the interface node, through its Jacobian.
    const auto& node = body.nodes()[static_cast<std::size_t>(body.find_node(1))];
    const Vector3d f = Vector3d::Random();
    VectorXd generalized = VectorXd::Zero(4);
    solver::add_node_generalized_force(node, q, Matrix3d::Identity(), f, Vector3d::Zero(), generalized);
    EXPECT_LT((generalized - s.nodes[0].phi.evaluate(q).transpose() * f).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(Sid, MissingStiffnessIsSaid) {
  auto body = make_two_masses();
  body.kg_inertial_computed[2] = body.kg_inertial_computed[11] = false;
  Diagnostics diagnostics;
  const Sid s = sid::make_sid(body, {}, {"body.h5"}, diagnostics);
  ASSERT_TRUE(diagnostics.has("export.no-stiffening"));
  EXPECT_THAT(diagnostics.items()[0].what, testing::HasSubstr("az wywz"));
  EXPECT_EQ(s.Ct.m1[0](0, 2), 0);
  body.exact = {};
  try {
    sid::make_sid(body, {}, {"body.h5"}, diagnostics);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.items()[0].id, "export.no-integrals");
  }
}

struct Fault {
  std::string from, to, id;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.id << " of '" << fault.from << "'"; }

class SidFault : public testing::TestWithParam<Fault> {};

TEST_P(SidFault, IsSaidWithItsLine) {
  const auto& [from, to, id] = GetParam();
  auto text = sid::write_sid(make(make_two_masses()), {});
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, from.size(), to);
  const File file(text);
  try {
    sid::read_sid(file.path());
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.items()[0].id, id);
    EXPECT_EQ(error.items()[0].where.file, file.path());
    EXPECT_GT(error.items()[0].where.line, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, SidFault,
    testing::Values(
        Fault{" part", " parts", "export.sid-syntax"}, Fault{" mdCM", " mdCN", "export.sid-syntax"},
        Fault{"structure             =", "structure             =x", "export.sid-syntax"},
        Fault{"m1( 1, 1, 1)", "m1( 1, 1)   ", "export.sid-syntax"}, Fault{"m0( 2, 1)", "m0( 9, 1)", "export.sid-shape"},
        Fault{"nrow                  =     3", "nrow                  =900000000", "export.sid-shape"},
        // Written beyond its end once: found by fuzzing.
        Fault{"structure             =     3", "structure             =     2", "export.sid-shape"},
        Fault{"m0( 2, 1)             = 6.0000000000000000D+00", "m0( 2, 1)             = 6.0x", "export.sid-syntax"},
        Fault{"nelastq                         =     1", "nelastq                         =     2", "export.sid-shape"},
        Fault{"           end frame", "", "export.sid-syntax"}, Fault{" end part", "", "export.sid-syntax"}),
    [](const auto& fault) { return "Fault" + std::to_string(fault.index); });

TEST(Sid, ABlockThatIsNotThere) {
  auto text = sid::write_sid(make(make_two_masses()), {});
  const auto first = text.find("           Ke\n"), last = text.find("end Ke\n") + 7;
  text.erase(first, last - first);
  const File file(text);
  try {
    sid::read_sid(file.path());
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.items()[0].id, "export.sid-missing");
  }
}

}  // namespace
}  // namespace bough::test
