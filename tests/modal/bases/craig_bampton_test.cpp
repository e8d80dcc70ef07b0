/// Craig-Bampton and Craig-Chang: static exactness, rigid motion, assemblies, and interfaces through RBE2 and RBE3.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fe/statics/statics.hpp"
#include "modal/bases/basis.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

using fe::Model;
using modal::bases::Basis;
using modal::bases::BasisKind;
using modal::bases::BasisOptions;
using modal::bases::FixedInterface;
using records::ModeKind;

/// A bent frame in space, grids 1..9 and 102..106 (from grid 5 on), a mass at 106; clamped at grid 1 where `fixed`.
DeckMaker make_frame(bool fixed) {
  auto maker = test::make_space_frame();
  maker.add_mass(900, 106, 0.2);
  if (fixed) maker.fix(1, 123456);
  return maker;
}

Model build(const records::Deck& deck) {
  Diagnostics diagnostics;
  auto model = fe::build_model(deck, {}, diagnostics);
  diagnostics.throw_if_errors();
  return model;
}

fe::StaticSolver make_solver(const Model& model, bool is_free) {
  return {model, fe::assemble_stiffness(model, fe::DofSet::Free),
          is_free ? fe::choose_determinate_support(model, 0) : std::vector<int>{}};
}

Basis calc_basis(const Model& model, const BasisOptions& options) {
  Diagnostics diagnostics;
  const auto solver = make_solver(model, options.is_free);
  return modal::bases::calc_basis(
      fe::System(model), options, [&](const MatrixXd& F) { return solver.solve(F); }, diagnostics);
}

MatrixXd make_unit_loads(const Model& model, const std::vector<int>& nodes) {
  MatrixXd F = MatrixXd::Zero(model.num_gdofs(), 6 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    F.block<6, 6>(model.node(model.find_node(nodes[i])).first_gdof, 6 * static_cast<Eigen::Index>(i)).setIdentity();
  return F;
}

/// Largest difference of the columns, translations and rotations weighed by K: the strain energy of the difference.
double calc_error(const Model& model, const MatrixXd& X, const MatrixXd& Y) {
  const MatrixXd E = X - Y;
  const VectorXd error = E.cwiseProduct(fe::calc_stiffness_times(model, E)).colwise().sum().cwiseAbs();
  const VectorXd size = Y.cwiseProduct(fe::calc_stiffness_times(model, Y)).colwise().sum();
  return std::sqrt(error.cwiseQuotient(size).maxCoeff());
}

MatrixXd solve_in_basis(const Basis& basis, const MatrixXd& F) {
  return basis.Phi * basis.K.ldlt().solve(basis.Phi.transpose() * F);
}

TEST(CraigBampton, StaticResponseAtTheInterfaceIsExact) {
  const auto model = build(make_frame(true).deck);
  const MatrixXd F = make_unit_loads(model, {9, 106});
  const MatrixXd exact = make_solver(model, false).solve(F);
  BasisOptions options;
  options.kind = BasisKind::CraigBampton;
  options.interface_nodes = {9, 106};
  options.num_modes = 5;
  for (const bool orthogonalize : {false, true}) {
    options.orthogonalize = orthogonalize;
    const auto basis = calc_basis(model, options);
    ASSERT_EQ(basis.lambda.size(), 17);
    const MatrixXd u = solve_in_basis(basis, F);
    EXPECT_LT((F.transpose() * (u - exact)).norm(), 1e-10 * (F.transpose() * exact).norm());
    EXPECT_LT(calc_error(model, u, exact), 1e-10);
    EXPECT_EQ(std::count(basis.kind.begin(), basis.kind.end(), ModeKind::Constraint), 12);
    const MatrixXd M = basis.Phi.transpose() * fe::calc_mass_times(model, model.mass_kind(), basis.Phi);
    EXPECT_LT((M - basis.M).cwiseAbs().maxCoeff(), 1e-9 * M.cwiseAbs().maxCoeff());
  }
}

// The interface moving rigidly takes the body along: no strain, and the mass of the whole body (Φ_Rᵀ M Φ_R).
TEST(CraigBampton, BoundaryCarriesTheRigidBody) {
  const auto model = build(make_frame(false).deck);
  BasisOptions options;
  options.kind = BasisKind::CraigBampton;
  options.interface_nodes = {1, 9, 106};
  options.num_modes = 3;
  options.orthogonalize = false;
  options.is_free = true;
  const auto basis = calc_basis(model, options);
  ASSERT_EQ(basis.boundary.size(), 18u);
  const MatrixXd R = model.calc_rigid_modes();
  MatrixXd R_b(18, 6);
  for (int i = 0; i < 3; ++i)
    R_b.middleRows(6 * i, 6) = R.middleRows(model.node(model.find_node(options.interface_nodes[i])).first_gdof, 6);
  const auto properties = fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  const MatrixXd M_R = R_b.transpose() * basis.M.topLeftCorner(18, 18) * R_b;
  EXPECT_LT((M_R - properties.rigid_mass).norm(), 1e-10 * properties.rigid_mass.norm());
  EXPECT_NEAR(M_R(0, 0) / (2700e-4 * (Vector3d(1, 0.3, 0.2).norm() + Vector3d(0.2, 0.75, 0.6).norm()) + 0.2), 1, 1e-10);
  const MatrixXd K = basis.K.topLeftCorner(18, 18);
  EXPECT_LT((K * R_b).cwiseAbs().maxCoeff(), 1e-10 * K.cwiseAbs().maxCoeff());
  // Φᵀ(M_ib + M_iiΨ) Φ_R = L, the participation of the fixed-interface modes.
  const MatrixXd L = basis.M.bottomLeftCorner(3, 18) * R_b;
  const MatrixXd direct = basis.Phi.rightCols(3).transpose() * fe::calc_mass_times(model, model.mass_kind(), R);
  EXPECT_LT((L - direct).norm(), 1e-10 * direct.norm());
}

TEST(CraigBampton, FixedInterfaceModesAreThoseOfTheHeldModel) {
  auto maker = test::make_cantilever(test::kFrameSection, 1, 40);  // more dofs than are solved densely
  const auto model = build(maker.deck);
  Diagnostics diagnostics;
  const fe::System system(model);
  const auto modes = FixedInterface(system, {41, 21}, diagnostics).calc_modes(10, {}, diagnostics);
  maker.fix(41, 123456);
  maker.fix(21, 123456);
  modal::EigenOptions options;
  options.num_modes = 10;
  const auto expected = modal::calc_normal_modes(build(maker.deck), options, diagnostics);
  ASSERT_EQ(modes.lambda.size(), 10);
  for (int j = 0; j < 10; ++j) EXPECT_NEAR(modes.lambda(j) / expected.lambda(j), 1, 1e-9);
  EXPECT_LT((modes.Phi - expected.Phi).cwiseAbs().maxCoeff(), 1e-6 * expected.Phi.cwiseAbs().maxCoeff());
  const double hz = std::sqrt(0.5 * (expected.lambda(5) + expected.lambda(6))) / (2 * M_PI);
  EXPECT_EQ(FixedInterface(system, {41, 21}, diagnostics).calc_modes(0, hz, diagnostics).lambda.size(), 6);
}

// All modes of the component: the model itself in other coordinates. A free body loses its six rigid motions.
TEST(CraigBampton, CompleteBasisGivesTheModelBack) {
  for (const bool is_free : {false, true}) {
    const auto model = build(make_frame(!is_free).deck);
    BasisOptions options;
    options.kind = BasisKind::CraigBampton;
    options.interface_nodes = is_free ? std::vector<int>{1, 9, 106} : std::vector<int>{9};
    options.num_modes = model.num_fdofs() - (is_free ? 18 : 6);
    options.is_free = is_free;
    const auto basis = calc_basis(model, options);
    ASSERT_EQ(basis.lambda.size(), model.num_fdofs() - (is_free ? 6 : 0));
    Diagnostics diagnostics;
    modal::EigenOptions eigen;
    eigen.num_modes = 30;
    const auto exact = modal::calc_normal_modes(model, eigen, diagnostics);
    const int first = is_free ? 6 : 0;
    EXPECT_EQ(exact.num_rigid, first);
    for (int j = 0; j < 30 - first; ++j) EXPECT_NEAR(basis.lambda(j) / exact.lambda(first + j), 1, 1e-8) << j;
    EXPECT_LT((basis.Phi.leftCols(4) - exact.Phi.middleCols(first, 4)).cwiseAbs().maxCoeff(),
              1e-6 * exact.Phi.cwiseAbs().maxCoeff());
    const MatrixXd R = model.calc_rigid_modes();
    const double momentum =
        (R.transpose() * fe::calc_mass_times(model, model.mass_kind(), basis.Phi)).cwiseAbs().maxCoeff();
    if (is_free) {
      EXPECT_LT(momentum, 1e-9);
    }
  }
}

/// Frequencies of two components with raw coordinates [u_b, η] that share u_b.
VectorXd assemble(const Basis& a, const Basis& b) {
  const auto nb = static_cast<Eigen::Index>(b.boundary.size());
  const auto na = a.lambda.size() - nb, nn = b.lambda.size() - nb, n = nb + na + nn;
  MatrixXd A = MatrixXd::Zero(a.lambda.size(), n), B = MatrixXd::Zero(b.lambda.size(), n);
  A.topLeftCorner(nb, nb).setIdentity();
  B.topLeftCorner(nb, nb).setIdentity();
  A.bottomRows(na).middleCols(nb, na).setIdentity();
  B.bottomRows(nn).rightCols(nn).setIdentity();
  const MatrixXd M = A.transpose() * a.M * A + B.transpose() * b.M * B;
  const MatrixXd K = A.transpose() * a.K * A + B.transpose() * b.K * B;
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(M, K).eigenvalues().reverse().cwiseInverse();
}

TEST(CraigBampton, TwoComponentsAgreeWithTheWholeModel) {
  const Vector3d a(0, 0, 0), m(0.7, 0.1, 0.2), b(1.2, 0.9, 0.4);
  const auto build_part = [&](bool first, bool second) {
    DeckMaker maker;
    maker.add_section(1, test::kFrameSection, true);
    if (first) maker.add_line(1, 1, a, m, 10, Vector3d::UnitY());
    if (second) maker.add_line(1, 11, m, b, 10, Vector3d::UnitX(), first ? 11 : 0);
    if (first) maker.fix(1, 123456);
    return build(maker.deck);
  };
  Diagnostics diagnostics;
  modal::EigenOptions eigen;
  eigen.num_modes = 8;
  const auto whole = modal::calc_normal_modes(build_part(true, true), eigen, diagnostics).lambda;
  const auto model_a = build_part(true, false), model_b = build_part(false, true);
  VectorXd before;
  for (const int num_modes : {4, 12, 54}) {  // 54: all of them
    BasisOptions options;
    options.kind = BasisKind::CraigBampton;
    options.orthogonalize = false;
    options.interface_nodes = {11};
    options.num_modes = num_modes;
    const auto part_a = calc_basis(model_a, options);
    options.is_free = true;
    options.num_modes = std::min(num_modes + 6, 60);
    const auto part_b = calc_basis(model_b, options);
    const VectorXd error = assemble(part_a, part_b).head(8).cwiseQuotient(whole).array() - 1;
    EXPECT_GT(error.minCoeff(), -1e-9);  // Ritz: from above
    EXPECT_LT(error.cwiseAbs().head(4).maxCoeff(), num_modes == 4 ? 2e-3 : num_modes == 12 ? 2e-5 : 1e-9);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), num_modes == 4 ? 3e-2 : num_modes == 12 ? 1e-3 : 1e-9);
  }
}

// An interface that hangs on others: RBE2 to a hub beside the tip, RBE3 averaging three grids.
TEST(CraigBampton, InterfaceThroughRigidElements) {
  for (const bool is_rbe3 : {false, true}) {
    auto maker = make_frame(true);
    maker.add_grid(500, {1.4, 0.9, 0.3});
    if (is_rbe3) {
      records::Rbe3 element;
      element.id = 700;
      element.ref_grid = 500;
      element.ref_c = 63;
      element.groups.push_back({1.0, 7u, {9, 106, 7}});
      maker.deck.rbe3.push_back(element);
    } else {
      test::add_rbe2(maker, 9, 500);
    }
    const auto model = build(maker.deck);
    BasisOptions options;
    options.kind = BasisKind::CraigBampton;
    options.interface_nodes = {500};
    options.num_modes = 4;
    options.orthogonalize = false;
    const auto basis = calc_basis(model, options);
    ASSERT_EQ(basis.lambda.size(), 10);
    const int row = model.node(model.find_node(500)).first_gdof;
    MatrixXd at_node(6, 10);
    at_node << MatrixXd::Identity(6, 6), MatrixXd::Zero(6, 4);
    EXPECT_LT((basis.Phi.middleRows(row, 6) - at_node).cwiseAbs().maxCoeff(), 1e-11);
    const MatrixXd F = make_unit_loads(model, {500});
    const MatrixXd exact = make_solver(model, false).solve(F);
    EXPECT_LT(calc_error(model, solve_in_basis(basis, F), exact), 1e-10);
    // Attachment modes hold the same static solutions.
    options.kind = BasisKind::CraigChang;
    const auto chang = calc_basis(model, options);
    EXPECT_LT(calc_error(model, solve_in_basis(chang, F), exact), 1e-10);
  }
}

TEST(CraigBampton, DependentInterfaceDofsAreLeftOut) {
  auto maker = make_frame(true);
  records::Rbe2 element;
  element.id = 700;
  element.gn = 9;
  element.cm = 63;
  element.gm = {500};
  maker.add_grid(500, {1.4, 0.9, 0.3});
  maker.deck.rbe2.push_back(element);
  const auto model = build(maker.deck);
  Diagnostics diagnostics;
  const fe::System system(model);
  const FixedInterface fixed(system, {500, 9, 1}, diagnostics);  // grid 1 is clamped: no coordinates
  EXPECT_EQ(fixed.partition().num_boundary(), 6);
  EXPECT_TRUE(diagnostics.has("modal.dependent-interface"));
}

TEST(CraigBampton, NeedsAnInterfaceThatHolds) {
  auto maker = make_frame(false);
  maker.add_line(1, 801, {5, 0, 0}, {6, 0, 0}, 2, Vector3d::UnitY());  // a part that nothing ties
  const auto model = build(maker.deck);
  Diagnostics diagnostics;
  try {
    const fe::System system(model);
    FixedInterface(system, {1}, diagnostics);
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().front().id, "modal.interface-mechanism");
  }
  BasisOptions options;
  options.kind = BasisKind::CraigChang;
  options.num_modes = 2;
  try {
    modal::bases::calc_basis(fe::System(model), options, {}, diagnostics);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.items().front().id, "modal.no-interface");
  }
}

// Raw coordinates of a free body in the frame of an interface node: what the body clamped there has, in its order.
TEST(CraigBampton, RawCoordinatesInTheFrameOfAnInterfaceNode) {
  BasisOptions options;
  options.kind = BasisKind::CraigBampton;
  options.interface_nodes = {1, 9};
  options.num_modes = 4;
  options.orthogonalize = false;
  options.is_free = true;
  const auto free_model = build(make_frame(false).deck), clamped = build(make_frame(true).deck);
  auto basis = calc_basis(free_model, options);
  auto other = basis;
  modal::bases::move_to_frame(free_model, {modal::bases::FrameKind::Node, {1}}, basis);
  options.is_free = false;
  const auto expected = calc_basis(clamped, options);
  ASSERT_EQ(basis.boundary, expected.boundary);
  EXPECT_LT((basis.M - expected.M).norm(), 1e-9 * expected.M.norm());
  EXPECT_LT((basis.K - expected.K).norm(), 1e-9 * expected.K.norm());
  EXPECT_LT((basis.Phi - expected.Phi).norm(), 1e-9 * expected.Phi.norm());
  EXPECT_EQ(basis.Phi.topRows(6).norm(), 0);
  try {
    modal::bases::move_to_frame(free_model, {}, other);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.items().front().id, "modal.raw-frame");
  }
}

// The roll of a straight line of bars without torsional inertia is no coordinate of motion.
TEST(CraigBampton, MasslessConstraintModesAreLeftOut) {
  const auto model = build(test::make_cantilever(test::kFrameSection, 1, 6).deck);
  BasisOptions options;
  options.kind = BasisKind::CraigBampton;
  options.interface_nodes = {7};
  options.num_modes = 2;
  options.orthogonalize = false;
  Diagnostics diagnostics;
  const auto basis = modal::bases::calc_basis(fe::System(model), options, {}, diagnostics);
  EXPECT_EQ(basis.lambda.size(), 7);
  EXPECT_TRUE(diagnostics.has("modal.massless-constraint"));
  for (const auto& dof : basis.boundary) EXPECT_NE(dof.second, 4);
  EXPECT_TRUE(basis.lambda.allFinite());
}

// The same line in a skew direction, its mid grid the interface: the twist is no motion of its own, and must not hold
// the bending. Reference: the modes of the whole.
TEST(CraigBampton, MasslessDirectionsFollow) {
  for (const bool is_skew : {false, true}) {
    DeckMaker maker;
    maker.add_section(1, test::kFrameSection, false);
    if (is_skew)
      maker.add_line(1, 1, {0, 0, 0}, {1. / 3, 2. / 3, 2. / 3}, 24, {2, 1, -2});
    else
      maker.add_line(1, 1, {0, 0, 0}, {1, 0, 0}, 24, Vector3d::UnitY());
    maker.fix(1, 123456);
    const auto model = build(maker.deck);
    BasisOptions options;
    options.kind = BasisKind::CraigBampton;
    options.interface_nodes = {13};
    options.num_modes = 60;
    Diagnostics diagnostics;
    const auto basis = modal::bases::calc_basis(fe::System(model), options, {}, diagnostics);
    modal::EigenOptions eigen;
    eigen.num_modes = 6;
    Diagnostics unheard;
    const auto exact = modal::calc_normal_modes(model, eigen, unheard);
    for (int j = 0; j < 6; ++j) EXPECT_NEAR(basis.lambda(j), exact.lambda(j), 1e-6 * exact.lambda(j)) << j;
    ASSERT_TRUE(diagnostics.has("modal.massless-interface")) << is_skew;
    options.orthogonalize = false;
    Diagnostics raw;
    const auto kept = modal::bases::calc_basis(fe::System(model), options, {}, raw);
    EXPECT_EQ(raw.has("modal.massless-interface"), is_skew);
    EXPECT_EQ(raw.has("modal.massless-constraint"), !is_skew);
    EXPECT_EQ(kept.boundary.size(), is_skew ? 6u : 5u);
  }
}

// Residual vectors: the static solution of each load is in the basis, of a held body and of a free one (inertia
// relief).
TEST(ResidualVectors, HoldTheStaticSolutions) {
  for (const bool is_free : {false, true}) {
    const auto model = build(make_frame(!is_free).deck);
    MatrixXd F = make_unit_loads(model, {7, 104});
    F.conservativeResize(Eigen::NoChange, 14);
    F.col(12) = F.col(3) + F.col(10);  // a combination of others brings nothing
    F.col(13) = fe::calc_mass_times(model, model.mass_kind(), model.calc_rigid_modes().col(1));
    const MatrixXd R = model.calc_rigid_modes();
    const MatrixXd MR = fe::calc_mass_times(model, model.mass_kind(), R);
    const auto solver = make_solver(model, is_free);
    MatrixXd exact;
    if (is_free) {
      const MatrixXd inverse = (R.transpose() * MR).inverse();
      exact = solver.solve(F.leftCols(13) - MR * inverse * (R.transpose() * F.leftCols(13)));
      exact -= R * inverse * (MR.transpose() * exact);
    } else {
      exact = solver.solve(F);
    }
    for (const auto kind : {BasisKind::Normal, BasisKind::CraigBampton, BasisKind::CraigChang}) {
      BasisOptions options;
      options.kind = kind;
      options.is_free = is_free;
      options.num_modes = 4;
      options.interface_nodes = is_free ? std::vector<int>{1, 9} : std::vector<int>{9};
      options.residual_loads = F;
      const auto basis = calc_basis(model, options);
      EXPECT_LT(calc_error(model, solve_in_basis(basis, F.leftCols(exact.cols())), exact), 1e-10);
      EXPECT_EQ(std::count(basis.kind.begin(), basis.kind.end(), ModeKind::Normal), 4);
      EXPECT_EQ(std::count(basis.kind.begin(), basis.kind.end(), ModeKind::Residual), is_free ? 12 : 13);
      EXPECT_EQ(basis.unused_loads, is_free ? (std::vector<int>{12, 13}) : std::vector<int>{12});
      const MatrixXd M = basis.Phi.transpose() * fe::calc_mass_times(model, model.mass_kind(), basis.Phi);
      EXPECT_LT((M - MatrixXd::Identity(M.rows(), M.cols())).cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

// The free-interface basis of a free body: the tip deflects under a tip force as the inertia-relieved body does, and
// the four lowest free frequencies are exact.
TEST(CraigChang, FreeBody) {
  const auto model = build(make_frame(false).deck);
  BasisOptions options;
  options.kind = BasisKind::CraigChang;
  options.is_free = true;
  options.num_modes = 4;
  options.interface_nodes = {9, 106};
  const auto basis = calc_basis(model, options);
  EXPECT_EQ(basis.num_rigid, 6);
  EXPECT_EQ(basis.lambda.size(), 16);
  EXPECT_EQ(std::count(basis.kind.begin(), basis.kind.end(), ModeKind::Attachment), 12);
  EXPECT_LT((model.calc_rigid_modes().transpose() * fe::calc_mass_times(model, model.mass_kind(), basis.Phi))
                .cwiseAbs()
                .maxCoeff(),
            1e-9);
  for (int j = 5; j < 16; ++j) EXPECT_GT(basis.lambda(j), basis.lambda(3));
}

}  // namespace
}  // namespace bough
