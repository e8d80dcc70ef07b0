/// Every eigensolution is a call of EPSSolve, by the EPS type that the table of choose_solver() names or the user asks
/// for. PETSc's own log of events counts the calls.
#include <gtest/gtest.h>
#include <slepceps.h>

#include <cmath>
#include <numbers>

#include "fe/linear/fixed_number.hpp"
#include "fe/loads/loads.hpp"
#include "fe/statics/statics.hpp"
#include "formats/nastran/reader.hpp"
#include "modal/bases/fixed_interface.hpp"
#include "modal/eps_types.hpp"
#include "modal/extraction.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

using linear::check_petsc;
using modal::detail::kBlockLanczos;
using modal::detail::kLowRank;

constexpr const char* kKrylovSchur = "krylovschur";

bool is_alone() { return linear::initialize_petsc().size == 1; }

/// Calls of what PETSc logs while it lives: a stage of its own, which no error within a call before can spoil.
class CallCount {
 public:
  CallCount() {
    modal::detail::initialize_slepc();
    static int number = 0;
    if (number == 0) check_petsc(PetscLogDefaultBegin());
    check_petsc(PetscLogStageRegister(("count " + std::to_string(number++)).c_str(), &stage_));
    check_petsc(PetscLogStagePush(stage_));
  }
  ~CallCount() { PetscLogStagePop(); }
  CallCount(const CallCount&) = delete;
  CallCount& operator=(const CallCount&) = delete;

  int get(const char* name = "EPSSolve") const {
    PetscLogEvent event = 0;
    PetscEventPerfInfo info;
    check_petsc(PetscLogEventGetId(name, &event));
    check_petsc(PetscLogEventGetPerfInfo(stage_, event, &info));
    return info.count;
  }

 private:
  PetscLogStage stage_ = 0;
};

int sum_solves(const std::vector<modal::SolverUse>& uses) {
  int sum = 0;
  for (const auto& use : uses) sum += use.num_solves;
  return sum;
}

/// The record of the answer is what EPSSolve was called for, by one EPS type; on several processes the type may differ.
template <class Solve>
EigenPairs expect_by(const char* type, const Solve& solve) {
  const CallCount count;
  const EigenPairs pairs = solve();
  const int calls = count.get();
  EXPECT_GE(calls, 1);
  EXPECT_GE(sum_solves(pairs.solvers), 1);
  EXPECT_LE(sum_solves(pairs.solvers), calls);
  EXPECT_FALSE(pairs.solvers.empty());
  for (const auto& use : pairs.solvers) {
    if (is_alone()) EXPECT_EQ(use.eps, type);
    EXPECT_EQ(use.st, "bough-factor");
    EXPECT_NE(use.factor, "");
  }
  return pairs;
}

EigenPairs solve(const fe::Model& model, int number, const std::string& solver = {}) {
  Diagnostics diagnostics;
  EigenOptions options;
  options.num_modes = number;
  options.solver = solver;
  return calc_normal_modes(model, options, diagnostics);
}

test::DeckMaker make_beam(int bars, bool is_held = true) {
  test::DeckMaker maker;
  maker.add_section(1, {70e9, 27e9, 2700, 1e-4, 1e-9, 3e-9, 4e-9});
  maker.add_line(1, 1, Vector3d::Zero(), {1, 0.3, 0.2}, bars, Vector3d::UnitY());
  if (is_held) maker.fix(1, 123456);
  return maker;
}

fe::Model build(const records::Deck& deck) {
  Diagnostics diagnostics;
  return fe::build_model(deck, {}, diagnostics);
}

/// A clamped square plate of n x n quadrilaterals.
fe::Model make_plate(int n) {
  std::string text = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nMAT1,1,7.+10,,.3,2700.\nPSHELL,1,1,.01,1,,1\n";
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      text += "GRID," + std::to_string(j * (n + 1) + i + 1) + ",," + std::to_string(1.0 * i / n) + "," +
              std::to_string(1.1 * j / n) + ",0.\n";
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i + 1;
      text += "CQUAD4," + std::to_string(j * n + i + 1) + ",1," + std::to_string(a) + "," + std::to_string(a + 1) +
              "," + std::to_string(a + n + 2) + "," + std::to_string(a + n + 1) + "\n";
    }
  text += "SPC1,1,123456,1,THRU," + std::to_string(n + 1) + "\nENDDATA\n";
  Diagnostics diagnostics;
  return build(nastran::read_deck_text(text, "plate.bdf", {}, diagnostics));
}

TEST(Eigensolver, SmallFrame) {
  const auto model = build(make_beam(7).deck);
  ASSERT_EQ(model.num_fdofs(), 42);
  expect_by(kLowRank, [&] { return solve(model, 10); });  // its mass has at most 42 columns
}

TEST(Eigensolver, AllModesOfASmallModel) {
  const auto model = build(make_beam(7).deck);
  expect_by(kLowRank, [&] { return solve(model, 42); });
}

TEST(Eigensolver, MediumFrame) {
  const auto model = build(make_beam(60).deck);
  ASSERT_EQ(model.num_fdofs(), 360);
  expect_by(kKrylovSchur, [&] { return solve(model, 10); });
}

TEST(Eigensolver, MassOfLowRank) {
  std::string text = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\nMAT1,1,7.+10,,.3\nPBAR,1,1,1.-3,1.-6,2.-6,1.-6\n";
  for (int i = 0; i <= 60; ++i) {
    text += "GRID," + std::to_string(i + 1) + ",," + std::to_string(0.5 * i) + ",0.,0.\n";
    if (i > 0)
      text += "CBAR," + std::to_string(i) + ",1," + std::to_string(i) + "," + std::to_string(i + 1) + ",0.,0.,1.\n";
    if (i % 3 == 0 && i > 0) text += "CONM2," + std::to_string(1000 + i) + "," + std::to_string(i + 1) + ",,2.5\n";
  }
  Diagnostics diagnostics;
  const auto model = build(nastran::read_deck_text(text + "SPC1,1,123456,1\nENDDATA\n", "stick.bdf", {}, diagnostics));
  const auto pairs = expect_by(kLowRank, [&] { return solve(model, 10); });
  const auto others = solve(model, 10, kKrylovSchur);
  EXPECT_EQ(others.solvers.front().eps, kKrylovSchur);
  for (int j = 0; j < 10; ++j) EXPECT_NEAR(pairs.lambda(j) / others.lambda(j), 1, 1e-9) << j;
}

TEST(Eigensolver, FiveThousandDofs) {
  const auto model = make_plate(29);
  ASSERT_GT(model.num_fdofs(), 5000);
  expect_by(kBlockLanczos, [&] { return solve(model, 10); });
}

TEST(Eigensolver, ThirtyThousandDofs) {
  const auto model = make_plate(71);
  ASSERT_GT(model.num_fdofs(), 30000);
  expect_by(kBlockLanczos, [&] { return solve(model, 10); });
}

TEST(Eigensolver, FreeBody) {
  const auto model = build(make_beam(60, false).deck);
  const auto pairs = expect_by(kKrylovSchur, [&] { return solve(model, 12); });
  EXPECT_EQ(pairs.num_rigid + pairs.num_massless, 6);
}

TEST(Eigensolver, Range) {
  const auto model = build(make_beam(120).deck);
  const auto all = solve(model, 120);
  EigenOptions options;
  options.num_modes = 5;
  options.min_hz = 0.5 * (std::sqrt(all.lambda(89)) + std::sqrt(all.lambda(90))) / (2 * std::numbers::pi);
  const auto pairs = expect_by(kKrylovSchur, [&] {
    Diagnostics diagnostics;
    return calc_normal_modes(model, options, diagnostics);
  });
  ASSERT_EQ(pairs.lambda.size(), 5);
  for (int j = 0; j < 5; ++j) EXPECT_NEAR(pairs.lambda(j) / all.lambda(90 + j), 1, 1e-9) << j;
}

TEST(Eigensolver, Buckling) {
  auto maker = make_beam(20);
  maker.add_load(10, 21, {-1, 0, 0});
  const auto model = build(maker.deck);
  Diagnostics diagnostics;
  const auto K = fe::assemble_stiffness(model, fe::DofSet::Free);
  const fe::StaticSolver statics(model, K);
  const auto load = calc_applied_load(model, maker.deck, 10, diagnostics);
  const VectorXd u = statics.solve(load.F).col(0);
  EigenOptions options;
  options.num_modes = 4;
  expect_by(kKrylovSchur, [&] { return calc_buckling_modes(model, load, u, options, diagnostics); });
}

TEST(Eigensolver, FixedInterface) {
  Diagnostics diagnostics;
  const auto model = build(make_beam(30).deck);
  const fe::System system(model);
  const modal::bases::FixedInterface fixed(system, {31}, diagnostics);
  const CallCount count;
  const auto modes = fixed.calc_modes(6, std::nullopt, diagnostics);
  EXPECT_EQ(count.get(), sum_solves(modes.check.solvers));
  EXPECT_GE(sum_solves(modes.check.solvers), 1);
}

// As of a root with more copies than a search sees.
TEST(Eigensolver, FactorThatIsKept) {
  const auto model = build(make_beam(30).deck);
  const fe::System system(model);
  modal::detail::EigenProblem problem;
  problem.A = system.K;
  problem.B = system.M;
  problem.num_wanted = 4;
  problem.deflate.resize(model.num_fdofs(), 0);
  modal::detail::FactoredHandle kept;
  problem.kept = &kept;
  const auto first = extract(problem);
  const auto made = kept;
  ASSERT_TRUE(made);
  problem.deflate = first.vectors;
  const auto next = extract(problem);
  EXPECT_EQ(kept, made);
  EXPECT_GT(next.values.minCoeff(), first.values.head(4).maxCoeff());
}

// Types of SLEPc and of Bough find the same modes of the same model.
TEST(Eigensolver, TypeThatIsAskedFor) {
  if (!is_alone()) GTEST_SKIP() << "a shell for the preconditioner and LAPACK are for one process";
  const auto model = build(make_beam(60).deck);
  const auto expected = solve(model, 8);
  for (const char* type : {kKrylovSchur, kBlockLanczos, "lanczos", "arnoldi", "subspace", "lapack", "gd", "lobpcg"}) {
    const auto pairs = solve(model, 8, type);
    ASSERT_EQ(pairs.lambda.size(), 8) << type;
    for (int j = 0; j < 8; ++j) EXPECT_NEAR(pairs.lambda(j) / expected.lambda(j), 1, 1e-8) << type << " " << j;
    ASSERT_FALSE(pairs.solvers.empty()) << type;
    EXPECT_EQ(pairs.solvers.front().eps, type);
  }
}

TEST(Eigensolver, FreeBodyByLapack) {
  if (!is_alone()) GTEST_SKIP() << "LAPACK is for one process";
  const auto model = build(make_beam(12, false).deck);
  const auto expected = solve(model, 14), pairs = solve(model, 14, "lapack");
  ASSERT_EQ(pairs.lambda.size(), 14);
  ASSERT_EQ(pairs.num_rigid, expected.num_rigid);
  for (int j = pairs.num_rigid; j < 14; ++j) EXPECT_NEAR(pairs.lambda(j) / expected.lambda(j), 1, 1e-8) << j;
}

TEST(Eigensolver, UnsuitedTypeIsRefused) {
  const auto model = build(make_beam(60).deck);  // a mass of high rank
  try {
    solve(model, 4, kLowRank);
    FAIL() << "no error";
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().front().id, "modal.unsuited-solver");
  }
}

TEST(Eigensolver, Names) {
  EXPECT_EQ(modal::find_eps_type("block-lanczos"), kBlockLanczos);
  EXPECT_EQ(modal::find_eps_type("bough-low-rank"), kLowRank);
  EXPECT_EQ(modal::find_eps_type("krylovschur"), kKrylovSchur);
  try {
    modal::find_eps_type("lanczoss");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.items().front().id, "modal.unknown-solver");
    EXPECT_NE(error.items().front().advice.find("block-lanczos"), std::string::npos);
  }
}

// The table of docs/theory/modes.md, row by row.
TEST(Eigensolver, Choice) {
  modal::detail::SolverFacts facts;
  facts.num_rows = 5000;
  facts.num_wanted = 20;
  facts.room = 5000;
  EXPECT_EQ(choose_solver(facts), kBlockLanczos);
  const auto with = [&](const auto& change) {
    auto other = facts;
    change(other);
    return choose_solver(other);
  };
  EXPECT_EQ(with([](auto& f) { f.has_low_rank = true; }), kLowRank);
  EXPECT_EQ(with([](auto& f) { f.num_rows = 4999; }), kKrylovSchur);
  EXPECT_EQ(with([](auto& f) { f.num_rows = 4999, f.has_many_copies = true; }), kBlockLanczos);
  EXPECT_EQ(with([](auto& f) { f.is_definite = false; }), kKrylovSchur);
  EXPECT_EQ(with([](auto& f) { f.is_near_shift = false; }), kKrylovSchur);
  EXPECT_EQ(with([](auto& f) { f.num_wanted = 1250; }), kKrylovSchur);
}

/// SLEPc's own interface to the types of Bough: eigenvalues, eigenvectors and errors of diag(1..n) x = λ x.
TEST(Eigensolver, BlockLanczosIsAnEpsType) {
  if (!is_alone()) GTEST_SKIP() << "the operator of this test is one of whole vectors";
  modal::detail::initialize_slepc();
  constexpr PetscInt n = 400, number = 6;
  linear::PetscMat A, B;
  for (linear::PetscMat* matrix : {&A, &B}) {
    check_petsc(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 1, nullptr, matrix->out()));
    for (PetscInt i = 0; i < n; ++i)
      check_petsc(MatSetValue(matrix->get(), i, i, matrix == &A ? i + 1.0 : 1.0, INSERT_VALUES));
    check_petsc(MatAssemblyBegin(matrix->get(), MAT_FINAL_ASSEMBLY));
    check_petsc(MatAssemblyEnd(matrix->get(), MAT_FINAL_ASSEMBLY));
  }
  const VectorXd a = VectorXd::LinSpaced(n, 1, n);
  modal::detail::FactoredOperator op;
  op.solve = [&](const Eigen::Ref<const MatrixXd>& X) { return MatrixXd(a.cwiseInverse().asDiagonal() * X); };
  op.multiply_mass = [](const Eigen::Ref<const MatrixXd>& X) { return MatrixXd(X); };
  linear::PetscHandle<EPS, EPSDestroy> eps;
  ST st = nullptr;
  check_petsc(EPSCreate(PETSC_COMM_SELF, eps.out()));
  check_petsc(EPSSetOperators(eps.get(), A.get(), B.get()));
  check_petsc(EPSSetProblemType(eps.get(), EPS_GHEP));
  check_petsc(EPSSetType(eps.get(), kBlockLanczos));
  check_petsc(EPSSetDimensions(eps.get(), number, PETSC_DEFAULT, PETSC_DEFAULT));
  check_petsc(EPSSetTolerances(eps.get(), 1e-12, 100));
  check_petsc(EPSSetTarget(eps.get(), 0));
  check_petsc(EPSGetST(eps.get(), &st));
  set_operator(st, op);
  modal::detail::BlockLanczosSettings settings;
  settings.start.resize(n, 3);
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) settings.start(i, c) = linear::calc_fixed_number(i, c);
  settings.deflation.resize(n, 0);
  set_settings(eps.get(), settings);
  check_petsc(EPSSolve(eps.get()));
  PetscInt converged = 0;
  check_petsc(EPSGetConverged(eps.get(), &converged));
  ASSERT_GE(converged, number);
  for (PetscInt i = 0; i < number; ++i) {
    PetscScalar value = 0;
    PetscReal error = 0;
    check_petsc(EPSGetEigenvalue(eps.get(), i, &value, nullptr));
    check_petsc(EPSComputeError(eps.get(), i, EPS_ERROR_RELATIVE, &error));
    EXPECT_NEAR(value, i + 1, 1e-10);
    EXPECT_LT(error, 1e-8);
  }
}

}  // namespace
}  // namespace bough
