/// Lanczos by blocks against eigenvalues known in closed form, and against Krylov-Schur on finite elements.
#include "modal/block_lanczos.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "fe/linear/factor.hpp"
#include "fe/linear/fixed_number.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "modal/eps_types.hpp"
#include "modal/extraction.hpp"
#include "modal/pencil.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

using modal::detail::BlockLanczosProblem;
using modal::detail::EigenProblem;
using modal::detail::solve_block_lanczos;

/// A = diag(a), B = diag(b): λ_i = a_i / b_i, θ_i = b_i / a_i.
struct Diagonal {
  VectorXd a, b;

  BlockLanczosProblem make(int width, int wanted) const {
    BlockLanczosProblem problem;
    problem.solve = [this](const Eigen::Ref<const MatrixXd>& X) { return MatrixXd(a.cwiseInverse().asDiagonal() * X); };
    problem.multiply_mass = [this](const Eigen::Ref<const MatrixXd>& X) { return MatrixXd(b.asDiagonal() * X); };
    problem.start.resize(a.size(), width);
    for (int c = 0; c < width; ++c)
      for (int i = 0; i < a.size(); ++i) problem.start(i, c) = linear::calc_fixed_number(i, c);
    problem.deflate.resize(a.size(), 0);
    problem.num_wanted = wanted;
    return problem;
  }
};

Diagonal make_chain(int n) {
  Diagonal matrices{VectorXd(n), VectorXd::Ones(n)};
  for (int i = 0; i < n; ++i) matrices.a(i) = std::pow(std::sin(0.5 * std::numbers::pi * (i + 1) / (n + 1)), 2);
  return matrices;
}

double calc_orthogonality(const Diagonal& matrices, const MatrixXd& X) {
  const MatrixXd G = X.transpose() * matrices.b.asDiagonal() * X;
  return (G - MatrixXd::Identity(G.rows(), G.cols())).cwiseAbs().maxCoeff();
}

TEST(BlockLanczos, FindsTheLowestOfAChain) {
  const auto matrices = make_chain(2000);
  for (int width : {1, 3, 4, 8}) {
    const auto result = solve_block_lanczos(matrices.make(width, 12));
    ASSERT_TRUE(result.is_done);
    ASSERT_EQ(result.theta.size(), 12);
    for (int i = 0; i < 12; ++i) EXPECT_NEAR(result.theta(i) * matrices.a(i), 1, 1e-11) << width << " " << i;
    EXPECT_LT(calc_orthogonality(matrices, result.X), 1e-12);
    for (int i = 0; i < 12; ++i) EXPECT_NEAR(std::abs(result.X(i, i)), 1, 1e-9);
  }
}

TEST(BlockLanczos, RestartsKeepWhatIsFound) {
  auto matrices = make_chain(3000);
  matrices.a = matrices.a.cwiseSqrt();  // closer together: slow
  auto problem = matrices.make(4, 10);
  problem.max_subspace = 24;
  const auto result = solve_block_lanczos(problem);
  ASSERT_TRUE(result.is_done);
  EXPECT_GT(4 * result.num_solves, 40);  // more vectors than fit at once
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(result.theta(i) * matrices.a(i), 1, 1e-11) << i;
  EXPECT_LT(calc_orthogonality(matrices, result.X), 1e-12);
}

TEST(BlockLanczos, FindsAsManyCopiesOfARootAsItsBlockIsWide) {
  auto matrices = make_chain(1000);
  matrices.a.segment(1, 4).setConstant(matrices.a(1));
  const auto result = solve_block_lanczos(matrices.make(4, 8));
  ASSERT_TRUE(result.is_done);
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(result.theta(i) * matrices.a(i), 1, 1e-11) << i;
}

TEST(BlockLanczos, StopsWhereTheMassHasNoMoreRank) {
  auto matrices = make_chain(200);
  matrices.b.tail(191).setZero();  // nine eigenvalues, and no more
  const auto result = solve_block_lanczos(matrices.make(4, 12));
  ASSERT_TRUE(result.is_done);
  ASSERT_GE(result.theta.size(), 9);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(result.theta(i) * matrices.a(i), 1, 1e-11) << i;
  EXPECT_TRUE((result.theta.tail(result.theta.size() - 9).array() < 1e-12 * result.theta(0)).all());
}

TEST(BlockLanczos, LeavesOutWhatIsKnown) {
  const auto matrices = make_chain(500);
  auto problem = matrices.make(4, 5);
  problem.deflate = MatrixXd::Identity(500, 3);
  const auto result = solve_block_lanczos(problem);
  ASSERT_TRUE(result.is_done);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(result.theta(i) * matrices.a(i + 3), 1, 1e-11) << i;
  EXPECT_LT(result.X.topRows(3).cwiseAbs().maxCoeff(), 1e-13);
}

/// As of a free body: what the basis lacks of orthogonality must not grow from block to block, else nothing converges
/// behind a restart.
TEST(BlockLanczos, StaysOrthogonalBesideKnownVectors) {
  constexpr int kKnown = 6, kWanted = 100;
  auto matrices = make_chain(3000);
  const double first = matrices.a(kKnown);
  matrices.a.head(kKnown).setConstant(1e-3 * first);
  auto problem = matrices.make(4, kWanted);
  problem.deflate = MatrixXd::Identity(3000, kKnown);
  problem.max_subspace = 160;
  const auto result = solve_block_lanczos(problem);
  ASSERT_TRUE(result.is_done);
  EXPECT_LT(result.num_solves, 150);
  for (int i = 0; i < kWanted; ++i) EXPECT_NEAR(result.theta(i) * matrices.a(kKnown + i), 1, 1e-11) << i;
  EXPECT_LT(calc_orthogonality(matrices, result.X), 1e-12);
  EXPECT_LT(result.X.topRows(kKnown).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(BlockLanczos, GuardsMayBeRough) {
  const auto matrices = make_chain(4000);
  auto problem = matrices.make(4, 12);
  const auto strict = solve_block_lanczos(problem);
  problem.num_guard = 2;
  const auto rough = solve_block_lanczos(problem);
  ASSERT_TRUE(rough.is_done);
  EXPECT_LE(rough.num_solves, strict.num_solves);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(rough.theta(i) * matrices.a(i), 1, 1e-11) << i;
  for (int i = 10; i < 12; ++i) EXPECT_NEAR(rough.theta(i) * matrices.a(i), 1, 1e-7) << i;
}

TEST(BlockLanczos, GivesUpWhenToldTo) {
  const auto matrices = make_chain(3000);
  auto problem = matrices.make(2, 20);
  problem.max_subspace = 24;
  problem.max_restarts = 1;
  EXPECT_FALSE(solve_block_lanczos(problem).is_done);
}

/// Two cantilevers side by side, 600 elements each: every root twice.
fe::Model make_pair(bool lumped, bool held, Diagnostics& diagnostics) {
  test::DeckMaker maker(lumped);
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-9, 2e-9, 2e-9});
  for (int i = 0; i < 2; ++i) {
    maker.add_line(1, 1000 * i + 1, {0, 1.0 * i, 0}, {1, 1.0 * i, 0}, 600, Vector3d::UnitY());
    if (held) maker.fix(1000 * i + 1, 123456);
  }
  return fe::build_model(maker.deck, {}, diagnostics);
}

void expect_like_krylov_schur(bool lumped, double shift, bool held) {
  Diagnostics diagnostics;
  const auto model = make_pair(lumped, held, diagnostics);
  const fe::System system(model);
  const modal::detail::Pencil pencil(system);
  EigenProblem problem;
  problem.A = pencil.K;
  problem.B = pencil.M;
  problem.shift = shift;
  problem.num_wanted = 14;
  problem.deflate.resize(model.num_fdofs(), 0);
  problem.solver = "krylovschur";
  const auto one = modal::detail::extract(problem);
  problem.solver = modal::detail::kBlockLanczos;
  const auto blocks = modal::detail::extract(problem);
  ASSERT_GE(one.values.size(), 14);
  ASSERT_EQ(blocks.values.size(), 14);
  VectorXd expected = one.values;
  std::sort(expected.begin(), expected.end());
  for (int i = 0; i < 14; ++i)
    EXPECT_NEAR(blocks.values(i) - shift, expected(i) - shift, 1e-8 * (expected(i) - shift)) << i;
  const MatrixXd R =
      pencil.calc_K_times(blocks.vectors) - pencil.calc_M_times(blocks.vectors) * blocks.values.asDiagonal();
  for (int i = 0; i < 14; ++i)
    EXPECT_LT(R.col(i).norm(), 1e-7 * pencil.K_diagonal.cwiseProduct(blocks.vectors.col(i)).norm()) << i;
}

TEST(BlockLanczos, AgreesWithKrylovSchurOnHeldBeams) {
  expect_like_krylov_schur(false, 0, true);
  expect_like_krylov_schur(true, 0, true);
}

TEST(BlockLanczos, AgreesWithKrylovSchurOnFreeBeams) { expect_like_krylov_schur(false, -1e4, false); }

TEST(Ordering, IsAPermutationThatKeepsTheDofsOfAGridTogether) {
  if (linear::initialize_petsc().size > 1) GTEST_SKIP() << "several processes leave the order to the solver";
  Diagnostics diagnostics;
  const auto model = make_pair(false, true, diagnostics);
  const auto K = fe::assemble_stiffness(model, fe::DofSet::Free);
  const auto order = linear::find_elimination_order(K);
  ASSERT_TRUE(static_cast<bool>(order));
  const std::vector<PetscInt>& rows = *order;
  const int size = model.num_fdofs();
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(size));
  std::vector<int> seen(size, 0);
  int jumps = 0;
  for (int i = 0; i < size; ++i) {
    ++seen[rows[i]];
    if (i > 0 && model.describe_fdof(rows[i]).first != model.describe_fdof(rows[i - 1]).first) ++jumps;
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int count) { return count == 1; }));
  EXPECT_EQ(jumps, 2 * 600 - 1);

  // Nested dissection of a line leaves little fill, and the factor solves.
  const auto factor = linear::SymmetricFactor::try_definite(K);
  ASSERT_TRUE(static_cast<bool>(factor));
  const MatrixXd X = MatrixXd::Ones(size, 3);
  const MatrixXd B = linear::multiply(K, X);
  const MatrixXd residual = linear::multiply(K, factor->solve(B)) - B;
  EXPECT_LT(residual.norm(), 1e-9 * linear::get_diagonal(K).norm());
}

// What is left of a matrix keeps its groups and its order: neighbours stay together, and the factor is the same size.
TEST(Ordering, RowsThatAreLeftKeepTheirGroups) {
  if (linear::initialize_petsc().size > 1) GTEST_SKIP() << "several processes leave the order to the solver";
  Diagnostics diagnostics;
  const auto model = make_pair(false, true, diagnostics);
  const auto K = fe::assemble_stiffness(model, fe::DofSet::Free);
  for (const bool is_ordered : {false, true}) {
    if (is_ordered) linear::find_elimination_order(K);
    std::vector<int> kept;
    for (int row = 0; row < model.num_fdofs(); ++row)
      if (row % 60 != 0 && row / 6 != 17) kept.push_back(row);
    const auto part = linear::take_kept(K, kept);
    const auto order = linear::find_elimination_order(part);
    ASSERT_TRUE(static_cast<bool>(order)) << is_ordered;
    const std::vector<PetscInt>& rows = *order;
    ASSERT_EQ(rows.size(), kept.size());
    std::vector<int> seen(rows.size(), 0);
    int jumps = 0;
    const auto get_node = [&](PetscInt row) { return model.describe_fdof(kept[row]).first; };
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ++seen[rows[i]];
      if (i > 0 && get_node(rows[i]) != get_node(rows[i - 1])) ++jumps;
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int count) { return count == 1; }));
    EXPECT_EQ(jumps, 2 * 600 - 2);  // a grid is gone
  }
}

}  // namespace
}  // namespace bough
