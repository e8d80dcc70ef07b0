/// Bad input to the catalogue: every id once, all of a deck reported together; and the frames of orientation and
/// offsets.
#include "small_model.hpp"

#include <functional>

#include "fe/elements/beam.hpp"
#include "fe/elements/bush.hpp"

namespace bough::fe::test {
namespace {

/// Two grids 1 and 2 on x, MAT1 1, PBAR 1, one CBAR: sound until a test breaks it.
SmallModel make_sound() {
  SmallModel m;
  m.nodes.add_grid(1, Vector3d(0, 0, 0));
  m.nodes.add_grid(2, Vector3d(2, 0, 0));
  m.nodes.add_scalar_point(90);
  m.deck.mat1.push_back({1, 3, 1, 0.3, 1, 0, 0, 0, 0, 0, 0, {0, 10}});
  records::Pbar p;
  p.id = p.mid = 1, p.A = p.I1 = p.I2 = p.J = 1, p.at = {0, 11};
  m.deck.pbar.push_back(p);
  records::BeamElement e;
  e.id = 1, e.pid = 1, e.ga = 1, e.gb = 2, e.v = Vector3d(0, 1, 0), e.at = {0, 12};
  m.deck.beams.push_back(e);
  return m;
}

Diagnostics diagnose(SmallModel& m) {
  Diagnostics diagnostics;
  m.elements = std::move(make_elements(m.deck, m.nodes, diagnostics).elements);
  return diagnostics;
}

/// The sound deck after `change` has one error.
void expect_error(const std::string& id, int line, const std::function<void(records::Deck&)>& change) {
  SmallModel m = make_sound();
  change(m.deck);
  const Diagnostics d = diagnose(m);
  ASSERT_TRUE(d.has(id)) << id << (d.items().empty() ? "" : format(d.items().front()));
  EXPECT_EQ(d.num_errors(), 1);
  EXPECT_EQ(d.items().front().where.line, line);
  EXPECT_EQ(d.items().front().where.file, "hand.bdf");
}

TEST(Catalog, SoundDeckHasNoDiagnostics) {
  SmallModel m = make_sound();
  EXPECT_TRUE(diagnose(m).items().empty());
  EXPECT_EQ(m.elements.size(), 1u);
}

TEST(Catalog, MissingGrid) {
  expect_error("fe.missing-grid", 12, [](records::Deck& deck) { deck.beams[0].gb = 77; });
  expect_error("fe.missing-grid", 12, [](records::Deck& deck) { deck.beams[0].gb = 90; });
  expect_error("fe.missing-grid", 12, [](records::Deck& deck) { deck.beams[0].g0 = 77; });
}

TEST(Catalog, MissingProperty) {
  expect_error("fe.missing-property", 12, [](records::Deck& deck) { deck.beams[0].pid = 5; });
  expect_error("fe.missing-property", 12, [](records::Deck& deck) { deck.beams[0].is_cbeam = true; });
  expect_error("fe.missing-property", 20, [](records::Deck& deck) { deck.crod.push_back({3, 8, 1, 2, {0, 20}}); });
  expect_error("fe.missing-property", 21, [](records::Deck& deck) { deck.ctube.push_back({3, 8, 1, 2, {0, 21}}); });
}

TEST(Catalog, Material) {
  expect_error("fe.missing-material", 11, [](records::Deck& deck) { deck.pbar[0].mid = 4; });
  expect_error("fe.bad-material", 10, [](records::Deck& deck) { deck.mat1[0].E = 0; });
}

TEST(Catalog, BadProperty) {
  expect_error("fe.bad-property", 11, [](records::Deck& deck) { deck.pbar[0].A = -1; });
  expect_error("fe.bad-property", 11, [](records::Deck& deck) { deck.pbar[0].I12 = 2; });
  expect_error("fe.bad-property", 22, [](records::Deck& deck) {
    deck.ptube.push_back({3, 1, 0.1, 0.2, 0, {}, {0, 22}});
    deck.ctube.push_back({3, 3, 1, 2, {0, 21}});
  });
}

TEST(Catalog, BadSection) {
  expect_error("fe.bad-section", 30, [](records::Deck& deck) {
    deck.pbarl.push_back({2, 1, "BOX", {1, 1, 0.6, 0.1}, 0, {0, 30}});
    deck.beams[0].pid = 2;
  });
}

TEST(Catalog, ZeroLength) {
  expect_error("fe.zero-length", 12, [](records::Deck& deck) { deck.beams[0].gb = 1; });
  // The two ends are one rigid grid all the same.
  expect_error("fe.zero-length", 12,
               [](records::Deck& deck) { deck.beams[0].gb = 1, deck.beams[0].wb = Vector3d(0, 2, 0); });
  expect_error("fe.zero-length", 12, [](records::Deck& deck) { deck.beams[0].wa = Vector3d(2, 0, 0); });
  expect_error("fe.zero-length", 25, [](records::Deck& deck) {
    deck.conrod.push_back({4, 2, 2, 1, 1, 0, 0, 0, {0, 25}});
  });
}

TEST(Catalog, BadOrientation) {
  expect_error("fe.bad-orientation", 12, [](records::Deck& deck) { deck.beams[0].v = Vector3d(-3, 0, 0); });
  expect_error("fe.bad-orientation", 12, [](records::Deck& deck) { deck.beams[0].v.setZero(); });
  expect_error("fe.bad-orientation", 40, [](records::Deck& deck) {
    deck.pbush.push_back({1, {1, 1, 0, 0, 0, 0}, {}, {}, 0, {}});
    records::Cbush e;
    e.id = 2, e.pid = 1, e.ga = 1, e.gb = 2, e.at = {0, 40};
    deck.cbush.push_back(e);
  });
}

TEST(Catalog, BadOfftAndComponents) {
  expect_error("fe.bad-offt", 12, [](records::Deck& deck) { deck.beams[0].offt = "GXG"; });
  expect_error("fe.bad-component", 50, [](records::Deck& deck) {
    deck.springs.push_back({3, 0, 1, 0, 0, 1, 7, 0, 0, {0, 50}});
  });
}

TEST(Catalog, NegativeMass) {
  expect_error("fe.negative-mass", 60, [](records::Deck& deck) {
    records::Conm2 e;
    e.id = 2, e.g = 1, e.m = -1, e.at = {0, 60};
    deck.conm2.push_back(e);
  });
}

TEST(Catalog, Warnings) {
  SmallModel m = make_sound();
  m.deck.pbar[0].I12 = 0.1;
  m.deck.pbar[0].k1 = 0.8;
  records::Pbeam p;
  p.id = 3, p.mid = 1, p.cw_a = 1, p.s1 = 0.5;
  p.stations.resize(2);
  for (auto& s : p.stations) s.A = s.I1 = s.I2 = s.J = 1;
  p.stations[1].x_over_L = 1;
  m.deck.pbeam.push_back(p);
  m.deck.beams.push_back(m.deck.beams[0]);
  m.deck.beams[1].is_cbeam = true;
  m.deck.beams[1].pid = 3;
  const Diagnostics d = diagnose(m);
  EXPECT_EQ(d.num_errors(), 0);
  EXPECT_TRUE(d.has("fe.shear-ignored"));
  EXPECT_TRUE(d.has("fe.warping-ignored"));
  EXPECT_TRUE(d.has("fe.shear-relief-ignored"));
}

TEST(Catalog, AllErrorsOfADeckAreReported) {
  SmallModel m = make_sound();
  m.deck.beams[0].gb = 77;
  m.deck.beams[0].pid = 5;
  m.deck.crod.push_back({3, 8, 1, 66, {0, 20}});
  EXPECT_EQ(diagnose(m).num_errors(), 4);
}

const BeamGeometry& get_geometry(const SmallModel& m) { return dynamic_cast<const Beam&>(*m.elements[0]).geometry(); }

/// v and the offsets in the displacement axes (G), v in basic (B), offsets in element axes (O); G0 from GA.
TEST(Catalog, OrientationFrames) {
  const Matrix3d R_a = make_rotation(4), R_b = make_rotation(5);
  const Vector3d xa(1, 2, 3), xb(4, 1, 2), v(0.3, 1, 0.2), wa(0.1, 0.2, 0.3), wb(-0.2, 0.1, 0);
  for (const std::string offt : {"GGG", "BGG", "GOG", "BGO", "GOO"}) {
    SmallModel m;
    m.nodes.add_grid(1, xa, R_a);
    m.nodes.add_grid(2, xb, R_b);
    SmallModel sound = make_sound();
    m.deck = sound.deck;
    auto& e = m.deck.beams[0];
    e.v = v, e.wa = wa, e.wb = wb, e.offt = offt;
    m.make();
    const Vector3d v_basic = offt[0] == 'G' ? Vector3d(R_a * v) : v;
    const Vector3d ex0 = (xb - xa).normalized(), ez0 = ex0.cross(v_basic).normalized();
    Matrix3d R_0;
    R_0 << ex0, ez0.cross(ex0), ez0;
    const Vector3d a = offt[1] == 'G' ? Vector3d(R_a * wa) : Vector3d(R_0 * wa);
    const Vector3d b = offt[2] == 'G' ? Vector3d(R_b * wb) : Vector3d(R_0 * wb);
    EXPECT_LT((get_geometry(m).wa - a).norm(), 1e-14) << offt;
    EXPECT_LT((get_geometry(m).wb - b).norm(), 1e-14) << offt;
    const Matrix3d R = get_geometry(m).R_basic_element;
    EXPECT_LT((R.col(0) - (xb + b - xa - a).normalized()).norm(), 1e-14);
    EXPECT_NEAR(R.col(2).dot(v_basic), 0, 1e-14) << "v lies in plane 1";
    EXPECT_GT(R.col(1).dot(v_basic), 0);
    EXPECT_LT((R.transpose() * R - Matrix3d::Identity()).norm(), 1e-14);
  }
  SmallModel m = make_sound();
  m.nodes.add_grid(3, Vector3d(0, 0, 5));
  m.deck.beams[0].g0 = 3;
  m.make();
  EXPECT_LT((get_geometry(m).R_basic_element.col(1) - Vector3d::UnitZ()).norm(), 1e-14);
}

/// Scalar springs and masses act along the displacement axes of their grids.
TEST(Catalog, ScalarElementsFollowDisplacementAxes) {
  const Matrix3d R = make_rotation(8);
  SmallModel m;
  m.nodes.add_grid(1, Vector3d::Zero(), R);
  m.nodes.add_grid(2, Vector3d::Zero());
  m.nodes.add_scalar_point(3);
  m.deck.pelas.push_back({4, 7, 0, 0, {}});
  m.deck.springs.push_back({1, 4, 0, 0, 0, 1, 2, 2, 6, {}});
  m.deck.springs.push_back({2, 0, 5, 0, 0, 0, 0, 1, 3, {}});
  m.deck.springs.push_back({3, 0, 2, 0, 0, 3, 0, 1, 1, {}});
  m.deck.pmass.push_back({5, 3, {}});
  m.deck.scalar_masses.push_back({4, 5, 0, 1, 5, 0, 0, {}});
  m.make();
  VectorXd b = VectorXd::Zero(13), c = b, d = b, e = b;
  b.segment<3>(0) = R.col(1);
  b[11] = -1;
  c.segment<3>(0) = R.col(2);
  d[12] = 1;
  d.segment<3>(0) = -R.col(0);
  e.segment<3>(3) = R.col(1);
  const MatrixXd K = 7 * b * b.transpose() + 5 * c * c.transpose() + 2 * d * d.transpose();
  EXPECT_LT((m.calc_stiffness() - K).norm(), 1e-13);
  EXPECT_LT((m.calc_mass(MassKind::Lumped) - 3 * e * e.transpose()).norm(), 1e-13);
}

/// Forces of a bush at its point, moved to the grids: against a hand-made rigid link.
TEST(Catalog, BushWithOffsetAndGround) {
  SmallModel m;
  const Vector3d xa(1, 0, 0), xb(3, 1, 0);
  m.nodes.add_grid(1, xa);
  m.nodes.add_grid(2, xb);
  m.deck.pbush.push_back({1, {10, 20, 30, 4, 5, 6}, {}, {}, 0, {}});
  records::Cbush e;
  e.id = 1, e.pid = 1, e.ga = 1, e.gb = 2, e.v = Vector3d(0, 0, 1), e.s = 0.25;
  m.deck.cbush.push_back(e);
  m.make();
  const Vector3d ex = (xb - xa).normalized(), ey(0, 0, 1), p = xa + 0.25 * (xb - xa);
  Matrix3d R;
  R << ex, ey, ex.cross(ey);
  Eigen::Matrix<double, 12, 1> u;
  u << 0.1, 0.2, 0.3, -0.1, 0.05, 0.02, 0.3, -0.2, 0.1, 0.04, 0.03, -0.06;
  const Vector3d ta = u.segment<3>(3), tb = u.segment<3>(9);
  const Vector3d ua = u.head<3>() + ta.cross(p - xa), ub = u.segment<3>(6) + tb.cross(p - xb);
  const Vector3d f = R * Vector3d(10, 20, 30).asDiagonal() * R.transpose() * (ub - ua);
  const Vector3d t = R * Vector3d(4, 5, 6).asDiagonal() * R.transpose() * (tb - ta);
  VectorXd expected(12);
  expected << -f, -(t + (p - xa).cross(f)), f, t + (p - xb).cross(f);
  EXPECT_LT((m.calc_stiffness() * u - expected).norm(), 1e-13);
  Eigen::Matrix<double, 6, 1> forces;
  forces << R.transpose() * f, R.transpose() * t;
  EXPECT_LT((dynamic_cast<const Bush&>(*m.elements[0]).calc_spring_forces(u) - forces).norm(), 1e-13);

  m.deck.cbush[0].gb = 0;
  m.deck.cbush[0].cid = 0;
  m.make();
  ASSERT_EQ(m.elements[0]->num_dofs(), 6);
  const Eigen::Matrix<double, 6, 1> k = m.calc_stiffness().diagonal().head<6>();
  EXPECT_LT((k - (Eigen::Matrix<double, 6, 1>() << 10, 20, 30, 4, 5, 6).finished()).norm(), 1e-14);
}

/// CONM2: offset in CID axes or a position (CID = -1), products of inertia with their Nastran sign; CONM1 in CID axes.
TEST(Catalog, PointMasses) {
  const Matrix3d R = make_rotation(14);
  const Vector3d x(1, 2, 3), offset(0.1, 0.2, -0.3);
  SmallModel m;
  m.nodes.add_grid(1, x);
  m.nodes.add_system(4, Vector3d(5, 5, 5), R);
  records::Conm2 e;
  e.id = 1, e.g = 1, e.cid = 4, e.m = 2, e.x = offset, e.inertia = {3, 0.1, 2, -0.2, 0.3, 4};
  m.deck.conm2.push_back(e);
  m.make();
  Matrix3d I;
  I << 3, -0.1, 0.2, -0.1, 2, -0.3, 0.2, -0.3, 4;
  const Vector3d w(0.3, -0.5, 0.7), v(1, -2, 0.5);  // motion of the grid
  VectorXd motion(6);
  motion << v, w;
  const auto energy = [&](const Vector3d& s, const Matrix3d& J) {
    return (v + w.cross(s)).squaredNorm() + 0.5 * w.dot(J * w);
  };
  EXPECT_NEAR(0.5 * motion.dot(m.calc_mass(MassKind::Lumped) * motion), energy(R * offset, R * I * R.transpose()),
              1e-13);
  m.deck.conm2[0].cid = -1;
  m.deck.conm2[0].x = x + offset;
  m.make();
  EXPECT_NEAR(0.5 * motion.dot(m.calc_mass(MassKind::Lumped) * motion), energy(offset, I), 1e-13);

  m.deck.conm2.clear();
  records::Conm1 full;
  full.id = 2, full.g = 1, full.cid = 4;
  full.m = (Eigen::Matrix<double, 6, 1>() << 1, 2, 3, 4, 5, 6).finished().asDiagonal();
  full.m(0, 4) = full.m(4, 0) = 0.5;
  m.deck.conm1.push_back(full);
  m.make();
  VectorXd local(6);
  local << R.transpose() * v, R.transpose() * w;
  EXPECT_NEAR(motion.dot(m.calc_mass(MassKind::Consistent) * motion), local.dot(full.m * local), 1e-12);
}

}  // namespace
}  // namespace bough::fe::test
