/// RBE3 over many grids: what is of low rank beside a sparse matrix, against the same eliminated whole.
#include <gtest/gtest.h>

#include <cmath>

#include "fe/linear/residual.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "fe/matrices/wide_part.hpp"
#include "fe/statics/preload.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/reader.hpp"
#include "modal/bases/fixed_interface.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

struct Plate {
  int n = 6;  ///< elements along an edge
  std::string density = "2700.";
  std::string constraints = "SPC1,1,123456,1,THRU,7\n";
  std::string reference = "CONM2,95000,90000,,3.,.1,.2,.3\n,.02,,.03,,,.04\n";
  std::string control;
};

/// A square plate of side one, all its grids joined by an RBE3 to grid 90000 above it.
records::Deck make_deck(const Plate& plate) {
  std::string text = "SOL 103\nCEND\nSPC = 1\nMETHOD = 3\n" + plate.control + "BEGIN BULK\nEIGRL,3,,,6\n";
  const int m = plate.n + 1;
  const auto id = [m](int i, int j) { return std::to_string(1 + i + m * j); };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i)
      text += "GRID," + id(i, j) + ",," + std::to_string(1.0 * i / plate.n) + "," + std::to_string(1.0 * j / plate.n) +
              ",0.\n";
  for (int j = 0; j < plate.n; ++j)
    for (int i = 0; i < plate.n; ++i)
      text += "CQUAD4," + std::to_string(1000000 + i + m * j) + ",1," + id(i, j) + "," + id(i + 1, j) + "," +
              id(i + 1, j + 1) + "," + id(i, j + 1) + "\n";
  text += "PSHELL,1,1,.01,1\nMAT1,1,70.+9,,.3," + plate.density + "\nGRID,90000,,.4,.45,.2\n";
  text += "RBE3,99000,,90000,123456,1.,123";
  for (int i = 1; i <= m * m; ++i) text += (i > 2 && i % 8 == 3 ? "\n," : ",") + std::to_string(i);
  Diagnostics diagnostics;
  auto deck = nastran::read_deck_text(text + "\n" + plate.constraints + plate.reference, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  return deck;
}

/// While it lives a constraint of more terms is wide.
class MaxDenseTerms {
 public:
  explicit MaxDenseTerms(int terms) {
    linear::initialize_petsc();
    linear::check_petsc(PetscOptionsSetValue(nullptr, kName, std::to_string(terms).c_str()));
  }
  ~MaxDenseTerms() { PetscOptionsClearValue(nullptr, kName); }
  MaxDenseTerms(const MaxDenseTerms&) = delete;
  MaxDenseTerms& operator=(const MaxDenseTerms&) = delete;

 private:
  static constexpr const char* kName = "-bough_max_dense_terms";
};

fe::Model build(const records::Deck& deck, const fe::ModelOptions& options = {}) {
  Diagnostics diagnostics;
  auto model = fe::build_model(deck, options, diagnostics);
  diagnostics.throw_if_errors();
  return model;
}

modal::EigenPairs calc_modes(const fe::Model& model, int num) {
  modal::EigenOptions options;
  options.num_modes = num;
  Diagnostics diagnostics;
  return modal::calc_normal_modes(model, options, diagnostics);
}

const std::string kSpring =
    "CELAS2,95001,2.+5,90000,1\nCELAS2,95002,3.+5,90000,2\nCELAS2,95003,4.+5,90000,3\n"
    "CELAS2,95004,2.+4,90000,4\nCELAS2,95005,3.+4,90000,5\nCELAS2,95006,1.+4,90000,6\n";
const std::string kMast =
    "GRID,90001,,.5,.5,1.2\nCBAR,95010,5,90000,90001,1.,0.,0.\nPBAR,5,1,1.-3,1.-6,2.-6,1.-6\n"
    "CONM2,95011,90001,,2.\n";
const std::string kHanging =
    "GRID,90002,,.7,.2,.6\nGRID,90003,,.1,.2,.5\nRBE2,99001,90000,123456,90002,90003\n"
    "CONM2,95012,90002,,1.5\nCBAR,95013,5,90002,90003,0.,0.,1.\n"
    "PBAR,5,1,1.-3,1.-6,2.-6,1.-6\nCELAS2,95014,5.+4,90003,3\n";

std::vector<std::pair<std::string, Plate>> make_cases() {
  const Plate plain;
  auto with = [&](const auto& change) {
    Plate plate = plain;
    change(plate);
    return plate;
  };
  return {{"mass", plain},
          {"springs", with([](Plate& p) { p.reference += kSpring; })},
          {"springs alone hold it", with([](Plate& p) {
             p.reference += kSpring;
             p.constraints = "SPC1,1,126,1000\nGRID,1000,,0.,0.,0.\n";
           })},
          {"mast", with([](Plate& p) { p.reference += kMast; })},
          {"mast, consistent mass", with([](Plate& p) { p.reference += kMast + "PARAM,COUPMASS,1\n"; })},
          {"hanging links", with([](Plate& p) { p.reference += kHanging; })},
          {"free", with([](Plate& p) { p.constraints = "SPC1,1,123456,1000\nGRID,1000,,0.,0.,0.\n"; })},
          {"free with a mast", with([](Plate& p) {
             p.reference += kMast;
             p.constraints = "SPC1,1,123456,1000\nGRID,1000,,0.,0.,0.\n";
           })},
          {"massless plate", with([](Plate& p) { p.density = "0."; })}};
}

/// What `calc` gives with every constraint eliminated whole, and with those over 30 terms apart.
template <class Calc>
auto calc_both(const Calc& calc) {
  const auto under = [&](int terms) {
    const MaxDenseTerms limit(terms);
    return calc();
  };
  auto whole = under(1 << 30);
  return std::pair{std::move(whole), under(30)};
}

void expect_near(const MatrixXd& found, const MatrixXd& expected, double tolerance) {
  ASSERT_EQ(found.cols(), expected.cols());
  EXPECT_LT((found - expected).norm(), tolerance * expected.norm());
}

void expect_same_values(const VectorXd& found, const VectorXd& expected, double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (Eigen::Index i = 0; i < found.size(); ++i) EXPECT_NEAR(found(i) / expected(i), 1, tolerance) << i;
}

// K and M are those of the whole elimination, and so are the modes with their count.
TEST(WideConstraints, ModesAreThoseOfTheWholeElimination) {
  for (const auto& [name, plate] : make_cases()) {
    SCOPED_TRACE(name);
    const auto model = build(make_deck(plate));
    const MatrixXd one = MatrixXd::Identity(model.num_fdofs(), model.num_fdofs());
    const auto [K, K_wide] =
        calc_both([&] { return linear::multiply(fe::assemble_stiffness(model, fe::DofSet::Free), one); });
    expect_near(K_wide, K, 1e-12);
    const auto [M, M_wide] = calc_both([&] {
      const auto matrix = fe::assemble_mass(model, fe::DofSet::Free, model.mass_kind());
      EXPECT_EQ(matrix.low_rank() != nullptr, fe::get_max_dense_terms() == 30);
      return linear::multiply(matrix, one);
    });
    expect_near(M_wide, M, 1e-12);
    const auto [expected, found] =
        calc_both([&, &plate = plate] { return calc_modes(model, plate.density == "0." ? 4 : 12); });
    ASSERT_EQ(found.lambda.size(), expected.lambda.size());
    EXPECT_EQ(found.inertia_count, expected.inertia_count);
    ASSERT_EQ(found.num_rigid, expected.num_rigid);
    const auto num_elastic = found.lambda.size() - found.num_rigid;
    expect_same_values(found.lambda.tail(num_elastic), expected.lambda.tail(num_elastic), 1e-9);
    expect_near(found.Phi, expected.Phi, 1e-6);
    EXPECT_LT(found.residual.maxCoeff(), 1e-8);
  }
}

TEST(WideConstraints, StaticSolutionsAreThoseOfTheWholeElimination) {
  for (const auto& [name, plate] : make_cases()) {
    if (name.starts_with("free")) continue;
    SCOPED_TRACE(name);
    const auto model = build(make_deck(plate));
    MatrixXd F = MatrixXd::Zero(model.num_gdofs(), 2);
    F(model.node(model.find_node(90000)).first_gdof + 2, 0) = 1;
    F(model.node(model.find_node(40)).first_gdof + 2, 1) = 1;
    const auto [expected, found] =
        calc_both([&] { return fe::StaticSolver(model, fe::assemble_stiffness(model, fe::DofSet::Free)).solve(F); });
    expect_near(found, expected, 1e-9);
  }
}

// The second order of the link, which couples all of its grids, is taken however wide it is.
TEST(WideConstraints, BucklingAndPreloadAreThoseOfTheWholeElimination) {
  Plate plate;
  plate.reference += kMast + "FORCE,7,90001,0,1.+3,.3,-1.,-.2\nMOMENT,7,90000,0,1.+3,.3,.5,.2\n";
  plate.control = "SUBCASE 1\nLOAD = 7\nSUBCASE 2\nSTATSUB = 1\n";
  const auto deck = make_deck(plate);
  const auto [expected, found] = calc_both([&] {
    Diagnostics diagnostics;
    fe::ModelOptions options;
    options.subcase = 1;
    const auto model = build(deck, options);
    const auto load = fe::calc_static_load(model, deck, model.subcase(), diagnostics);
    const fe::StaticSolver solver(model, fe::assemble_stiffness(model, fe::DofSet::Free));
    const VectorXd u = fe::solve_static_case(model, solver, load).displacement;
    modal::EigenOptions few;
    few.num_modes = 4;
    std::vector<VectorXd> values{modal::calc_buckling_modes(model, load, u, few, diagnostics).lambda};
    options.subcase = 2;
    options.prestress = fe::calc_subcase_prestress(deck, options, deck.subcases[1], diagnostics);
    EXPECT_TRUE(options.prestress);
    values.push_back(calc_modes(build(deck, options), 8).lambda);
    return values;
  });
  for (std::size_t k = 0; k < expected.size(); ++k) expect_same_values(found[k], expected[k], 1e-8);
}

// With the reference as interface, and with a grid of the plate.
TEST(WideConstraints, FixedInterfaceIsThatOfTheWholeElimination) {
  for (const auto& [name, plate] : make_cases()) {
    if (name.starts_with("massless")) continue;
    SCOPED_TRACE(name);
    const auto model = build(make_deck(plate));
    for (const int node : {90000, 25}) {
      const auto [expected, found] = calc_both([&] {
        Diagnostics diagnostics;
        const fe::System system(model);
        const modal::bases::FixedInterface fixed(system, {node}, diagnostics);
        return std::pair{fixed.calc_modes(6, {}, diagnostics).lambda, fixed.calc_constraint_modes()};
      });
      // Stiffness at the reference is on six dofs in the sparse part: digits cancel.
      expect_same_values(found.first, expected.first, 1e-8);
      expect_near(found.second, expected.second, 1e-8);
    }
  }
}

// Lumped equipment on a plate of 2,116 grids, above the size from which modes come by blocks: elements know nothing of
// how the matrices are held, so their products decide.
TEST(WideConstraints, ManyGridsSolveTheElementsEquations) {
  Plate plate;
  plate.n = 45;
  plate.constraints = "SPC1,1,123456,1,THRU,46\n";
  plate.reference += kMast;
  const auto model = build(make_deck(plate));
  const auto pairs = calc_modes(model, 5);
  EXPECT_EQ(pairs.inertia_count, 5);
  const MatrixXd M_Phi = fe::calc_mass_times(model, model.mass_kind(), pairs.Phi);
  const MatrixXd K = model.T().transpose() * fe::calc_stiffness_times(model, pairs.Phi);
  const MatrixXd M = model.T().transpose() * M_Phi;
  const VectorXd diagonal = linear::get_diagonal(fe::assemble_stiffness(model, fe::DofSet::Free));
  const VectorXd residual =
      linear::calc_residuals(diagonal, MatrixXd::Zero(K.rows(), K.cols()), K, M * pairs.lambda.asDiagonal());
  EXPECT_LT(residual.maxCoeff(), 1e-7);
  expect_near(pairs.Phi.transpose() * M_Phi, MatrixXd::Identity(5, 5), 1e-9);
}

}  // namespace
}  // namespace bough
