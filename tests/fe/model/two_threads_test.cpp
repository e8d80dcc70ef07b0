/// What two threads do in halves, against one; and what a factor will take, against what it takes.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "fe/linear/factor.hpp"
#include "fe/linear/ordering.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/factor_need.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/element_recovery.hpp"
#include "tests/fe/model/text_model.hpp"
#include "tests/support/threads.hpp"

namespace bough::fe {
namespace {

using Eigen::MatrixXd;

using bough::test::Threads;

/// num x num plates, curved so that no entry is zero; `mixed`: grids numbered from both sides in turn, so that elements
/// have rows in both halves.
std::string write_shell(int num, bool mixed = false) {
  std::string text = "MAT1,1,7.+10,,0.3,2700.\nPSHELL,1,1,0.01,1,,1\n";
  const int m = num + 1;
  const auto id = [&](int x, int y) {
    const int k = y * m + x;
    return 1 + (mixed ? (k % 2 == 0 ? k / 2 : m * m - 1 - k / 2) : k);
  };
  for (int y = 0; y <= num; ++y)
    for (int x = 0; x <= num; ++x)
      text += "GRID," + std::to_string(id(x, y)) + ",," + std::to_string(0.1 * x) + "," + std::to_string(0.1 * y) +
              "," + std::to_string(0.01 * (x * x + x * y) / num) + "\n";
  for (int y = 0; y < num; ++y)
    for (int x = 0; x < num; ++x)
      text += "CQUAD4," + std::to_string(y * num + x + 1) + ",1," + std::to_string(id(x, y)) + "," +
              std::to_string(id(x + 1, y)) + "," + std::to_string(id(x + 1, y + 1)) + "," +
              std::to_string(id(x, y + 1)) + "\n";
  // Held on one side.
  for (int x = 0; x <= num; ++x) text += "SPC1,1,123456," + std::to_string(id(x, 0)) + "\n";
  return "SPC = 1\nBEGIN BULK\n" + text;
}

void expect_same(const linear::SymmetricMatrix& A, const linear::SymmetricMatrix& B) {
  PetscBool equal = PETSC_FALSE;
  linear::check_petsc(MatEqual(A.sparse(), B.sparse(), &equal));
  EXPECT_TRUE(equal);
}

TEST(TwoThreads, AssembleTheSameBitForBit) {
  if (linear::initialize_petsc().size > 1) GTEST_SKIP() << "several processes have one thread each";
  for (const bool mixed : {false, true}) {
    const Model model = test::build(write_shell(46, mixed));
    ASSERT_GT(model.num_fdofs(), 10000);
    const auto assemble_by = [&](int num) {
      const Threads threads(num);
      return std::pair(assemble_stiffness(model, DofSet::Free),
                       assemble_mass(model, DofSet::Free, MassKind::Consistent));
    };
    const auto one = assemble_by(1), two = assemble_by(2);
    expect_same(one.first, two.first);
    expect_same(one.second, two.second);
    // The same rows belong together: the order of elimination is the same.
    const auto first = linear::find_elimination_order(one.first), second = linear::find_elimination_order(two.first);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(*first, *second);
  }
}

TEST(TwoThreads, HoldTheSameDofs) {
  if (linear::initialize_petsc().size > 1) GTEST_SKIP() << "several processes have one thread each";
  // Rods along a bent line: a grid has stiffness along them, one where they bend in a plane.
  constexpr int num_rods = 4500;
  std::string deck = "BEGIN BULK\nMAT1,1,7.+10,,0.3,2700.\nPROD,1,1,1.-4\n";
  for (int i = 0; i <= num_rods; ++i)
    deck += "GRID," + std::to_string(i + 1) + ",," + std::to_string(0.1 * i) + "," + std::to_string(0.05 * i) + "," +
            std::to_string(i % 3 == 0 ? 0.1 : 0.0) + "\n";
  for (int i = 1; i <= num_rods; ++i)
    deck += "CROD," + std::to_string(i) + ",1," + std::to_string(i) + "," + std::to_string(i + 1) + "\n";
  const auto list = [&](int num) {
    const Threads threads(num);
    Diagnostics diagnostics;
    const auto cards = nastran::read_deck_text(deck, "deck.bdf", {}, diagnostics);
    const Model model = build_model(cards, {}, diagnostics);
    std::vector<std::pair<int, int>> held;
    for (const AutospcEntry& entry : model.autospc()) held.emplace_back(entry.node, entry.component);
    return held;
  };
  const auto one = list(1);
  EXPECT_GT(one.size(), 4u * num_rods);
  EXPECT_EQ(one, list(2));
}

TEST(TwoThreads, MultiplyTheSame) {
  if (linear::initialize_petsc().size > 1) GTEST_SKIP() << "several processes have one thread each";
  const Model model = test::build(write_shell(46));
  const linear::SymmetricMatrix K = assemble_stiffness(model, DofSet::Free);
  const MatrixXd X = MatrixXd::Random(model.num_fdofs(), 7), X_g = MatrixXd::Random(model.num_gdofs(), 3);
  const MatrixXd B = MatrixXd::Random(model.num_fdofs(), 7);
  const auto multiply_by = [&](int num) {
    const Threads threads(num);
    return std::array<MatrixXd, 3>{multiply(K, X), calc_residual(K, X, B), calc_stiffness_times(model, X_g)};
  };
  const auto one = multiply_by(1), two = multiply_by(2);
  EXPECT_EQ(one[0], two[0]);
  EXPECT_EQ(one[1], two[1]);
  EXPECT_LT((one[2] - two[2]).cwiseAbs().maxCoeff(), 1e-14 * one[2].cwiseAbs().maxCoeff());
  // By another code: PETSc's own product.
  linear::PetscVec x, y;
  linear::check_petsc(MatCreateVecs(K.sparse(), x.out(), y.out()));
  for (const int c : {0, 6}) {
    PetscScalar* values = nullptr;
    linear::check_petsc(VecGetArray(x.get(), &values));
    Eigen::VectorXd::Map(values, X.rows()) = X.col(c);
    linear::check_petsc(VecRestoreArray(x.get(), &values));
    linear::check_petsc(MatMult(K.sparse(), x.get(), y.get()));
    const PetscScalar* found = nullptr;
    linear::check_petsc(VecGetArrayRead(y.get(), &found));
    const Eigen::VectorXd expected = Eigen::VectorXd::Map(found, X.rows());
    linear::check_petsc(VecRestoreArrayRead(y.get(), &found));
    EXPECT_LT((one[0].col(c) - expected).cwiseAbs().maxCoeff(), 1e-14 * expected.cwiseAbs().maxCoeff());
    EXPECT_LT((one[1].col(c) - (B.col(c) - expected)).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff());
  }
}

TEST(TwoThreads, RecoverTheSameBitForBit) {
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(write_shell(30) + "PARAM,AUTOSPC,NO\n", "deck.bdf", {}, diagnostics);
  const Model model = build_model(deck, {}, diagnostics);
  const Eigen::VectorXd u = Eigen::VectorXd::Random(model.num_gdofs()), v = Eigen::VectorXd::Random(model.num_gdofs());
  const std::vector<RecoveryCase> cases{{&u, 0, nullptr, nullptr}, {&v, 0, nullptr, nullptr}};
  const auto recover_by = [&](int num) {
    const Threads threads(num);
    return recover_elements(model, deck, cases, {true, true, true});
  };
  const auto one = recover_by(1), two = recover_by(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t c = 0; c < one.size(); ++c) {
    ASSERT_EQ(one[c].forces.size(), 1u);
    ASSERT_EQ(one[c].forces[0].force.rows(), 900);
    EXPECT_GT(one[c].forces[0].force.cwiseAbs().rowwise().sum().minCoeff(), 0);
    EXPECT_EQ(one[c].forces[0].force, two[c].forces[0].force);
    EXPECT_EQ(one[c].forces[0].strain_energy, two[c].forces[0].strain_energy);
    ASSERT_EQ(one[c].stresses.size(), 1u);
    EXPECT_EQ(one[c].stresses[0].stress, two[c].stresses[0].stress);
    ASSERT_EQ(one[c].strains.size(), 1u);
    EXPECT_EQ(one[c].strains[0].stress, two[c].strains[0].stress);
    EXPECT_EQ(one[c].strains[0].corner, two[c].strains[0].corner);
  }
}

TEST(FactorNeed, IsAboutWhatTheFactorTakes) {
  if (linear::initialize_petsc().size > 1) GTEST_SKIP() << "one process factors by CHOLMOD";
  const auto expect_about = [](const std::string& deck) {
    const Model model = test::build(deck);
    const linear::SymmetricMatrix K = assemble_stiffness(model, DofSet::Free);
    const auto factor = linear::SymmetricFactor::try_definite(K);
    ASSERT_TRUE(factor);
    const double estimate = estimate_factor_entries(model);
    EXPECT_GT(estimate, 0.7 * factor->num_entries());
    EXPECT_LT(estimate, 1.4 * factor->num_entries());
  };
  expect_about(write_shell(50));
  std::string solids = "MAT1,1,7.+10,,0.3,2700.\nPSOLID,1,1\n";
  constexpr int num = 11, m = num + 1;
  const auto id = [](int x, int y, int z) { return std::to_string(1 + x + m * (y + m * z)); };
  for (int z = 0; z < m; ++z)
    for (int y = 0; y < m; ++y)
      for (int x = 0; x < m; ++x)
        solids +=
            "GRID," + id(x, y, z) + ",," + std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z) + "\n";
  for (int z = 0, e = 0; z < num; ++z)
    for (int y = 0; y < num; ++y)
      for (int x = 0; x < num; ++x)
        solids += "CHEXA," + std::to_string(++e) + ",1," + id(x, y, z) + "," + id(x + 1, y, z) + "," +
                  id(x + 1, y + 1, z) + "," + id(x, y + 1, z) + "," + id(x, y, z + 1) + "," + id(x + 1, y, z + 1) +
                  ",+\n+," + id(x + 1, y + 1, z + 1) + "," + id(x, y + 1, z + 1) + "\n";
  expect_about("SPC = 1\nBEGIN BULK\n" + solids + "SPC1,1,123,1,THRU," + std::to_string(m * m) +
               "\nSPC1,1,456,1,THRU," + std::to_string(m * m * m) + "\n");
}

}  // namespace
}  // namespace bough::fe
