#include "fe/matrices/assembly.hpp"

#include <gtest/gtest.h>

#include "fe/linear/factor.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/statics.hpp"
#include "tests/fe/model/spring_model.hpp"

namespace bough::fe {
namespace {

using namespace test;

MatrixXd to_dense(const linear::SymmetricMatrix& A, int size) { return multiply(A, MatrixXd::Identity(size, size)); }

Model make_clamped(Diagnostics& diagnostics) {
  auto deck = make_deck(make_points());
  deck.subcases[0].spc = 1;
  deck.spc.push_back(make_spc(1, 1, 63));
  return build_model(deck, {}, make_links({{1, 2}, {2, 3}, {3, 4}, {4, 5}, {2, 6}, {6, 4}}), diagnostics);
}

TEST(AssemblyMpi, stiffness_equals_dense_sum) {
  Diagnostics diagnostics;
  const Model model = make_clamped(diagnostics);
  const MatrixXd K = sum_stiffness(model);
  EXPECT_LT((to_dense(assemble_stiffness(model, DofSet::Global), model.num_gdofs()) - K).norm(), 1e-13 * K.norm());
  const MatrixXd T = model.T();
  ASSERT_EQ(model.num_fdofs(), 30);
  EXPECT_LT((to_dense(assemble_stiffness(model, DofSet::Free), model.num_fdofs()) - T.transpose() * K * T).norm(),
            1e-13 * K.norm());
}

TEST(AssemblyMpi, products_equal_matrices) {
  Diagnostics diagnostics;
  const Model model = make_clamped(diagnostics);
  const MatrixXd X = make_random(model.num_gdofs(), 3, 5);
  const MatrixXd K_X = sum_stiffness(model) * X;
  EXPECT_LT((calc_stiffness_times(model, X) - K_X).norm(), 1e-13 * K_X.norm());
  for (const MassKind kind : {MassKind::Lumped, MassKind::Consistent}) {
    const MatrixXd M_X = multiply(assemble_mass(model, DofSet::Global, kind), X);
    EXPECT_LT((calc_mass_times(model, kind, X) - M_X).norm(), 1e-13 * M_X.norm());
    EXPECT_GT(M_X.norm(), 1);
  }
}

TEST(AssemblyMpi, gather_inverts_scatter) {
  Diagnostics diagnostics;
  const Model model = make_clamped(diagnostics);
  const linear::SymmetricMatrix K = assemble_stiffness(model, DofSet::Free);
  linear::PetscVec v;
  linear::check_petsc(MatCreateVecs(K.sparse(), v.out(), nullptr));
  const VectorXd x = make_random(model.num_fdofs(), 1, 8);
  linear::scatter(x, v.get());
  EXPECT_EQ(linear::gather(v.get()), x);
}

TEST(StaticsMpi, solution_balances_the_load) {
  Diagnostics diagnostics;
  const Model model = make_clamped(diagnostics);
  const StaticSolver solver(model, assemble_stiffness(model, DofSet::Free));
  MatrixXd F = make_random(model.num_gdofs(), 4, 3);
  F.topRows(6).setZero();
  const MatrixXd u = solver.solve(F);
  EXPECT_EQ(u.topRows(6).norm(), 0);
  const MatrixXd residual = (sum_stiffness(model) * u - F).bottomRows(model.num_gdofs() - 6);
  EXPECT_LT(residual.norm(), 1e-11 * F.norm());
}

}  // namespace
}  // namespace bough::fe
