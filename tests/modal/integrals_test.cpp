/// Γ0..Γ4: momentum and exact sets against dense sums, against each other, and their mesh convergence.
#include "modal/integrals.hpp"

#include <gtest/gtest.h>

#include <random>

#include "base/rotation.hpp"
#include "formats/nastran/reader.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

using modal::calc_exact_integrals;
using modal::calc_momentum_integrals;
using records::MassIntegrals;

const Section kSection = {70e9, 27e9, 2700, 1e-4, 1e-9, 3e-9, 2e-9};

/// A bent frame in space with CBAR and a point mass on a grid.
DeckMaker make_frame() {
  DeckMaker maker;
  maker.add_section(1, kSection);
  maker.add_line(1, 1, {0.3, 0.1, -0.2}, {1.3, 0.4, 0}, 4, Vector3d::UnitY());
  maker.add_line(1, 101, {1.3, 0.4, 0}, {1.5, 1.4, 0.7}, 4, Vector3d::UnitX(), 5);
  maker.add_mass(900, 103, 0.2);
  maker.fix(1, 123456);
  return maker;
}

MatrixXd make_random(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 generator(12345);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return MatrixXd::NullaryExpr(rows, columns, [&] { return uniform(generator); });
}

// The lumped mass of bars is one mass per grid: both sets are Σ m (...) to roundoff, and equal the sum written out.
TEST(Integrals, LumpedIdentitiesAreExact) {
  Diagnostics diagnostics;
  const auto model = fe::build_model(make_frame().deck, {}, diagnostics);
  const MatrixXd Phi = make_random(model.num_gdofs(), 3);
  const Vector3d S(0.5, -0.7, 0.2);
  const auto momentum = calc_momentum_integrals(model, MassKind::Lumped, Phi, S);
  const auto exact = calc_exact_integrals(model, MassKind::Lumped, Phi, S);
  EXPECT_LT(test::calc_difference(momentum, exact), 1e-12);

  MassIntegrals sum = momentum;
  sum.gamma0.setZero();
  sum.gamma1.setZero();
  for (int j = 0; j < 3; ++j) {
    sum.gamma2[j].setZero();
    sum.gamma3[j].setZero();
    for (int k = 0; k < 3; ++k) sum.gamma4[j][k].setZero();
  }
  const MatrixXd ones = model.calc_rigid_modes().leftCols(1);
  const MatrixXd M_ones = fe::calc_mass_times(model, MassKind::Lumped, ones);
  for (const auto& node : model.nodes()) {
    const double m = M_ones(node.first_gdof, 0);
    const Vector3d p = node.x - S;
    const MatrixXd phi = Phi.middleRows(node.first_gdof, 3);
    for (int j = 0; j < 3; ++j) {
      const Vector3d a = phi.col(j);
      sum.gamma0.col(j) += m * a;
      sum.gamma1.col(j) += m * p.cross(a);
      sum.gamma3[j] += m * (p.dot(a) * Matrix3d::Identity() - a * p.transpose());
      for (int k = 0; k < 3; ++k) {
        const Vector3d b = phi.col(k);
        sum.gamma2[j].col(k) += m * a.cross(b);
        sum.gamma4[j][k] += m * (a.dot(b) * Matrix3d::Identity() - a * b.transpose());
      }
    }
  }
  EXPECT_LT(test::calc_difference(momentum, sum), 1e-12);
}

/// ∫ |ω×(x + u) + u̇|² dm over a bar with grids at x_A, x_B: cubics across it, straight along it, and Nastran's mean of
/// lumped and consistent along the axis, which adds m/12 for the stretch.
double calc_bar_energy(const Vector3d ends[2], const VectorXd& q, const VectorXd& q_dot, const Vector3d& w,
                       double mass_per_length) {
  const Vector3d chord = ends[1] - ends[0], e = chord.normalized();
  const double h = chord.norm();
  const auto calc_shape = [&](const VectorXd& v, double x) -> Vector3d {
    const Vector3d a = v.head<3>(), b = v.segment<3>(6), slope_a = v.segment<3>(3).cross(e),
                   slope_b = v.tail<3>().cross(e);
    const Vector3d along = e * e.dot((1 - x) * a + x * b);
    const Vector3d across = (1 - 3 * x * x + 2 * x * x * x) * a + (3 * x * x - 2 * x * x * x) * b;
    return along + across - e * e.dot(across) + h * (x - 2 * x * x + x * x * x) * slope_a +
           h * (x * x * x - x * x) * slope_b;
  };
  const double place[] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
  const double weight[] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
  double energy = 0;
  for (int i = 0; i < 4; ++i) {
    const Vector3d x = ends[0] + place[i] * chord + calc_shape(q, place[i]);
    energy += weight[i] * mass_per_length * h * (w.cross(x) + calc_shape(q_dot, place[i])).squaredNorm();
  }
  const auto stretch = [&](const VectorXd& v) -> Vector3d { return e * e.dot(v.segment<3>(6) - v.head<3>()); };
  return energy + mass_per_length * h / 12 * (w.cross(stretch(q)) + stretch(q_dot)).squaredNorm();
}

// The exact set is the quadratic form itself: kinetic energy of (ω, η̇) at a deformed state, bar by bar.
TEST(Integrals, ExactSetGivesTheKineticEnergy) {
  Diagnostics diagnostics;
  const auto model = fe::build_model(make_frame().deck, {}, diagnostics);
  const int n = 3;
  const MatrixXd Phi = make_random(model.num_gdofs(), n);
  const MatrixXd random = make_random(20, 1);
  const Vector3d w = random.block<3, 1>(3, 0);
  const VectorXd eta = 0.3 * random.block<3, 1>(6, 0), eta_dot = random.block<3, 1>(9, 0);
  const auto kind = MassKind::Consistent;

  const VectorXd q = Phi * eta, q_dot = Phi * eta_dot;
  double direct = 0;
  int bars = 0;
  for (const auto& element : model.elements()) {
    if (element->nodes().size() != 2) continue;
    const Vector3d ends[] = {model.node(element->nodes()[0]).x, model.node(element->nodes()[1]).x};
    direct += calc_bar_energy(ends, q(element->gdofs()), q_dot(element->gdofs()), w, kSection.rho * kSection.A);
    ++bars;
  }
  EXPECT_EQ(bars, 8);
  const auto& loaded = model.node(model.find_node(103));
  const Vector3d at = loaded.x + q.segment<3>(loaded.first_gdof);
  direct += 0.2 * (w.cross(at) + q_dot.segment<3>(loaded.first_gdof)).squaredNorm();

  const auto g = calc_exact_integrals(model, kind, Phi);
  const MatrixXd Phi_R = model.calc_rigid_modes();
  const MatrixXd rigid = Phi_R.transpose() * fe::calc_mass_times(model, kind, Phi_R);
  const MatrixXd modal_mass = Phi.transpose() * fe::calc_mass_times(model, kind, Phi);
  double energy = w.dot(rigid.bottomRightCorner(3, 3) * w) + eta_dot.dot(modal_mass * eta_dot);
  Matrix3d inertia = Matrix3d::Zero();
  Vector3d angular = g.gamma1 * eta_dot;
  for (int j = 0; j < n; ++j) {
    inertia += eta(j) * (g.gamma3[j] + g.gamma3[j].transpose());
    for (int k = 0; k < n; ++k) {
      inertia += eta(j) * eta(k) * g.gamma4[j][k];
      angular += eta(j) * eta_dot(k) * g.gamma2[j].col(k);
    }
  }
  energy += w.dot(inertia * w) + 2 * w.dot(angular);
  EXPECT_NEAR(energy / direct, 1, 1e-12);
}

// Where the mass of the grids is one in all directions the Gram matrix is made of the momentum formulas' products: the
// same as of the vectors e×φ themselves. A mass along one axis or between two grids' axes is not such: neither way may
// take it for one.
TEST(Integrals, ExactSetIsThatOfTheTurnedVectors) {
  const std::string frame =
      "SOL 103\nCEND\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,.1,0.\nGRID,3,,2.,-.1,.2\nSPOINT,9\n"
      "MAT1,1,70.+9,,.3,2700.\nPBAR,1,1,4.-4,3.-8,5.-8,6.-8\nCBAR,1,1,1,2,0.,0.,1.\nCBAR,2,1,2,3,0.,0.,1.\n"
      "CONM2,3,2,,.4\n";
  int number = 0;
  for (const std::string& more : {std::string(), std::string("CMASS2,7,.3,2,2\n"), std::string("CMASS2,7,.3,2,1,3,2\n"),
                                  std::string("CMASS2,7,.3,2,1,9\n")}) {
    Diagnostics diagnostics;
    const auto deck = nastran::read_deck_text(frame + more + "ENDDATA\n", "mass.bdf", {}, diagnostics);
    const auto model = fe::build_model(deck, {}, diagnostics);
    const MatrixXd Phi = make_random(model.num_gdofs(), 3);
    const Vector3d S(0.5, -0.7, 0.2);
    const auto mass_times = [&](const MatrixXd& X) -> MatrixXd {
      return fe::calc_mass_times(model, MassKind::Lumped, X);
    };
    const auto of_vectors = calc_exact_integrals(modal::NodalDofs::from_model(model), mass_times, Phi, S);
    EXPECT_LT(test::calc_difference(calc_exact_integrals(model, MassKind::Lumped, Phi, S), of_vectors), 1e-12)
        << number;
    const auto momentum = calc_momentum_integrals(model, MassKind::Lumped, Phi, S);
    if (number++ > 0)
      EXPECT_GT(test::calc_difference(momentum, of_vectors), 1e-3) << more;
    else
      EXPECT_LT(test::calc_difference(momentum, of_vectors), 1e-12);
  }
}

// Moving the reference: Γ1(S) = Γ1 - S × Γ0 and Γ3(S) = Γ3 - ((SᵀΓ0) 1 - Γ0 Sᵀ).
TEST(Integrals, ReferencePointShift) {
  Diagnostics diagnostics;
  const auto model = fe::build_model(make_frame().deck, {}, diagnostics);
  const MatrixXd Phi = make_random(model.num_gdofs(), 2);
  const Vector3d S(0.5, -0.7, 0.2);
  for (const bool exact : {false, true}) {
    const auto calc = [&](const Vector3d& at) {
      return exact ? calc_exact_integrals(model, MassKind::Consistent, Phi, at)
                   : calc_momentum_integrals(model, MassKind::Consistent, Phi, at);
    };
    const auto at_origin = calc(Vector3d::Zero()), at_S = calc(S);
    EXPECT_LT((at_S.gamma1 - (at_origin.gamma1 - skew(S) * at_origin.gamma0)).cwiseAbs().maxCoeff(), 1e-13);
    for (int j = 0; j < 2; ++j) {
      const Vector3d g0 = at_origin.gamma0.col(j);
      const Matrix3d shift = S.dot(g0) * Matrix3d::Identity() - g0 * S.transpose();
      EXPECT_LT((at_S.gamma3[j] - (at_origin.gamma3[j] - shift)).cwiseAbs().maxCoeff(), 1e-13) << exact;
    }
  }
}

// With a consistent mass the momentum set misses what sits on rotations: Γ0, Γ1 are exact, Γ3, Γ4 converge as h².
TEST(Integrals, ConsistentMomentumSetConvergesAsHSquared) {
  double error3[2], error4[2];
  for (int i = 0; i < 2; ++i) {
    Diagnostics diagnostics;
    const auto maker = test::make_cantilever(kSection, 1, 10 << i, false, {0.2, 0.3, 0.1});
    const auto model = fe::build_model(maker.deck, {}, diagnostics);
    modal::EigenOptions options;
    options.num_modes = 4;
    const auto pairs = calc_normal_modes(model, options, diagnostics);
    const auto momentum = calc_momentum_integrals(model, MassKind::Consistent, pairs.Phi);
    const auto exact = calc_exact_integrals(model, MassKind::Consistent, pairs.Phi);
    EXPECT_LT((momentum.gamma0 - exact.gamma0).norm(), 1e-12);
    EXPECT_LT((momentum.gamma1 - exact.gamma1).norm(), 1e-12);
    error3[i] = (momentum.gamma3[0] - exact.gamma3[0]).norm();
    error4[i] = (momentum.gamma4[0][0] - exact.gamma4[0][0]).norm();
  }
  EXPECT_NEAR(std::log2(error3[0] / error3[1]), 2, 0.1);
  EXPECT_NEAR(std::log2(error4[0] / error4[1]), 2, 0.1);
}

}  // namespace
}  // namespace bough
