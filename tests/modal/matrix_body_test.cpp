/// Integrals and gains from plain matrices and a dof map: against the model they came from, with dofs missing and in
/// any order.
#include "modal/matrix_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/support/modal.hpp"

namespace bough {
namespace {

using Eigen::MatrixXi;
using modal::MatrixModel;
using modal::NodalDofs;

const test::Section kSection = {70e9, 27e9, 2700, 1e-4, 1e-9, 3e-9, 2e-9};

struct Given {
  MatrixModel model;
  MatrixXd Phi_of_model;
  fe::Model fe_model;
};

/// The consistent mass of a bent frame, its dofs shuffled, as another program might hand it over.
Given make_given() {
  test::DeckMaker maker;
  maker.add_section(1, kSection);
  maker.add_line(1, 1, {0.3, 0.1, -0.2}, {1.3, 0.4, 0}, 3, Vector3d::UnitY());
  maker.add_line(1, 101, {1.3, 0.4, 0}, {1.5, 1.4, 0.7}, 2, Vector3d::UnitX(), 4);
  Diagnostics diagnostics;
  auto fe_model = fe::build_model(maker.deck, {}, diagnostics);
  const int ndof = fe_model.num_gdofs();
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const MatrixXd Phi = MatrixXd::NullaryExpr(ndof, 3, [&] { return uniform(generator); });
  std::vector<int> order(static_cast<std::size_t>(ndof));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), generator);

  const MatrixXd M = fe::calc_mass_times(fe_model, fe::MassKind::Consistent, MatrixXd::Identity(ndof, ndof));
  MatrixModel model;
  model.dofs.xyz.resize(ndof / 6, 3);
  MatrixXi dof_map(ndof, 2);
  MatrixXd shuffled(ndof, ndof), xyz(ndof / 6, 3);
  model.Phi.resize(ndof, 3);
  for (int i = 0; i < ndof; ++i) {
    const int g = order[static_cast<std::size_t>(i)];
    dof_map.row(i) << g / 6 + 1, g % 6 + 1;
    model.Phi.row(i) = Phi.row(g);
    for (int j = 0; j < ndof; ++j) shuffled(i, j) = M(g, order[static_cast<std::size_t>(j)]);
  }
  for (const auto& node : fe_model.nodes()) xyz.row(node.first_gdof / 6) = node.x;
  model.M = shuffled.sparseView();
  model.K = 3 * model.M;
  model.dofs = NodalDofs::from_map(dof_map, xyz);
  model.mass = 1;
  return {std::move(model), Phi, std::move(fe_model)};
}

TEST(MatrixBody, ShuffledDofsGiveTheIntegralsOfTheModel) {
  const auto given = make_given();
  const Vector3d S(0.4, -0.2, 0.9);
  auto model = given.model;
  model.reference = S;
  Diagnostics diagnostics;
  const auto body = calc_matrix_body(model, {1, 4}, diagnostics);
  const auto kind = fe::MassKind::Consistent;
  EXPECT_LT(test::calc_difference(body.consistent,
                                  modal::calc_momentum_integrals(given.fe_model, kind, given.Phi_of_model, S)),
            1e-13);
  // A matrix does not tell where the mass between grids is: "exact" is by e×φ at the grids, and the body says so.
  const auto mass_times = [&](const MatrixXd& X) { return fe::calc_mass_times(given.fe_model, kind, X); };
  EXPECT_LT(test::calc_difference(body.exact, modal::calc_exact_integrals(NodalDofs::from_model(given.fe_model),
                                                                          mass_times, given.Phi_of_model, S)),
            1e-13);
  EXPECT_EQ(body.masses, "nodal momenta");
  EXPECT_EQ(body.phi[1], given.Phi_of_model.middleRows(18, 6));
  EXPECT_LT((body.node_xyz.row(1) - (model.dofs.xyz.row(3) - S.transpose())).norm(), 1e-15);
  EXPECT_LT((body.modal_stiffness - 3 * body.modal_mass).norm(), 1e-12);
}

// A dof that the map does not have is as one that carries nothing and does not move.
TEST(MatrixBody, AMissingDofCountsAsZero) {
  const auto given = make_given();
  const auto& full = given.model;
  auto cut = full;
  const int row = full.dofs.row(2, 1), last = full.dofs.num_dofs - 1;
  MatrixXd M = MatrixXd(full.M);
  auto zeroed = full;
  zeroed.Phi.row(row).setZero();
  M.row(row).setZero();
  M.col(row).setZero();
  zeroed.M = M.sparseView();
  // The last row takes the place of the one left out.
  M.row(row).swap(M.row(last));
  M.col(row).swap(M.col(last));
  cut.M = MatrixXd(M.topLeftCorner(last, last)).sparseView();
  cut.K = cut.M;
  cut.Phi.row(row) = full.Phi.row(last);
  cut.Phi.conservativeResize(last, Eigen::NoChange);
  cut.dofs.num_dofs = last;
  cut.dofs.row = cut.dofs.row.unaryExpr([&](int r) { return r == row ? -1 : r == last ? row : r; });
  Diagnostics diagnostics;
  const auto a = calc_matrix_body(cut, {3}, diagnostics), b = calc_matrix_body(zeroed, {3}, diagnostics);
  EXPECT_LT(test::calc_difference(a.consistent, b.consistent), 1e-14);
  EXPECT_LT(test::calc_difference(a.exact, b.exact), 1e-14);
  EXPECT_TRUE(a.phi[0].row(1).isZero(0));
  EXPECT_EQ(a.phi[0], b.phi[0]);
}

TEST(MatrixBody, DampingByRatioIsForUnitGeneralizedMass) {
  auto model = make_given().model;
  model.zeta = 0.02;
  Diagnostics diagnostics;
  const auto body = calc_matrix_body(model, {}, diagnostics);
  EXPECT_TRUE(diagnostics.has("modal.damping-not-normalized"));
  EXPECT_LT((body.modal_damping - MatrixXd(Eigen::Vector3d::Constant(0.04 * std::sqrt(3)).asDiagonal())).norm(), 1e-14);

  for (int j = 0; j < 3; ++j) model.Phi.col(j) /= std::sqrt(body.modal_mass(j, j));
  Diagnostics quiet;
  calc_matrix_body(model, {}, quiet);
  EXPECT_TRUE(quiet.items().empty());
}

TEST(MatrixBody, AModeWithoutMassIsRefused) {
  auto model = make_given().model;
  model.Phi.col(1).setZero();
  Diagnostics diagnostics;
  try {
    calc_matrix_body(model, {}, diagnostics);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.items()[0].id, "modal.no-modal-mass");
  }
}

}  // namespace
}  // namespace bough
