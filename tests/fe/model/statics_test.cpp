#include "fe/statics/statics.hpp"

#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fe/linear/cholmod_factor.hpp"
#include "fe/linear/mumps.hpp"
#include "fe/linear/null_space.hpp"
#include "fe/model/row_kinds.hpp"
#include "fe/statics/build_model.hpp"
#include "tests/fe/model/spring_model.hpp"

namespace bough::fe {
namespace {

using namespace test;
using ::testing::HasSubstr;

const std::vector<std::pair<int, int>> kLinks = {{1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 2}};

/// Straight chain of Euler-Bernoulli-like links along x: S of a beam of unit length seen from end B.
Eigen::Matrix<double, 6, 6> make_beam(double h) {
  Eigen::Matrix<double, 6, 6> S = Eigen::Matrix<double, 6, 6>::Zero();
  const double EA = 2e6, GJ = 80, EI = 100;
  S(0, 0) = EA / h;
  S(3, 3) = GJ / h;
  S(1, 1) = S(2, 2) = 12 * EI / (h * h * h);
  S(4, 4) = S(5, 5) = 4 * EI / h;
  S(1, 5) = S(5, 1) = -6 * EI / (h * h);
  S(2, 4) = S(4, 2) = 6 * EI / (h * h);
  return S;
}

ElementFactory make_chain(double h, Eigen::Matrix<double, 6, 6> last) {
  return [h, last](const records::Deck& deck, const NodeTable& nodes, Diagnostics&) {
    ElementList list;
    const int num = static_cast<int>(deck.grids.size());
    for (int k = 0; k + 1 < num; ++k)
      list.elements.push_back(
          std::make_unique<LinkElement>(k + 1, k, k + 1, nodes, k + 2 < num ? make_beam(h) : last, 1.0));
    return list;
  };
}

records::Deck make_line(int num, double length) {
  std::vector<Vector3d> points;
  for (int k = 0; k < num; ++k) points.emplace_back(length * k / (num - 1), 0, 0);
  auto deck = make_deck(points);
  deck.subcases[0].spc = 1;
  return deck;
}

std::string catch_mechanism(const Model& model, std::vector<int> held = {}) {
  try {
    StaticSolver(model, assemble_stiffness(model, DofSet::Free), std::move(held));
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().front().id, "fe.mechanism");
    return error.what();
  }
  return "no error";
}

TEST(StaticsMpi, cantilever_deflection_is_the_closed_form) {
  // 1000 links: the tip is 1e-10 as stiff as the diagonal and still no mechanism; without refinement 1e-5 is lost.
  const int num = 1001;
  auto deck = make_line(num, 2);
  deck.spc.push_back(make_spc(1, 1, 63));
  Diagnostics d;
  const Model model = build_model(deck, {}, make_chain(2.0 / (num - 1), make_beam(2.0 / (num - 1))), d);
  const StaticSolver solver(model, assemble_stiffness(model, DofSet::Free));
  MatrixXd F = MatrixXd::Zero(model.num_gdofs(), 2);
  F(6 * (num - 1) + 2, 0) = 5;
  F(6 * (num - 1) + 3, 1) = 7;
  const MatrixXd u = solver.solve(F);
  EXPECT_NEAR(u(6 * (num - 1) + 2, 0) / (5 * 8.0 / (3 * 100)), 1, 1e-7);
  EXPECT_NEAR(u(6 * (num - 1) + 4, 0) / (-5 * 4.0 / (2 * 100)), 1, 1e-7);
  EXPECT_NEAR(u(6 * (num - 1) + 3, 1) / (7 * 2.0 / 80), 1, 1e-8);
}

TEST(StaticsMpi, unheld_model_is_a_mechanism_of_six_motions) {
  auto deck = make_deck(make_points());
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links(kLinks), d);
  EXPECT_THAT(catch_mechanism(model), HasSubstr("mechanism 6 of 6"));
  EXPECT_EQ(linear::find_mechanisms(assemble_stiffness(model, DofSet::Free), list_row_kinds(model), 6).cols(), 6);
}

TEST(StaticsMpi, more_motions_than_those_of_a_body_are_all_found) {
  // Free, and the last grid spins; or it is loose altogether.
  Eigen::Matrix<double, 6, 6> pinned = make_beam(1);
  pinned.row(3).setZero();
  pinned.col(3).setZero();
  ModelOptions options;
  options.autospc = false;
  Diagnostics d;
  auto deck = make_line(6, 5);
  deck.subcases.clear();
  const std::string text = catch_mechanism(build_model(deck, options, make_chain(1, pinned), d));
  EXPECT_THAT(text, HasSubstr("mechanism 7 of 7"));
  const auto loose = build_model(deck, options, make_chain(1, Eigen::Matrix<double, 6, 6>::Zero()), d);
  EXPECT_THAT(catch_mechanism(loose), HasSubstr("mechanism 12 of 12"));
}

TEST(StaticsMpi, hinge_is_named_by_grid_and_component) {
  auto deck = make_line(6, 5);
  deck.spc.push_back(make_spc(1, 1, 63));
  ModelOptions options;
  options.autospc = false;
  Eigen::Matrix<double, 6, 6> pinned = make_beam(1);
  pinned.row(3).setZero();  // the last link does not carry torque: grid 6 spins
  pinned.col(3).setZero();
  Diagnostics d;
  const std::string text = catch_mechanism(build_model(deck, options, make_chain(1, pinned), d));
  EXPECT_THAT(text, HasSubstr("mechanism 1 of 1 moves most at grid 6 component 4;"));
  EXPECT_THAT(text, HasSubstr("[fe.mechanism]"));
}

TEST(StaticsMpi, missing_support_direction_is_found_without_a_zero_pivot) {
  // Held but for the slide along a skew direction: no zero on the diagonal, no exact null pivot.
  auto deck = make_deck(make_points());
  deck.params.push_back({"AUTOSPC", "NO", {}});
  deck.subcases[0].spc = 1;
  deck.spc.push_back(make_spc(1, 1, 0b111011));
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links(kLinks), d);
  EXPECT_THAT(catch_mechanism(model), HasSubstr("mechanism 1 of 1"));
}

TEST(StaticsMpi, unattached_grid_without_autospc_is_named) {
  auto points = make_points();
  points.emplace_back(9, 9, 9);
  auto deck = make_deck(points);
  ModelOptions options;
  options.autospc = false;
  deck.subcases[0].spc = 1;
  deck.spc.push_back(make_spc(1, 1, 63));
  Diagnostics d;
  const std::string text = catch_mechanism(build_model(deck, options, make_links(kLinks), d));
  for (int c = 1; c <= 6; ++c) EXPECT_THAT(text, HasSubstr("most at grid 7 component " + std::to_string(c) + ";"));
}

TEST(StaticsMpi, no_free_dof_is_an_error) {
  auto deck = make_deck({{0, 0, 0}, {1, 0, 0}});
  deck.grids[0].ps = deck.grids[1].ps = 63;
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links({{1, 2}}), d);
  try {
    StaticSolver(model, assemble_stiffness(model, DofSet::Free));
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items()[0].id, "fe.no-free-dofs");
  }
}

std::string catch_id(const std::function<void()>& run) {
  try {
    run();
  } catch (const ComputationError& error) {
    return error.items().front().id;
  }
  return "no error";
}

TEST(StaticsMpi, stiffness_that_is_not_a_number_does_not_pass) {
  auto deck = make_deck({{0, 0, 0}, {1, 0, 0}});
  deck.grids[0].ps = 63;
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links({{1, 2}}), d);
  const linear::SymmetricMatrix K = assemble_stiffness(model, DofSet::Free);
  linear::check_petsc(MatScale(K.sparse(), std::nan("")));
  EXPECT_EQ(catch_id([&] { StaticSolver(model, K); }), "fe.mechanism");
}

TEST(Factor, states_of_mumps) {
  EXPECT_EQ(linear::judge_factorization(0, 0), linear::FactorState::Done);
  EXPECT_EQ(linear::judge_factorization(-10, 3), linear::FactorState::Singular);
  EXPECT_EQ(linear::judge_factorization(-9, 100), linear::FactorState::NeedsWorkspace);
  EXPECT_EQ(catch_id([] { linear::judge_factorization(-13, 100); }), "fe.out-of-memory");
  EXPECT_EQ(catch_id([] { linear::judge_factorization(-3, 100); }), "fe.factorization");
}

TEST(Petsc, error_codes_become_failures) {
  EXPECT_EQ(catch_id([] { linear::check_petsc(PETSC_ERR_ARG_WRONG); }), "fe.petsc");
  EXPECT_EQ(catch_id([] { linear::check_petsc(PETSC_ERR_MEM); }), "fe.out-of-memory");
  // CHOLMOD_OUT_OF_MEMORY, CHOLMOD_TOO_LARGE; CHOLMOD_NOT_POSDEF sends a matrix on to MUMPS.
  EXPECT_EQ(catch_id([] { linear::check_cholmod(-2); }), "fe.out-of-memory");
  EXPECT_EQ(catch_id([] { linear::check_cholmod(-3); }), "fe.out-of-memory");
  EXPECT_EQ(catch_id([] { linear::check_cholmod(1); }), "no error");
  linear::check_petsc(0);
}

TEST(StaticsMpi, determinate_supports_give_the_same_strain_for_a_balanced_load) {
  auto deck = make_deck(make_points());
  deck.grids[3].cd = 1;
  deck.coord_systems.push_back(make_cylinder(1));
  Diagnostics d;
  const Model model = build_model(deck, {}, make_links(kLinks), d);
  const linear::SymmetricMatrix K = assemble_stiffness(model, DofSet::Free);
  // Balanced: no work on any rigid motion.
  const MatrixXd Phi_R = model.calc_rigid_modes();
  MatrixXd F = make_random(model.num_gdofs(), 1, 6);
  F -= Phi_R * (Phi_R.transpose() * Phi_R).ldlt().solve(Phi_R.transpose() * F);
  std::vector<MatrixXd> u;
  for (int node : {0, 1, 4}) {
    const std::vector<int> held = choose_determinate_support(model, node);
    ASSERT_EQ(held.size(), 6u);
    u.push_back(StaticSolver(model, K, held).solve(F));
    EXPECT_LT((sum_stiffness(model) * u.back() - F).norm(), 1e-11 * F.norm());  // no reaction at the support
    EXPECT_LT((calc_stiffness_times(model, u.back() - u.front())).norm(), 1e-10 * F.norm());
  }
  EXPECT_GT((u[1] - u[2]).norm(), 1e-3 * u[1].norm());  // yet the displacements differ by a rigid motion
}

TEST(StaticsMpi, support_of_a_straight_chain_is_one_grid_and_of_none_an_error) {
  auto deck = make_line(5, 4);
  deck.subcases[0].spc = 0;
  Diagnostics d;
  const Model model = build_model(deck, {}, make_chain(1, make_beam(1)), d);
  const auto held = choose_determinate_support(model, 0);
  ASSERT_EQ(held.size(), 6u);
  for (int c = 0; c < 6; ++c) EXPECT_EQ(held[c], model.find_fdof(2, c + 1));
  try {
    choose_determinate_support(model, 77);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.items()[0].id, "fe.missing-grid");
  }
  deck.grids[1].ps = 1;
  const Model held_model = build_model(deck, {}, make_chain(1, make_beam(1)), d);
  try {
    choose_determinate_support(held_model, 2);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.items()[0].id, "fe.no-support");
  }
}

}  // namespace
}  // namespace bough::fe
