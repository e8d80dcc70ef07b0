/// K_G1, K_G2: against the dense projection, independence of the support, Southwell's coefficients.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rotation.hpp"
#include "fe/loads/second_order.hpp"
#include "stiffening/reduce.hpp"
#include "tests/support/modal.hpp"
#include "tests/support/threads.hpp"

namespace bough {
namespace {

using fe::DofSet;
using stiffening::calc_generalized_geometric_stiffness;

/// A frame in space without any support.
DeckMaker make_free_frame() {
  DeckMaker maker;
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-8, 3e-8, 2e-8}, true);
  maker.add_line(1, 1, {0.3, 0.1, -0.2}, {1.3, 0.4, 0}, 6, Vector3d::UnitY());
  maker.add_line(1, 101, {1.3, 0.4, 0}, {1.5, 1.4, 0.7}, 6, Vector3d::UnitX(), 7);
  maker.add_line(1, 201, {1.3, 0.4, 0}, {2.0, 0.2, -0.9}, 6, Vector3d::UnitY(), 7);
  maker.add_mass(900, 107, 0.4);
  return maker;
}

modal::EigenPairs calc_modes(const fe::Model& model, int count) {
  Diagnostics diagnostics;
  modal::EigenOptions options;
  options.num_modes = count;
  return modal::calc_normal_modes(model, options, diagnostics);
}

// Element by element equals ΦᵀK_G(u)Φ with the assembled matrix, for few loads and for many; linear in u.
TEST(GeometricStiffness, EqualsTheDenseProjection) {
  auto maker = make_free_frame();
  maker.fix(1, 123456);
  Diagnostics diagnostics;
  const auto model = fe::build_model(maker.deck, {}, diagnostics);
  const auto pairs = calc_modes(model, 5);
  const auto K = fe::assemble_stiffness(model, DofSet::Free);
  const fe::StaticSolver solver(model, K);
  const fe::AppliedLoads loads{fe::calc_inertial_loads(model, model.mass_kind()), MatrixXd::Identity(12, 12), {}};
  const auto take = [&](const MatrixXd& mix) { return fe::AppliedLoads{loads.F * mix, loads.A_I * mix, {}}; };
  const MatrixXd U = solver.solve(loads.F);
  const auto many = calc_generalized_geometric_stiffness(model, loads, U, pairs.Phi);
  const auto few =
      calc_generalized_geometric_stiffness(model, take(MatrixXd::Identity(12, 2)), U.leftCols(2), pairs.Phi);
  for (int c = 0; c < 12; ++c) {
    const auto K_G =
        fe::assemble_geometric_stiffness(model, DofSet::Global, {loads.F.col(c), loads.A_I.col(c), {}}, U.col(c));
    MatrixXd projected(5, 5);
    for (int j = 0; j < 5; ++j) {
      linear::PetscVec x, y;
      linear::check_petsc(MatCreateVecs(K_G.sparse(), x.out(), y.out()));
      linear::scatter(pairs.Phi.col(j), x.get());
      linear::check_petsc(MatMult(K_G.sparse(), x.get(), y.get()));
      projected.col(j) = pairs.Phi.transpose() * linear::gather(y.get());
    }
    const double scale = projected.cwiseAbs().maxCoeff();
    ASSERT_GT(scale, 0);
    EXPECT_LT((many[c] - projected).cwiseAbs().maxCoeff(), 1e-10 * scale) << c;
    if (c >= 2) continue;
    EXPECT_LT((few[c] - projected).cwiseAbs().maxCoeff(), 1e-10 * scale) << c;
  }
  const Eigen::VectorXd mix = 2 * Eigen::VectorXd::Unit(12, 0) - 3 * Eigen::VectorXd::Unit(12, 8);
  const auto sum = calc_generalized_geometric_stiffness(model, take(mix), U * mix, pairs.Phi).front();
  EXPECT_LT((sum - (2 * many[0] - 3 * many[8])).cwiseAbs().maxCoeff(), 1e-10 * sum.cwiseAbs().maxCoeff());
}

// Two threads sum a half of the elements each, few modes by products and many by rows.
TEST(GeometricStiffness, OfTwoThreadsIsThatOfOne) {
  DeckMaker maker;
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-8, 3e-8, 2e-8}, true);
  maker.add_line(1, 1, {0.3, 0.1, -0.2}, {1.3, 0.4, 0}, 300, Vector3d::UnitY());
  maker.add_line(1, 1001, {1.3, 0.4, 0}, {1.5, 1.4, 0.7}, 300, Vector3d::UnitX(), 301);
  maker.add_mass(9000, 1100, 0.4);
  maker.fix(1, 123456);
  Diagnostics diagnostics;
  const auto model = fe::build_model(maker.deck, {}, diagnostics);
  const auto K = fe::assemble_stiffness(model, DofSet::Free);
  const fe::StaticSolver solver(model, K);
  const fe::AppliedLoads loads{fe::calc_inertial_loads(model, model.mass_kind()), MatrixXd::Identity(12, 12), {}};
  const MatrixXd U = solver.solve(loads.F);
  const MatrixXd Phi = solver.solve(MatrixXd::Random(U.rows(), 45));
  const auto calc_by = [&](int num_threads, int num) {
    const test::Threads threads(num_threads);
    return calc_generalized_geometric_stiffness(model, loads, U, Phi.leftCols(num));
  };
  for (const int num : {5, 45}) {
    const auto one = calc_by(1, num), two = calc_by(2, num);
    ASSERT_EQ(one.size(), two.size());
    // Rotations and displacements of short elements cancel: 1e-16 (1 / length)².
    for (std::size_t c = 0; c < one.size(); ++c)
      EXPECT_LT((one[c] - two[c]).cwiseAbs().maxCoeff(), 1e-10 * one[c].cwiseAbs().maxCoeff()) << num << " " << c;
  }
}

// The loads on a body balance as a whole, so the sum of all K_G does not know which support each was solved on.
TEST(GeometricStiffness, BalancedLoadsDoNotFeelTheSupport) {
  Diagnostics diagnostics;
  const auto maker = make_free_frame();
  const auto model = fe::build_model(maker.deck, {}, diagnostics);
  const auto pairs = calc_modes(model, 12);
  ASSERT_EQ(pairs.num_rigid, 6);
  const MatrixXd Phi = pairs.Phi.rightCols(6);

  // Forces and moments at two nodes, and the acceleration they cause while the body spins.
  const int tip = model.node(model.find_node(207)).first_gdof, root = model.node(model.find_node(1)).first_gdof;
  MatrixXd F(model.num_gdofs(), 16);
  F.leftCols(12) = stiffening::calc_inertial_loads(model, model.mass_kind());
  F.rightCols(4).setZero();
  const MatrixXd A_I = MatrixXd::Identity(12, 16);
  F(tip, 12) = F(tip + 2, 13) = F(root + 1, 14) = F(root + 4, 15) = 1;
  VectorXd amount(16);
  const Vector3d w(0.5, 0.9, -1.3);
  amount << VectorXd::Zero(6), w.cwiseAbs2(), w.x() * w.y(), w.x() * w.z(), w.y() * w.z(), 2, -1.5, 0.7, 0.3;
  const MatrixXd Phi_R = model.calc_rigid_modes();
  const MatrixXd mass = Phi_R.transpose() * fe::calc_mass_times(model, model.mass_kind(), Phi_R);
  amount.head(6) = mass.ldlt().solve(Phi_R.transpose() * (F * amount));
  ASSERT_LT((Phi_R.transpose() * (F * amount)).norm(), 1e-12);

  const auto K = fe::assemble_stiffness(model, DofSet::Free);
  std::vector<MatrixXd> sums;
  for (const int node : {1, 107, 0}) {
    const fe::StaticSolver solver(model, K, fe::choose_determinate_support(model, node));
    const auto K_G = calc_generalized_geometric_stiffness(model, {F, A_I, {}}, solver.solve(F), Phi);
    MatrixXd sum = MatrixXd::Zero(6, 6);
    for (int c = 0; c < 16; ++c) sum += amount(c) * K_G[c];
    sums.push_back(sum);
  }
  const double scale = sums[0].cwiseAbs().maxCoeff();
  ASSERT_GT(scale, 1e-3);
  EXPECT_LT((sums[1] - sums[0]).cwiseAbs().maxCoeff(), 1e-8 * scale);
  EXPECT_LT((sums[2] - sums[0]).cwiseAbs().maxCoeff(), 1e-8 * scale);
}

// K_G1(ωz²) of the cantilever's bending modes: Southwell's K0 (Rayleigh quotient of the tension ρAΩ²(L²-x²)/2 with the
// non-rotating modes), and K1 from the centripetal -Ω²L of a hub of radius L. The mass between grids is pulled where it
// is: 40 elements give the digits of the reference.
TEST(GeometricStiffness, SouthwellCoefficients) {
  const double K0[] = {1.193336, 6.478225, 17.859520, 36.055388};
  const double K1[] = {1.570878, 8.647143, 24.952113, 51.459105};
  double error[2];
  for (int i = 0; i < 2; ++i) {
    Diagnostics diagnostics;
    const auto maker = test::make_cantilever({70e9, 27e9, 2700, 1e-4, 1e-9, 3e-9, 2e-9}, 3, 40 << i);
    records::BodySpec spec;
    spec.num_modes = 9;
    const auto body = stiffening::reduce(maker.deck, spec, {}, diagnostics).body;
    int found = 0;
    for (int j = 0; j < 9 && found < 4; ++j) {
      if (body.effective_mass(j, 2) < 1e-3 * body.mass) continue;  // bending in z: out of the plane of ωz
      const double k0 = body.kg_inertial[static_cast<int>(InertialLoad::wz2)](j, j);
      const double k1 = -3 * body.kg_inertial[static_cast<int>(InertialLoad::ax)](j, j);
      EXPECT_NEAR(k0 / K0[found], 1, i ? 1e-3 : 4e-3) << found;
      EXPECT_NEAR(k1 / K1[found], 1, i ? 1e-3 : 4e-3) << found;
      if (found == 0) error[i] = std::abs(k0 / K0[0] - 1);
      ++found;
    }
    EXPECT_EQ(found, 4);
  }
  EXPECT_LT(error[0], 1e-6);
  EXPECT_LT(error[1], 1e-6);
}

}  // namespace
}  // namespace bough
