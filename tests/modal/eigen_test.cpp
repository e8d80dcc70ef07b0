/// The eigenvalue solver itself: repeated roots, ranges, small and singular problems, messages.
#include "modal/eigen.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/matrices/vector_products.hpp"
#include "modal/modes_result.hpp"
#include "modal/roundoff.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/modal.hpp"

namespace bough {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const Section kSection = {70e9, 27e9, 2700, 1e-4, 1e-11, 1e-11, 2e-11};

/// Identical separate cantilevers of 12 elements: every root has twice as many copies.
DeckMaker make_cantilevers(int count, bool lumped = false) {
  DeckMaker maker(lumped);
  maker.add_section(1, kSection);
  for (int i = 0; i < count; ++i) {
    maker.add_line(1, 100 * i + 1, {0, 1.0 * i, 0}, {1, 1.0 * i, 0}, 12, Vector3d::UnitY());
    maker.fix(100 * i + 1, 123456);
  }
  return maker;
}

EigenPairs solve(const records::Deck& deck, const EigenOptions& options, Diagnostics& diagnostics) {
  const auto model = fe::build_model(deck, {}, diagnostics);
  return calc_normal_modes(model, options, diagnostics);
}

EigenOptions make_options(int num_modes) {
  EigenOptions options;
  options.num_modes = num_modes;
  return options;
}

double to_hz(double lambda) { return std::sqrt(lambda) / (2 * std::numbers::pi); }

TEST(Eigen, FindsEveryCopyOfARepeatedRoot) {
  Diagnostics diagnostics;
  const auto maker = make_cantilevers(7);
  const auto pairs = solve(maker.deck, make_options(28), diagnostics);
  ASSERT_EQ(pairs.lambda.size(), 28);
  EXPECT_EQ(pairs.inertia_count, 28);
  for (int j = 0; j < 28; ++j) EXPECT_NEAR(pairs.lambda(j) / pairs.lambda(j / 14 * 14), 1, 1e-9) << j;
  EXPECT_NEAR(std::sqrt(pairs.lambda(14) / pairs.lambda(0)), 22.0344916 / 3.5160153, 1e-3);
  EXPECT_FALSE(diagnostics.has("modal.cut-root"));
}

TEST(Eigen, CutThroughARootWarnsAndKeepsItsBasis) {
  Diagnostics few, many;
  const auto maker = make_cantilevers(3);
  const auto cut = solve(maker.deck, make_options(4), few);
  const auto whole = solve(maker.deck, make_options(6), many);
  EXPECT_TRUE(few.has("modal.cut-root"));
  EXPECT_FALSE(many.has("modal.cut-root"));
  EXPECT_EQ(cut.inertia_count, 6);
  EXPECT_LT((cut.Phi - whole.Phi.leftCols(4)).cwiseAbs().maxCoeff(), 1e-6 * whole.Phi.cwiseAbs().maxCoeff());
}

// The basis of a repeated root is the model's: bending in y and in z stay apart, and the largest entry is positive.
TEST(Eigen, BasisOfAPairIsPureAndPositive) {
  Diagnostics diagnostics;
  const auto maker = test::make_cantilever(kSection, 1, 30);
  const auto pairs = solve(maker.deck, make_options(4), diagnostics);
  for (int j = 0; j < 4; ++j) {
    const int own = j % 2 == 0 ? 1 : 2, other = 3 - own;
    double largest = 0;
    for (int k = 0; k < 31; ++k) {
      EXPECT_LT(std::abs(pairs.Phi(6 * k + other, j)), 1e-8) << j;
      largest = std::max(largest, std::abs(pairs.Phi(6 * k + own, j)));
    }
    EXPECT_GT(largest, 1);
    EXPECT_GT(pairs.Phi.col(j).maxCoeff(), -pairs.Phi.col(j).minCoeff());
  }
}

// The dense path (many modes wanted) and Krylov-Schur agree.
TEST(Eigen, DenseAndKrylovAgree) {
  Diagnostics diagnostics;
  const auto maker = test::make_cantilever({70e9, 27e9, 2700, 1e-4, 1e-9, 3e-9, 2e-9}, 1, 20);
  const auto krylov = solve(maker.deck, make_options(8), diagnostics);
  const auto dense = solve(maker.deck, make_options(60), diagnostics);
  ASSERT_EQ(dense.lambda.size(), 60);
  EXPECT_EQ(dense.inertia_count, 60);
  for (int j = 0; j < 8; ++j) {
    EXPECT_NEAR(krylov.lambda(j) / dense.lambda(j), 1, 1e-8);
    EXPECT_LT((krylov.Phi.col(j) - dense.Phi.col(j)).norm(), 1e-6 * dense.Phi.col(j).norm());
  }
}

// Lumped bars: three modes per free grid and no more.
TEST(Eigen, FewerModesThanAskedFor) {
  Diagnostics diagnostics;
  const auto maker = test::make_cantilever(kSection, 1, 3, true);
  const auto pairs = solve(maker.deck, make_options(20), diagnostics);
  EXPECT_EQ(pairs.lambda.size(), 9);
  EXPECT_EQ(pairs.inertia_count, 9);
  EXPECT_TRUE(diagnostics.has("modal.fewer-modes"));
  Diagnostics quiet;
  const auto long_beam = test::make_cantilever(kSection, 1, 40, true);
  EXPECT_EQ(solve(long_beam.deck, make_options(500), quiet).lambda.size(), 120);
  EXPECT_TRUE(quiet.has("modal.fewer-modes"));
}

// A straight line has five motions with mass and no strain. Three are asked for: the count has the others too, and
// nothing is said of copies.
TEST(Eigen, CountsTheZerosThatAreLeftOut) {
  DeckMaker maker(false);
  maker.add_section(1, kSection);
  maker.add_line(1, 1, Vector3d::Zero(), Vector3d::UnitX(), 10, Vector3d::UnitY());
  Diagnostics diagnostics;
  const auto pairs = solve(maker.deck, make_options(3), diagnostics);
  EXPECT_EQ(pairs.lambda.size(), 3);
  EXPECT_EQ(pairs.num_rigid, 3);
  EXPECT_EQ(pairs.inertia_count, 5);
  EXPECT_FALSE(diagnostics.has("modal.cut-root"));
}

TEST(Eigen, RangeOfFrequencies) {
  Diagnostics diagnostics;
  const auto maker = test::make_cantilever(kSection, 1, 30);
  const auto all = solve(maker.deck, make_options(8), diagnostics);
  EigenOptions options;
  options.num_modes = 0;
  options.min_hz = 0.5 * (to_hz(all.lambda(1)) + to_hz(all.lambda(2)));
  options.max_hz = 0.5 * (to_hz(all.lambda(5)) + to_hz(all.lambda(6)));
  const auto some = solve(maker.deck, options, diagnostics);
  ASSERT_EQ(some.lambda.size(), 4);
  EXPECT_NEAR(some.lambda(0) / all.lambda(2), 1, 1e-9);
  EXPECT_EQ(some.inertia_count, 6);

  options.min_hz = to_hz(all.lambda(1)) * 1.01;
  options.max_hz = to_hz(all.lambda(1)) * 1.02;
  EXPECT_EQ(solve(maker.deck, options, diagnostics).lambda.size(), 0);
  EXPECT_TRUE(diagnostics.has("modal.empty-range"));
}

// A pinned strut turns freely about its end: not one of the six motions of the whole, found as a zero all the same.
TEST(Eigen, MechanismBeyondTheRigidMotionsIsAZero) {
  DeckMaker maker(true);
  maker.add_section(1, kSection);
  maker.add_line(1, 1, Vector3d::Zero(), Vector3d::UnitX(), 10, Vector3d::UnitY());
  maker.fix(1, 123456);
  maker.add_line(1, 101, Vector3d::UnitX(), {1, 1, 0}, 10, Vector3d::UnitX(), 11);
  for (auto& beam : maker.deck.beams)
    if (beam.id == 101) beam.pin_a = 0b110000;  // bending moments released at the joint
  Diagnostics diagnostics;
  const auto pairs = solve(maker.deck, make_options(8), diagnostics);
  EXPECT_EQ(pairs.num_rigid, 2);
  EXPECT_EQ(pairs.lambda(1), 0);
  EXPECT_GT(pairs.lambda(2), 1);
  EXPECT_EQ(pairs.inertia_count, 8);
}

// Simply supported about the axis only: fewer than six.
TEST(Eigen, PartlySupportedModelKeepsTheRestOfItsRigidMotions) {
  DeckMaker maker;
  maker.add_section(1, kSection, true);
  maker.add_line(1, 1, {5, 0, 0}, {6, 0, 0}, 30, Vector3d::UnitY());
  maker.fix(1, 123);
  Diagnostics diagnostics;
  const auto pairs = solve(maker.deck, make_options(7), diagnostics);
  EXPECT_EQ(pairs.num_rigid, 3);
  EXPECT_EQ(pairs.inertia_count, 7);
  // Pinned-free: βL = 3.926602.
  const double w = 3.92660231 * 3.92660231 * std::sqrt(kSection.E * kSection.I1 / (kSection.rho * kSection.A));
  EXPECT_NEAR(std::sqrt(pairs.lambda(3)) / w, 1, 1e-4);
}

// A finer mesh and a heavy far tip: stiffness over many orders of magnitude, still complete.
TEST(Eigen, FineMeshWithHeavyTip) {
  auto maker = test::make_cantilever(kSection, 1, 400);
  maker.add_mass(5000, 401, 100);
  Diagnostics diagnostics;
  const auto pairs = solve(maker.deck, make_options(4), diagnostics);
  EXPECT_EQ(pairs.inertia_count, 4);
  // Massless cantilever with the tip mass plus 33/140 of its own.
  const double w2 = 3 * kSection.E * kSection.I1 / (100 + 33.0 / 140 * kSection.rho * kSection.A);
  EXPECT_NEAR(pairs.lambda(0) / w2, 1, 1e-5);
  EXPECT_NEAR(pairs.lambda(1) / w2, 1, 1e-5);
}

// 2500 elements where 25 would do: K has lost a visible part of the first root in roundoff, its elements have not.
TEST(Eigen, RestoresTheRootOfAMeshTooFine) {
  Diagnostics fine, normal, of_K;
  const auto pairs = solve(test::make_cantilever(kSection, 1, 2500).deck, make_options(2), fine);
  EXPECT_EQ(pairs.inertia_count, 2);
  EXPECT_TRUE(fine.has("modal.lost-digits"));
  const auto coarse = solve(test::make_cantilever(kSection, 1, 100).deck, make_options(2), normal);
  EXPECT_FALSE(normal.has("modal.roundoff"));
  EXPECT_FALSE(normal.has("modal.lost-digits"));
  for (int j = 0; j < 2; ++j) EXPECT_NEAR(pairs.lambda(j) / coarse.lambda(j), 1, 1e-6) << j;
}

// What the measure by K alone says of such a mode, where elements are too large to be taken apart.
TEST(Eigen, WarnsOfRoundoff) {
  Diagnostics d;
  const auto maker = test::make_cantilever(kSection, 1, 4);
  const auto model = fe::build_model(maker.deck, {}, d);
  const fe::System system(model);
  const modal::detail::Pencil pencil(system);
  MatrixXd X = MatrixXd::Ones(pencil.size(), 1);
  const double parts = pencil.K_diagonal.sum();
  modal::detail::warn_of_roundoff(pencil, VectorXd::Constant(1, 1e-8 * parts), X, 0, d);
  EXPECT_FALSE(d.has("modal.roundoff"));
  modal::detail::warn_of_roundoff(pencil, VectorXd::Constant(1, 1e-15 * parts), X, 0, d);
  EXPECT_TRUE(d.has("modal.roundoff"));
}

template <class Function>
std::string get_error(Function function) {
  try {
    function();
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "";
}

TEST(Eigen, ErrorsNameTheCause) {
  Diagnostics diagnostics;
  auto fixed = test::make_cantilever(kSection, 1, 2);
  fixed.fix_all(123456);
  EXPECT_THAT(get_error([&] { solve(fixed.deck, make_options(2), diagnostics); }), HasSubstr("modal.no-dofs"));
  auto massless = test::make_cantilever({70e9, 27e9, 0, 1e-4, 1e-9, 1e-9, 2e-9}, 1, 2);
  EXPECT_THAT(get_error([&] { solve(massless.deck, make_options(2), diagnostics); }), HasSubstr("modal.no-mass"));
}

// Two grids with a spring between them that nothing else holds or weighs: named, and the modes are those without.
TEST(Eigen, MasslessPartIsHeldAndNamed) {
  for (const int count : {3, 40}) {
    auto maker = test::make_cantilever(kSection, 1, count);
    Diagnostics none;
    const VectorXd expected = solve(maker.deck, make_options(2), none).lambda;
    maker.add_grid(777, {5, 5, 5});
    maker.add_grid(778, {5, 5, 6});
    records::ScalarSpring spring;
    spring.id = 900;
    spring.k = 1e5;
    spring.g1 = 777;
    spring.g2 = 778;
    spring.c1 = spring.c2 = 3;
    maker.deck.springs.push_back(spring);
    maker.deck.params.push_back({"AUTOSPC", "NO", {}});
    Diagnostics diagnostics;
    const VectorXd lambda = solve(maker.deck, make_options(2), diagnostics).lambda;
    ASSERT_EQ(lambda.size(), 2);
    EXPECT_LT((lambda - expected).norm(), 1e-9 * expected.norm());
    EXPECT_TRUE(diagnostics.has("fe.null-dofs"));
    std::string said;
    for (const auto& item : diagnostics.items()) said += item.what;
    EXPECT_THAT(said, HasSubstr("grid 777"));
  }
}

// An absurd negative spring puts an eigenvalue out of the solver's reach: the count tells that the list is not
// complete.
TEST(Eigen, MissedModesAreNotPassedOver) {
  auto maker = test::make_cantilever(kSection, 1, 60);
  records::ScalarSpring spring;
  spring.id = 900;
  spring.k = -1e30;
  spring.g1 = 61;
  spring.c1 = 1;
  maker.deck.springs.push_back(spring);
  maker.deck.params.push_back({"AUTOSPC", "NO", {}});
  Diagnostics diagnostics;
  EXPECT_THAT(get_error([&] { solve(maker.deck, make_options(2), diagnostics); }), HasSubstr("modal.missed-modes"));
}

/// A spring to ground pulls far below zero: Lanczos from just below the first root does not see that root.
TEST(Eigen, FindsARootFarBelowZero) {
  for (const int elements : {60, 200}) {
    auto maker = test::make_cantilever(kSection, 1, elements);
    records::ScalarSpring spring;
    spring.id = 900;
    spring.k = -3e8;
    spring.g1 = elements / 2 + 1;
    spring.c1 = 1;
    maker.deck.springs.push_back(spring);
    Diagnostics diagnostics;
    const auto model = fe::build_model(maker.deck, {}, diagnostics);
    for (const int number : {1, 3, 5}) {  // bending comes in pairs
      const auto pairs = calc_normal_modes(model, make_options(number), diagnostics);
      ASSERT_EQ(pairs.lambda.size(), number);
      EXPECT_LT(pairs.lambda(0), -1e8);
      EXPECT_LT(pairs.residual.maxCoeff(), 1e-8);
      EXPECT_EQ(pairs.inertia_count, number);
    }
  }
}

records::Deck make_long_beam() { return test::make_cantilever(kSection, 1, 1000).deck; }

TEST(Eigen, StiffnessGivesItsMemoryBackAndIsMadeAgain) {
  Diagnostics diagnostics;
  const auto model = fe::build_model(make_long_beam(), {}, diagnostics);
  const fe::System system(model);
  const MatrixXd X = MatrixXd::Random(model.num_fdofs(), 2), before = linear::multiply(system.K, X);
  ASSERT_TRUE(fe::drop_stiffness(system.K));
  EXPECT_LT(linear::multiply(system.K, X).norm(), 0.5 * before.norm());  // what is left: parts of pages
  fe::restore_stiffness(model, system.K);
  EXPECT_EQ(linear::multiply(system.K, X), before);
  EXPECT_FALSE(fe::drop_stiffness(linear::scale(system.K, 1)));  // on arrays of PETSc's
}

TEST(Eigen, ModesAreTheSameWithTheStiffnessAway) {
  Diagnostics diagnostics;
  auto options = make_options(6);
  const auto kept = solve(make_long_beam(), options, diagnostics);
  options.least_rows_to_release = 0;
  const auto away = solve(make_long_beam(), options, diagnostics);
  EXPECT_EQ(away.lambda, kept.lambda);
  EXPECT_EQ(away.Phi, kept.Phi);
  EXPECT_EQ(away.residual, kept.residual);
  EXPECT_EQ(away.inertia_count, 6);
}

/// 200 bars alike: the first root has 400 copies, of which one vector at a time sees no more than roundoff shows; what
/// it took for roots must not stand in the way of the others.
TEST(Eigen, HundredsOfCopiesInASmallModel) {
  DeckMaker maker(true);
  maker.add_section(1, kSection);
  for (int i = 0; i < 200; ++i) {
    maker.add_line(1, 10 * i + 1, {0, 1.0 * i, 0}, {1, 1.0 * i, 0}, 1, Vector3d::UnitY());
    maker.fix(10 * i + 1, 123456);
  }
  Diagnostics diagnostics;
  const auto pairs = solve(maker.deck, make_options(60), diagnostics);
  ASSERT_EQ(pairs.lambda.size(), 60);
  EXPECT_EQ(pairs.inertia_count, 400);
  EXPECT_LT(pairs.residual.maxCoeff(), 1e-9);
  const double lambda = 3 * kSection.E * kSection.I1 / (0.5 * kSection.rho * kSection.A);  // half the bar's mass
  EXPECT_LT((pairs.lambda / lambda - VectorXd::Ones(60)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Eigen, KnowsModalMassAndEnergyOfEachMode) {
  Diagnostics diagnostics;
  const auto model = fe::build_model(make_cantilevers(3).deck, {}, diagnostics);
  const auto pairs = calc_normal_modes(model, make_options(7), diagnostics);
  const MatrixXd M_Phi = fe::calc_mass_times(model, model.mass_kind(), pairs.Phi);
  ASSERT_EQ(pairs.modal_mass.size(), 7);
  for (int j = 0; j < 7; ++j) EXPECT_NEAR(pairs.modal_mass(j), pairs.Phi.col(j).dot(M_Phi.col(j)), 1e-14);
  ASSERT_EQ(pairs.energy_share.size(), 7);
  EXPECT_GT(pairs.energy_share.minCoeff(), 1e-14);
}

/// More modes than are multiplied at a time: orthonormal, small residuals, effective masses as M of all of them has it.
TEST(Eigen, ManyModesGoSomeColumnsAtATime) {
  Diagnostics diagnostics;
  const auto model = fe::build_model(make_cantilevers(5).deck, {}, diagnostics);
  const auto pairs = calc_normal_modes(model, make_options(150), diagnostics);
  ASSERT_EQ(pairs.lambda.size(), 150);
  EXPECT_LT(pairs.residual.maxCoeff(), 1e-8);
  const MatrixXd M_Phi = fe::calc_mass_times(model, model.mass_kind(), pairs.Phi);
  EXPECT_LT((pairs.Phi.transpose() * M_Phi - MatrixXd::Identity(150, 150)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(
      (fe::calc_mass_gram(model, model.mass_kind(), pairs.Phi) - pairs.Phi.transpose() * M_Phi).cwiseAbs().maxCoeff(),
      1e-13);
  auto without = pairs;
  without.modal_mass.resize(0);
  const auto known = make_modes_result(model, pairs, false), made = make_modes_result(model, without, false);
  EXPECT_LT((known.modal_mass - made.modal_mass).cwiseAbs().maxCoeff(), 1e-14);
  const MatrixXd L = M_Phi.transpose() * model.calc_rigid_modes();
  const MatrixXd wanted = L.cwiseAbs2();  // of modal mass 1
  EXPECT_LT((made.effective_mass - wanted).cwiseAbs().maxCoeff(), 1e-11 * wanted.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace bough
