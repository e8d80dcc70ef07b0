/// Mass matrices of low rank: point masses on massless structures, tied by RBE2, RBE3 and MPC.
#include "modal/low_rank.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "fe/matrices/assembly.hpp"
#include "formats/nastran/reader.hpp"
#include "modal/bases/fixed_interface.hpp"
#include "modal/eps_types.hpp"
#include "modal/extraction.hpp"
#include "modal/pencil.hpp"
#include "modal/pencil_solver.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kE = 7e10, kNu = 0.3, kA = 1e-4, kI1 = 1e-9, kI2 = 1.5e-9, kJ = 2e-9, kHeight = 1;

/// Stiffness at the tip of a leg along z, clamped at its foot: Euler-Bernoulli, the inverse of the tip's flexibility.
/// I1 bends in the plane of z and v = x.
Matrix6 calc_leg() {
  const double L = kHeight;
  Matrix6 F = Matrix6::Zero();
  const double ex = kE * kI1, ey = kE * kI2;
  F(0, 0) = L * L * L / (3 * ex), F(0, 4) = F(4, 0) = L * L / (2 * ex), F(4, 4) = L / ex;
  F(1, 1) = L * L * L / (3 * ey), F(1, 3) = F(3, 1) = -L * L / (2 * ey), F(3, 3) = L / ey;
  F(2, 2) = L / (kE * kA);
  F(5, 5) = L / (kE / (2 * (1 + kNu)) * kJ);
  return F.inverse();
}

/// The motion of a point at r from a rigid body's own.
Matrix6 calc_rigid(const Vector3d& r) {
  Matrix6 X = Matrix6::Identity();
  X(0, 4) = r.z(), X(0, 5) = -r.y(), X(1, 3) = -r.z(), X(1, 5) = r.x(), X(2, 3) = r.y(), X(2, 4) = -r.x();
  return X;
}

/// λ of K x = λ M x with M of full rank, ascending.
VectorXd calc_lambda(const MatrixXd& K, const MatrixXd& M) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M).eigenvalues();
}

enum class Tie { Rbe2, Rbe3, Mpc };

std::vector<Vector3d> make_places(int legs) {
  std::vector<Vector3d> places;
  for (int i = 0; i < legs; ++i) {
    const double angle = 2 * std::numbers::pi * i / legs + 0.3;
    places.emplace_back(0.2 * std::cos(angle), 0.3 * std::sin(angle), 0);
  }
  return places;
}

/// Massless legs of `bars` bars that carry a mass of 10 with inertia 0.1, 0.2, 0.3 at their middle (MPC: each leg a
/// mass of its own, the tops tied in x and z).
std::string make_text(Tie tie, int legs, int bars, bool is_free = false) {
  std::string text = std::string("SOL 103\nCEND\n") + (is_free ? "" : "SPC=1\n") + (tie == Tie::Mpc ? "MPC=1\n" : "") +
                     "BEGIN BULK\nMAT1,1,7.+10,,.3\nPBAR,1,1,1.-4,1.-9,1.5-9,2.-9\n";
  const auto places = make_places(legs);
  const auto number = [](double v) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.15g", v);
    return std::string(buffer).find_first_of(".e") == std::string::npos ? std::string(buffer) + "." : buffer;
  };
  for (int leg = 0; leg < legs; ++leg) {
    const int first = 10000 * (leg + 1);
    for (int i = 0; i <= bars; ++i)
      text += "GRID*," + std::to_string(first + i) + ",," + number(places[leg].x()) + "," + number(places[leg].y()) +
              "\n*," + number(kHeight * i / bars) + "\n";
    for (int i = 0; i < bars; ++i)
      text += "CBAR," + std::to_string(first + i) + ",1," + std::to_string(first + i) + "," +
              std::to_string(first + i + 1) + ",1.,0.,0.\n";
    if (!is_free) text += "SPC1,1,123456," + std::to_string(first) + "\n";
    if (tie == Tie::Mpc) {
      const std::string top = std::to_string(first + bars), before = std::to_string(first - 10000 + bars);
      text += "CONM2," + std::to_string(leg + 1) + "," + top + ",,10.\n,.1,,.2,,,.3\n";
      if (leg > 0)
        for (const char* c : {"1", "3"}) text += "MPC,1," + top + "," + c + ",1.," + before + "," + c + ",-1.\n";
    }
  }
  if (tie != Tie::Mpc) text += "GRID,1,,0.,0.,1.\nCONM2,1,1,,10.\n,.1,,.2,,,.3\n";
  if (tie == Tie::Rbe2)
    for (int leg = 1; leg <= legs; ++leg)
      text += "RBE2," + std::to_string(leg) + ",1,123456," + std::to_string(10000 * leg + bars) + "\n";
  if (tie == Tie::Rbe3) {
    text += "RBE3,2,,1,123456,1.,123";
    for (int leg = 1; leg <= legs; ++leg) text += (leg == 3 ? "\n," : ",") + std::to_string(10000 * leg + bars);
    text += "\n";
  }
  return text + "ENDDATA\n";
}

VectorXd calc_expected(Tie tie, int legs) {
  const Matrix6 K_leg = calc_leg();
  const Matrix6 M = (VectorXd(6) << 10, 10, 10, .1, .2, .3).finished().asDiagonal();
  const auto places = make_places(legs);
  const int n = 6 * legs;
  if (tie == Tie::Rbe2) {
    Matrix6 K = Matrix6::Zero();
    for (const auto& r : places) K += calc_rigid(r).transpose() * K_leg * calc_rigid(r);
    return calc_lambda(K, M);
  }
  MatrixXd K = MatrixXd::Zero(n, n), H;
  for (Eigen::Index i = 0; i < legs; ++i) K.block<6, 6>(6 * i, 6 * i) = K_leg;
  if (tie == Tie::Rbe3) {
    // The mean motion of the tops by least squares of their translations: u = (Xᵀ X)⁻¹ Xᵀ u_tops.
    MatrixXd X = MatrixXd::Zero(n, 6);
    for (int i = 0; i < legs; ++i) X.middleRows<3>(6 * i) = calc_rigid(places[i]).topRows<3>();
    H = (X.transpose() * X).inverse() * X.transpose();
    // The mass sees H u: statically condensed on it, K_H = (H K⁻¹ Hᵀ)⁻¹.
    return calc_lambda((H * K.inverse() * H.transpose()).inverse(), M);
  }
  // x and z of every top are those of the first.
  MatrixXd Z = MatrixXd::Zero(n, 2 + 4 * legs);
  int column = 2;
  for (int i = 0; i < legs; ++i) {
    Z(6 * i, 0) = Z(6 * i + 2, 1) = 1;
    for (const int c : {1, 3, 4, 5}) Z(6 * i + c, column++) = 1;
  }
  MatrixXd M_all = MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < legs; ++i) M_all.block<6, 6>(6 * i, 6 * i) = M;
  return calc_lambda(Z.transpose() * K * Z, Z.transpose() * M_all * Z);
}

fe::Model build(const std::string& text, Diagnostics& diagnostics) {
  const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
  fe::ModelOptions options;
  return fe::build_model(deck, options, diagnostics);
}

EigenPairs solve(const std::string& text, int number, Diagnostics& diagnostics) {
  const auto model = build(text, diagnostics);
  EigenOptions options;
  options.num_modes = number;
  return calc_normal_modes(model, options, diagnostics);
}

TEST(LowRank, FactorIsExactAndStopsAtTheLimit) {
  Diagnostics diagnostics;
  const auto model = build(make_text(Tie::Rbe3, 5, 3), diagnostics);
  const fe::System system(model);
  const modal::detail::Pencil pencil(system);
  const auto C = modal::detail::factor_low_rank(pencil.M, pencil.M_diagonal, 50);
  ASSERT_TRUE(C);
  EXPECT_EQ(C->cols(), 6);
  EXPECT_GT((pencil.M_diagonal.array() > 0).count(), 6);
  const MatrixXd M = pencil.calc_M_times(MatrixXd::Identity(pencil.size(), pencil.size()));
  EXPECT_LT((M - MatrixXd(*C * C->transpose())).cwiseAbs().maxCoeff(), 1e-12 * M.cwiseAbs().maxCoeff());
  EXPECT_FALSE(modal::detail::factor_low_rank(pencil.M, pencil.M_diagonal, 5));
}

TEST(LowRank, MassOnMasslessLegs) {
  for (const Tie tie : {Tie::Rbe2, Tie::Rbe3, Tie::Mpc})
    for (const int bars : {2, 30}) {
      const VectorXd expected = calc_expected(tie, 4);
      for (const int number : {3, 40}) {
        Diagnostics diagnostics;
        const auto pairs = solve(make_text(tie, 4, bars), number, diagnostics);
        const auto size = std::min<Eigen::Index>(number, expected.size());
        ASSERT_EQ(pairs.lambda.size(), size) << static_cast<int>(tie) << " " << bars;
        EXPECT_EQ(diagnostics.has("modal.fewer-modes"), number > size);
        EXPECT_GE(pairs.inertia_count, size);
        for (Eigen::Index j = 0; j < size; ++j) EXPECT_NEAR(pairs.lambda(j) / expected(j), 1, 1e-7) << j;
        EXPECT_LT(pairs.residual.maxCoeff(), 1e-8);
      }
    }
}

// Above the size where Lanczos works by blocks; all that there are, and no more.
TEST(LowRank, LargeMasslessStructure) {
  Diagnostics diagnostics;
  const auto pairs = solve(make_text(Tie::Rbe2, 4, 300), 20, diagnostics);
  const VectorXd expected = calc_expected(Tie::Rbe2, 4);
  ASSERT_EQ(pairs.lambda.size(), 6);
  EXPECT_TRUE(diagnostics.has("modal.fewer-modes"));
  for (int j = 0; j < 6; ++j) EXPECT_NEAR(pairs.lambda(j) / expected(j), 1, 1e-5) << j;
}

// Krylov asked for more than the rank of the mass: the blocks end by themselves, SLEPc hands over to them.
TEST(LowRank, KrylovEndsAtTheRank) {
  Diagnostics diagnostics;
  const auto model = build(make_text(Tie::Rbe3, 4, 30), diagnostics);
  const fe::System system(model);
  const modal::detail::Pencil pencil(system);
  const VectorXd expected = calc_expected(Tie::Rbe3, 4);
  for (const char* solver : {"krylovschur", modal::detail::kBlockLanczos}) {
    modal::detail::EigenProblem problem;
    problem.A = pencil.K;
    problem.B = pencil.M;
    problem.num_wanted = 12;
    problem.solver = solver;
    const auto result = modal::detail::extract(problem);
    ASSERT_GE(result.values.size(), 6);
    VectorXd values = result.values;
    std::sort(values.begin(), values.end());
    for (int j = 0; j < 6; ++j) EXPECT_NEAR(values(j) / expected(j), 1, 1e-6) << j;
  }
}

// The largest of 2,000 values side by side, with one restart of a few vectors.
TEST(LowRank, KrylovThatDoesNotConvergeSaysSo) {
  modal::detail::initialize_slepc();
  constexpr PetscInt n = 2000;
  linear::PetscMat A, B;
  for (linear::PetscMat* matrix : {&A, &B}) {
    linear::check_petsc(
        MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, n, n, 1, nullptr, 0, nullptr, matrix->out()));
    PetscInt first = 0, last = 0;
    linear::check_petsc(MatGetOwnershipRange(matrix->get(), &first, &last));
    for (PetscInt i = first; i < last; ++i)
      linear::check_petsc(MatSetValue(matrix->get(), i, i, matrix == &A ? 1 + 1e-3 * i / n : 1.0, INSERT_VALUES));
    linear::check_petsc(MatAssemblyBegin(matrix->get(), MAT_FINAL_ASSEMBLY));
    linear::check_petsc(MatAssemblyEnd(matrix->get(), MAT_FINAL_ASSEMBLY));
    linear::check_petsc(MatSetOption(matrix->get(), MAT_SYMMETRIC, PETSC_TRUE));
  }
  modal::detail::EigenProblem problem;
  problem.A = linear::SymmetricMatrix(std::move(A));
  problem.B = linear::SymmetricMatrix(std::move(B));
  problem.spectrum = modal::detail::Spectrum::LargestMagnitude;
  problem.deflate.resize(n, 0);
  linear::check_petsc(PetscOptionsSetValue(nullptr, "-eps_max_it", "1"));
  try {
    modal::detail::extract(problem);
    ADD_FAILURE() << "no error";
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().front().id, "modal.no-convergence");
  }
  linear::check_petsc(PetscOptionsClearValue(nullptr, "-eps_max_it"));
}

// The same structure with nothing held: the six rigid motions of the mass and nothing else, since the legs follow it.
TEST(LowRank, FreeMasslessStructure) {
  Diagnostics diagnostics;
  const auto pairs = solve(make_text(Tie::Rbe2, 4, 3, true), 10, diagnostics);
  EXPECT_EQ(pairs.lambda.size(), 6);
  EXPECT_EQ(pairs.num_rigid, 6);
  EXPECT_TRUE(diagnostics.has("modal.fewer-modes"));
}

// Held at one leg's top too: the modes of what the RBE3 still shares out.
TEST(LowRank, FixedInterfaceModes) {
  Diagnostics diagnostics;
  const auto model = build(make_text(Tie::Mpc, 3, 4), diagnostics);
  const fe::System system(model);
  const modal::bases::FixedInterface fixed(system, {10004}, diagnostics);
  const auto modes = fixed.calc_modes(30, std::nullopt, diagnostics);
  // The first top at rest takes x and z of the others with it: y and the rotations of two tops are left.
  const Matrix6 K = calc_leg(), M = (VectorXd(6) << 10, 10, 10, .1, .2, .3).finished().asDiagonal();
  const std::vector<int> own{1, 3, 4, 5};
  const VectorXd one = calc_lambda(K(own, own), M(own, own));
  ASSERT_EQ(modes.lambda.size(), 8);
  EXPECT_TRUE(diagnostics.has("modal.fewer-modes"));
  for (int j = 0; j < 8; ++j) EXPECT_NEAR(modes.lambda(j) / one(j / 2), 1, 1e-8) << j;
}

}  // namespace
}  // namespace bough
