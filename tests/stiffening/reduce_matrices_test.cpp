/// A body from its own matrices is the body of its deck; and what is wrong with matrices.
#include "stiffening/reduce_matrices.hpp"
#include "fe/loads/second_order.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include "fe/loads/loads.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/statics/static_case.hpp"
#include "formats/nastran/reader.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using stiffening::GivenGeometric;
using stiffening::GivenMatrices;
using stiffening::GivenMatrix;

/// An L of bars with offset masses, a rigid link to a grid without elements, a spring to a scalar point, and grids in
/// cylindrical and skew displacement systems.
constexpr const char* kDeck = R"(SOL 103
CEND
SPC = 1
METHOD = 1
BEGIN BULK
EIGRL,1,,,6
PARAM,COUPMASS,-1
PARAM,WTMASS,.5
CORD2C,3,,0.,0.,0.,0.,0.,1.
,1.,0.,0.
CORD2R,4,,0.,0.,0.,1.,1.,3.
,1.,0.,.3
GRID,1,,0.,0.,0.
GRID,2,,1.,.2,0.,3
GRID,3,,2.,.4,.1,4
GRID,4,,2.,1.4,.1,3
GRID,5,,2.,2.4,.3
GRID,6,,2.2,2.4,.5,4
SPOINT,10
SPC1,1,123456,1
CBAR,1,1,1,2,0.,0.,1.
CBAR,2,1,2,3,0.,0.,1.
CBAR,3,1,3,4,0.,0.,1.
CBAR,4,1,4,5,0.,0.,1.
PBAR,1,1,1.-3,2.-7,1.-7,2.-7
MAT1,1,7.+10,,.3,2700.
CONM2,20,5,,1.5,.1,.2,0.
,.02,,.03,,,.01
RBE2,30,5,123456,6
CELAS2,40,3.+4,5,3,10
CMASS2,41,.4,10
CDAMP2,42,3.,5,3,10
FORCE,7,6,,1.,.3,1.,-2.
ENDDATA
)";

records::Deck read(const std::string& text) {
  Diagnostics diagnostics;
  auto deck = nastran::read_deck_text(text, "l.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  return deck;
}

std::string replace(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

SparseRows to_eigen(const records::SparseMatrix& a) {
  return Eigen::Map<const SparseRows>(a.num_rows, a.num_cols, static_cast<int>(a.data.size()), a.indptr.data(),
                                      a.indices.data(), a.data.data());
}

/// Bough's own matrices of a deck, in basic axes, with their dofs.
struct Exported {
  explicit Exported(const records::Deck& deck) : model(build(deck)) {
    const auto gather = [](const linear::SymmetricMatrix& A) { return to_eigen(fe::gather_sparse(A)); };
    given.K.values = gather(fe::assemble_stiffness(model, fe::DofSet::Global));
    given.M.values = gather(fe::assemble_mass(model, fe::DofSet::Global, model.mass_kind()));
    if (fe::has_damping(model)) given.B.values = gather(fe::assemble_damping(model, fe::DofSet::Global));
    given.K.label = "K", given.M.label = "M", given.B.label = "B";
    for (auto* matrix : {&given.K, &given.M, &given.B}) {
      matrix->is_basic = true;
      matrix->row_dofs = model.calc_dof_map();
    }
  }
  static fe::Model build(const records::Deck& deck) {
    Diagnostics diagnostics;
    return fe::build_model(deck, {}, diagnostics);
  }
  /// K_G of a load, with the deck's supports.
  GivenMatrix calc_geometric(const fe::AppliedLoad& load) const {
    const auto K = fe::assemble_stiffness(model, fe::DofSet::Free);
    const fe::StaticSolver solver(model, K);
    GivenMatrix K_G = given.K;
    const VectorXd u = solver.solve(load.F);
    K_G.values = to_eigen(fe::gather_sparse(fe::assemble_geometric_stiffness(model, fe::DofSet::Global, load, u)));
    return K_G;
  }

  fe::Model model;
  GivenMatrices given;
};

records::BodySpec make_spec(int num_modes) {
  records::BodySpec spec;
  spec.name = "l";
  spec.num_modes = num_modes;
  spec.full = true;
  return spec;
}

records::FlexBody reduce_given(const records::Deck& deck, const records::BodySpec& spec, const GivenMatrices& given,
                               Diagnostics* diagnostics = nullptr) {
  Diagnostics own;
  return stiffening::reduce_matrices(deck, spec, given, {}, diagnostics ? *diagnostics : own).body;
}

bool has_id(const Diagnostics& diagnostics, const std::string& id) {
  return std::any_of(diagnostics.items().begin(), diagnostics.items().end(), [&](const auto& d) { return d.id == id; });
}

void expect_near(const MatrixXd& a, const MatrixXd& b, double tolerance, const std::string& what) {
  ASSERT_EQ(a.rows(), b.rows()) << what;
  ASSERT_EQ(a.cols(), b.cols()) << what;
  if (a.size() > 0)
    EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance * std::max(b.cwiseAbs().maxCoeff(), 1e-300)) << what;
}

void expect_same_integrals(const records::MassIntegrals& a, const records::MassIntegrals& b, const std::string& what) {
  expect_near(a.gamma0, b.gamma0, 1e-10, what + " 0");
  expect_near(a.gamma1, b.gamma1, 1e-10, what + " 1");
  ASSERT_EQ(a.gamma4.size(), b.gamma4.size());
  double scale2 = 0, scale4 = 0;
  for (std::size_t j = 0; j < b.gamma2.size(); ++j) {
    scale2 = std::max(scale2, b.gamma2[j].cwiseAbs().maxCoeff());
    for (const auto& block : b.gamma4[j]) scale4 = std::max(scale4, block.cwiseAbs().maxCoeff());
  }
  for (std::size_t j = 0; j < b.gamma2.size(); ++j) {
    EXPECT_LE((a.gamma2[j] - b.gamma2[j]).cwiseAbs().maxCoeff(), 1e-10 * scale2) << what;
    expect_near(a.gamma3[j], b.gamma3[j], 1e-9, what + " 3");
    for (std::size_t k = 0; k < b.gamma2.size(); ++k)
      EXPECT_LE((a.gamma4[j][k] - b.gamma4[j][k]).cwiseAbs().maxCoeff(), 1e-10 * scale4) << what;
  }
}

void expect_same_body(const records::FlexBody& a, const records::FlexBody& b) {
  EXPECT_NEAR(a.mass, b.mass, 1e-12 * b.mass);
  expect_near(a.cg, b.cg, 1e-12, "cg");
  expect_near(a.inertia, b.inertia, 1e-12, "inertia");
  expect_near(a.frequency_hz, b.frequency_hz, 1e-10, "frequency");
  expect_near(a.full_phi, b.full_phi, 1e-9, "phi");
  expect_near(a.modal_damping, b.modal_damping, 1e-9, "damping");
  expect_near(a.effective_mass, b.effective_mass, 1e-9, "effective mass");
  expect_near(a.F_I, b.F_I, 1e-12, "F_I");
  expect_same_integrals(a.exact, b.exact, "exact");
}

records::FlexBody reduce_deck(const records::Deck& deck, const records::BodySpec& spec) {
  Diagnostics diagnostics;
  return stiffening::reduce(deck, spec, {}, diagnostics).body;
}

TEST(ReduceMatrices, OwnMatricesGiveTheBodyOfTheDeck) {
  const auto deck = read(kDeck);
  Exported own(deck);
  auto spec = make_spec(6);
  spec.interface_nodes = {6};
  spec.interface_moments = false;  // of the loads here none is a moment
  spec.damping_ratio = 0.02;
  Diagnostics diagnostics;
  const auto expected = reduce_deck(deck, spec);
  EXPECT_GT(expected.modal_damping.cwiseAbs().maxCoeff(), 0);

  // Every K_G, each with its load: the twelve inertial ones, a unit load on the link's end, a load set, a column.
  const VectorXd tip = VectorXd::Unit(own.model.num_gdofs(), own.model.node(own.model.find_node(6)).first_gdof + 1);
  const auto push = calc_applied_load(own.model, deck, 7, diagnostics);
  for (int i = 0; i < 12; ++i) {
    GivenGeometric g;
    g.name = "inertial " + std::to_string(i);
    g.K_G = own.calc_geometric({expected.F_I.col(i), fe::Vector12d::Unit(i), {}});
    g.inertial = i;
    own.given.geometric.push_back(g);
  }
  GivenGeometric at_node{"tip_y", own.calc_geometric({tip, fe::Vector12d::Zero(), {}})},
      by_set{"push", own.calc_geometric(push)}, by_column = by_set;
  at_node.node = 6, at_node.direction = 2;
  by_set.load_set = 7;
  by_column.name = "column";
  by_column.load = own.given.K;
  by_column.load.values = MatrixXd((MatrixXd(tip.size(), 2) << tip, push.F).finished()).sparseView();
  by_column.load_column = 2;
  for (const auto& g : {at_node, by_set, by_column}) own.given.geometric.push_back(g);

  Diagnostics found;
  const auto body = reduce_given(deck, spec, own.given, &found);
  expect_same_body(body, expected);
  expect_same_integrals(body.lumped, expected.lumped, "lumped");
  EXPECT_TRUE(body.consistent.empty());
  EXPECT_EQ(body.masses, "bodies");  // the blocks of grids are those of rigid bodies
  EXPECT_FALSE(has_id(found, "reduce.inertia-approximated"));
  for (int i = 0; i < 12; ++i) {
    EXPECT_TRUE(body.kg_inertial_computed[std::size_t(i)]);
    expect_near(body.kg_inertial[std::size_t(i)], expected.kg_inertial[std::size_t(i)], 1e-9, "K_G1");
  }
  const auto tip_y = std::size_t(body.find_locator(6, 2));
  expect_near(body.kg_external[tip_y], expected.kg_external[tip_y], 1e-9, "K_G2");
  EXPECT_EQ(body.locators[tip_y].name, "tip_y");

  // The pattern once as the deck's set and once as a column: the same locator, which the deck's own reduction makes
  // too.
  auto with_set = spec;
  with_set.loads.push_back({"push", 0, {}, 7, {}});
  const auto reference = stiffening::reduce(deck, with_set, {}, diagnostics).body;
  ASSERT_EQ(body.locators.size(), 5u);
  for (const std::size_t e : {3, 4}) {
    expect_near(body.kg_external[e], reference.kg_external[3], 1e-9, "pattern");
    expect_near(body.external_load.col(Eigen::Index(e)), reference.external_load.col(3), 1e-9, "generalized force");
    expect_near(body.load_resultant.col(Eigen::Index(e)), reference.load_resultant.col(3), 1e-12, "resultant");
    expect_near(body.load_moment[e], reference.load_moment[3], 1e-9, "moment");
  }
  EXPECT_EQ(body.locators[4].name, "column");
  // K_G of the other two directions of the interface node is not there.
  EXPECT_TRUE(has_id(found, "reduce.no-stiffening"));
  EXPECT_FALSE(has_id(found, "reduce.missing-dofs") || has_id(found, "reduce.not-rigid-mass"));
}

// Blocks that couple the rotations of two grids are of no bodies: spin takes their nodal momenta, and the file says so.
TEST(ReduceMatrices, ConsistentMassTakesItsNodalMomenta) {
  const auto deck = read(replace(kDeck, "PARAM,COUPMASS,-1", "PARAM,COUPMASS,1"));
  const Exported own(deck);
  const auto spec = make_spec(4);
  Diagnostics found, diagnostics;
  const auto body = reduce_given(deck, spec, own.given, &found);
  EXPECT_TRUE(has_id(found, "reduce.inertia-approximated"));
  EXPECT_EQ(body.masses, "nodal momenta");
  EXPECT_TRUE(body.lumped.empty());
  const auto expected = stiffening::reduce(deck, spec, {}, diagnostics).body;
  EXPECT_EQ(expected.masses, "bodies");
  expect_near(body.frequency_hz, expected.frequency_hz, 1e-10, "frequency");
  expect_near(body.F_I.leftCols(6), expected.F_I.leftCols(6), 1e-12, "F_I of accelerations");
  expect_same_integrals(body.consistent, expected.consistent, "consistent");
  // The force on the whole is right all the same.
  const MatrixXd rigid = own.model.calc_rigid_modes().leftCols(3);
  expect_near(rigid.transpose() * body.F_I, rigid.transpose() * expected.F_I, 1e-12, "resultant");
}

/// A free steel tube of `num` beams along x, 12 m long, condensed to its two end grids and four fixed-interface modes
/// as other programs do, in plain double precision: K, M [16 x 16]. `ground`: a spring from its middle to ground along
/// y; `hinge`: the middle turns freely about z.
struct Condensed {
  MatrixXd K, M;
  explicit Condensed(int num, double ground = 0, bool hinge = false) {
    const double L = 12, E = 2.1e11, G = 8.1e10, rho = 7850, A = 4e-4, I = 8e-8, J = 1.6e-7, l = L / num;
    const int N = 6 * (num + 1) + (hinge ? 1 : 0);
    MatrixXd k = MatrixXd::Zero(12, 12), full_K = MatrixXd::Zero(N, N), full_M = full_K;
    for (const auto& [c, stiffness] : {std::pair(0, E * A / l), std::pair(3, G * J / l)}) {
      k(c, c) = k(c + 6, c + 6) = stiffness;
      k(c, c + 6) = k(c + 6, c) = -stiffness;
    }
    for (const auto& [u, r, sign] : {std::tuple(1, 5, 1.0), std::tuple(2, 4, -1.0)}) {
      const double b = E * I / (l * l * l);
      const std::vector<int> at{u, r, u + 6, r + 6};
      MatrixXd bending(4, 4);
      bending << 12, 6 * l * sign, -12, 6 * l * sign, 6 * l * sign, 4 * l * l, -6 * l * sign, 2 * l * l,  //
          -12, -6 * l * sign, 12, -6 * l * sign, 6 * l * sign, 2 * l * l, -6 * l * sign, 4 * l * l;
      k(at, at) = b * bending;
    }
    for (int e = 0; e < num; ++e) {
      std::vector<int> at;
      for (int i = 0; i < 12; ++i) at.push_back(6 * e + i);
      if (hinge && e == num / 2) at[5] = N - 1;
      full_K(at, at) += k;
      for (int i = 0; i < 12; ++i)
        full_M(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(i)]) += 0.5 * rho * A * l *
                                                                                    (i % 6 < 3    ? 1
                                                                                     : i % 6 == 3 ? 2e-4
                                                                                                  : 1e-4);
    }
    full_K(6 * (num / 2) + 1, 6 * (num / 2) + 1) += ground;
    std::vector<int> b, i;
    for (int d = 0; d < N; ++d) (d < 6 || (d >= 6 * num && d < 6 * num + 6) ? b : i).push_back(d);
    const Eigen::SparseMatrix<double> K_ii = MatrixXd(full_K(i, i)).sparseView();
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(K_ii);
    const VectorXd M_ii = full_M.diagonal()(i);
    MatrixXd X(M_ii.size(), 8);  // fixed-interface modes by subspace iteration
    for (Eigen::Index j = 0; j < X.size(); ++j) X(j) = std::sin(1 + 0.7 * static_cast<double>(j));
    for (int step = 0; step < 25; ++step) {
      X = solver.solve(MatrixXd(M_ii.asDiagonal() * X)).eval();
      const MatrixXd k_x = X.transpose() * (K_ii * X), m_x = X.transpose() * M_ii.asDiagonal() * X;
      X = (X * Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(k_x, m_x).eigenvectors()).eval();
    }
    MatrixXd T = MatrixXd::Zero(N, 16);
    T(b, Eigen::seqN(0, 12)) = MatrixXd::Identity(12, 12);
    T(i, Eigen::seqN(0, 12)) = -solver.solve(MatrixXd(full_K(i, b)));
    T(i, Eigen::seqN(12, 4)) = X.leftCols(4);
    const SparseRows sparse_K = full_K.sparseView();
    K = T.transpose() * (sparse_K * T), M = T.transpose() * full_M.diagonal().asDiagonal() * T;
    K = (0.5 * (K + K.transpose())).eval(), M = (0.5 * (M + M.transpose())).eval();
  }
  GivenMatrices give() const {
    GivenMatrices given;
    given.K.values = K.sparseView(), given.M.values = M.sparseView();
    given.K.label = "K", given.M.label = "M";
    return given;
  }
  VectorXd calc_eigenvalues() const { return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M).eigenvalues(); }
};

constexpr const char* kEnds = "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,12.,0.,0.\nSPOINT,11,THRU,14\nENDDATA\n";

// Condensation leaves rigid-body motions a strain of 1e-13 to 1e-7 of that of diag K: small beside the elastic modes.
TEST(ReduceMatrices, CondensedFreeBodiesAreFreeInEveryFrameAndBasis) {
  const auto deck = read(kEnds);
  for (const int num : {20, 60, 200}) {
    const Condensed tube(num);
    const VectorXd lambda = tube.calc_eigenvalues();
    ASSERT_LT(lambda.head(6).cwiseAbs().maxCoeff(), 1e-6 * lambda(6));
    // Of the condensed matrix: the round-off of long chains of beams is in M too.
    const MatrixXd moved = tube.M.topLeftCorner(12, 3) + tube.M.block(0, 6, 12, 3);
    const double mass = (moved.topRows(3) + moved.middleRows(6, 3)).trace() / 3;
    EXPECT_NEAR(mass, 7850 * 4e-4 * 12, num < 200 ? 1e-9 : 1e-8);
    char first[40];
    std::snprintf(first, sizeof first, "mode has %.6g Hz", std::sqrt(lambda(6)) / (2 * std::numbers::pi));
    for (const auto frame : {records::BodyFrame::Free, records::BodyFrame::MeanAxes, records::BodyFrame::Node,
                             records::BodyFrame::MassCentre})
      for (const auto basis : {records::BodyBasis::Normal, records::BodyBasis::CraigBampton}) {
        auto spec = make_spec(4);
        spec.frame = frame;
        spec.basis = basis;
        if (frame == records::BodyFrame::Node) spec.frame_nodes = {1};
        if (basis == records::BodyBasis::CraigBampton) spec.interface_nodes = {1, 2};
        Diagnostics said;
        const auto body = reduce_given(deck, spec, tube.give(), &said);
        const auto who = std::to_string(num) + " beams, frame " + std::to_string(static_cast<int>(frame));
        for (const char* id : {"fe.residual", "modal.unstable", "reduce.basis-off"}) EXPECT_FALSE(said.has(id)) << who;
        EXPECT_TRUE(said.has("reduce.rigid-roundoff")) << who;
        for (const auto& item : said.items())
          if (item.id == "reduce.rigid-roundoff") EXPECT_THAT(item.what, ::testing::HasSubstr(first)) << who;
        EXPECT_NEAR(body.mass, mass, 1e-9) << who;
        ASSERT_GE(body.frequency_hz.size(), 4) << who;
        for (int j = 0; j < 4; ++j)
          EXPECT_NEAR(body.eigenvalue(j) / lambda(6 + j), 1, 1e-6) << who << ", mode " << j + 1;
      }
  }
}

// DMIG cards of ten digits with these matrices, selected by K2GG and M2GG in the deck itself.
TEST(ReduceMatrices, CondensedFreeBodiesAreFreeAsDirectMatricesOfTheDeck) {
  const Condensed tube(60);
  const VectorXd lambda = tube.calc_eigenvalues();
  const auto write = [](const std::string& name, const MatrixXd& A) {
    const auto dof = [](Eigen::Index i) {
      return i < 12 ? std::to_string(i / 6 + 1) + "," + std::to_string(i % 6 + 1) : std::to_string(i - 1) + ",0";
    };
    std::string text = "DMIG," + name + ",0,6,2,0\n";
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      text += "DMIG*," + name + "," + dof(j) + ",\n";
      for (Eigen::Index i = j; i < A.rows(); ++i) {
        char value[32];
        std::snprintf(value, sizeof value, "%.9E", A(i, j));
        text += "*," + dof(i) + "," + value + "\n";
      }
    }
    return text;
  };
  const auto make_deck = [&](const MatrixXd& K) {
    return read("K2GG = KAAX\nM2GG = MAAX\nBEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,12.,0.,0.\nSPOINT,11,THRU,14\n" +
                write("KAAX", K) + write("MAAX", tube.M) + "ENDDATA\n");
  };
  auto spec = make_spec(4);
  spec.frame = records::BodyFrame::Free;
  Diagnostics diagnostics;
  const auto body = stiffening::reduce(make_deck(tube.K), spec, {}, diagnostics).body;
  EXPECT_TRUE(diagnostics.has("reduce.rigid-roundoff"));
  ASSERT_GE(body.frequency_hz.size(), 4);
  for (int j = 0; j < 4; ++j) EXPECT_NEAR(body.eigenvalue(j) / lambda(6 + j), 1, 2e-6) << "mode " << j + 1;
  // A spring to ground of a thousandth of the first elastic mode is none of round-off.
  MatrixXd held = tube.K;
  held(1, 1) += 1e-3 * lambda(6) * body.mass;
  try {
    stiffening::reduce(make_deck(held), spec, {}, diagnostics);
    ADD_FAILURE() << "reduced";
  } catch (const Failure& error) {
    EXPECT_EQ(error.items().back().id, "reduce.grounded");
  }
}

// What is held, or hinged, is told from what is free by the size of its eigenvalues, not by round-off.
TEST(ReduceMatrices, HeldAndHingedBodiesAreNotFree) {
  const auto deck = read(kEnds);
  auto spec = make_spec(4);
  spec.frame = records::BodyFrame::Free;
  const double first = Condensed(60).calc_eigenvalues()(6), mass = 7850 * 4e-4 * 12;
  const auto get_id = [&](const Condensed& body) -> std::string {
    try {
      reduce_given(deck, spec, body.give());
    } catch (const Failure& failure) {
      return failure.items().back().id;
    }
    return "";
  };
  EXPECT_EQ(get_id(Condensed(60, 1e-4 * first * mass)), "reduce.grounded");
  EXPECT_EQ(get_id(Condensed(60, 1e-2 * first * mass)), "reduce.grounded");
  EXPECT_EQ(get_id(Condensed(60, 0, true)), "reduce.mechanism");
  // With its frame on the ground spring it is a body with one soft mode, of next to the mass on the spring.
  const Condensed held(60, 1e-4 * first * mass);
  EXPECT_GT(held.calc_eigenvalues()(5), 1e-5 * first);
}

TEST(ReduceMatrices, DisplacementAxesAndTheOrderOfPoints) {
  const auto deck = read(kDeck);
  Exported own(deck);
  const auto spec = make_spec(5);
  const auto expected = reduce_deck(deck, spec);

  // To the axes of each grid, as Nastran has them, without a list of dofs: the g-set by id.
  MatrixXd R = MatrixXd::Zero(own.model.num_gdofs(), own.model.num_gdofs());
  for (const auto& node : own.model.nodes())
    for (int i = 0; i < node.num_dofs; ++i)
      for (int j = 0; j < node.num_dofs; ++j)
        R(node.first_gdof + i, node.first_gdof + j) =
            node.num_dofs == 1 ? 1 : (i / 3 == j / 3 ? node.R_basic_cd(i % 3, j % 3) : 0);
  EXPECT_GT((R - MatrixXd::Identity(R.rows(), R.cols())).norm(), 1);
  GivenMatrices given = own.given;
  for (auto* matrix : {&given.K, &given.M, &given.B}) {
    matrix->values = MatrixXd(R.transpose() * MatrixXd(matrix->values) * R).sparseView();
    matrix->is_basic = false;
    matrix->row_dofs.resize(0, 2);
  }
  expect_same_body(reduce_given(deck, spec, given), expected);

  // A scalar point between the grids by its id, as Nastran sorts them: id 0 of the list goes there.
  const auto renumbered =
      read(replace(replace(replace(replace(kDeck, "SPOINT,10", "SPOINT,12"), "5,3,10\nCMASS2", "5,3,12\nCMASS2"),
                           "CMASS2,41,.4,10", "CMASS2,41,.4,12"),
                   "5,3,10\nFORCE", "5,3,12\nFORCE"));
  expect_same_body(reduce_given(renumbered, spec, given), expected);

  // Rows in any order, with a list.
  Eigen::PermutationMatrix<Eigen::Dynamic> shuffle(own.model.num_gdofs());
  shuffle.setIdentity();
  for (int i = 0; i < shuffle.size(); ++i)
    std::swap(shuffle.indices()[i], shuffle.indices()[(7 * i + 3) % shuffle.size()]);
  given = own.given;
  for (auto* matrix : {&given.K, &given.M, &given.B}) {
    matrix->values = MatrixXd(shuffle * MatrixXd(matrix->values) * shuffle.transpose()).sparseView();
    matrix->row_dofs = shuffle * matrix->row_dofs;
  }
  expect_same_body(reduce_given(deck, spec, given), expected);
}

/// The matrix on some of its dofs.
void keep_dofs(GivenMatrix& matrix, const std::vector<int>& rows) {
  const MatrixXd all = matrix.values;
  matrix.values = MatrixXd(all(rows, rows)).sparseView();
  matrix.row_dofs = Eigen::MatrixXi(matrix.row_dofs(rows, Eigen::all));
}

TEST(ReduceMatrices, DofsThatTheMatrixLacks) {
  // Without the clamped dofs, as most programs write, and in the plane only.
  const auto planar = read(replace(kDeck, "CONM2,20,5,,1.5,.1,.2,0.", "CONM2,20,5,,1.5,0.,0.,0."));
  Exported own(planar);
  const auto spec = make_spec(4);
  Diagnostics diagnostics;
  const auto expected = stiffening::reduce(planar, spec, {}, diagnostics).body;
  std::vector<int> free;
  for (int i = 0; i < own.model.num_gdofs(); ++i)
    if (own.given.K.row_dofs(i, 0) != 1) free.push_back(i);
  GivenMatrices given = own.given;
  for (auto* matrix : {&given.K, &given.M, &given.B}) keep_dofs(*matrix, free);
  Diagnostics found;
  auto body = reduce_given(planar, spec, given, &found);
  expect_near(body.frequency_hz, expected.frequency_hz, 1e-10, "frequency");
  expect_near(body.full_phi, expected.full_phi, 1e-9, "phi");
  EXPECT_FALSE(has_id(found, "reduce.missing-dofs"));
  EXPECT_TRUE(body.consistent.empty());
  expect_same_integrals(body.lumped, expected.lumped, "lumped");
  // What the clamped grid carried is gone from the mass.
  EXPECT_LT(body.mass, expected.mass * (1 - 1e-3));

  // Without any SPC card: missing rows are constrained nevertheless, and reported.
  const auto loose = read(replace(replace(kDeck, "SPC = 1\n", ""), "SPC1,1,123456,1\n", ""));
  Diagnostics warned;
  body = reduce_given(loose, spec, given, &warned);
  expect_near(body.frequency_hz, expected.frequency_hz, 1e-10, "frequency");
  EXPECT_TRUE(has_id(warned, "reduce.missing-dofs"));

  // The end of the link has no row: it follows the link.
  std::vector<int> independent;
  for (const int i : free)
    if (own.given.K.row_dofs(i, 0) != 6) independent.push_back(i);
  given = own.given;
  for (auto* matrix : {&given.K, &given.M, &given.B}) keep_dofs(*matrix, independent);
  body = reduce_given(planar, spec, given);
  expect_near(body.full_phi, expected.full_phi, 1e-9, "phi of the link");
}

/// The id of the error of a reduction that fails for its input.
std::string fail_to_reduce(const records::Deck& deck, const records::BodySpec& spec, const GivenMatrices& given) {
  try {
    reduce_given(deck, spec, given);
  } catch (const InputError& error) {
    return error.items().front().id;
  }
  return "no error";
}

TEST(ReduceMatrices, ClampedGridsStandInForConstraints) {
  const auto deck = read(kDeck);
  Exported own(deck);
  const auto spec = make_spec(4);
  const auto expected = reduce_deck(deck, spec);
  const auto loose = read(replace(replace(kDeck, "SPC = 1\n", ""), "SPC1,1,123456,1\n", ""));
  own.given.clamped = {1};
  expect_same_body(reduce_given(loose, spec, own.given), expected);
  own.given.clamped = {77};
  EXPECT_EQ(fail_to_reduce(loose, spec, own.given), "reduce.unknown-node");
}

TEST(ReduceMatrices, FreeBodyAndGivenModes) {
  const auto deck = read(kDeck);
  Exported own(deck);
  auto spec = make_spec(4);
  spec.frame = records::BodyFrame::Free;
  const auto expected = reduce_deck(deck, spec);
  expect_same_body(reduce_given(deck, spec, own.given), expected);

  // Modes with the rigid ones among them, not normalized, and eigenvalues beside them.
  MatrixXd Phi_R = own.model.calc_rigid_modes();
  const int scalar = own.model.num_gdofs() - 1;
  Phi_R.row(scalar) = Phi_R.row(own.model.node(own.model.find_node(5)).first_gdof + 2);  // it hangs on a spring
  MatrixXd Phi(Phi_R.rows(), 10);
  Phi << Phi_R, 3 * expected.full_phi;
  GivenMatrices given = own.given;
  given.modes.Phi = own.given.K;
  given.modes.Phi.label = "PHIG";
  given.modes.Phi.values = Phi.sparseView();
  given.modes.eigenvalue = VectorXd::Zero(10);
  given.modes.eigenvalue.tail(4) = expected.eigenvalue;
  spec.num_modes = 0;
  Diagnostics found;
  const auto body = reduce_given(deck, spec, given, &found);
  EXPECT_FALSE(has_id(found, "reduce.modes-differ"));
  EXPECT_FALSE(has_id(found, "reduce.modes-residual"));
  EXPECT_TRUE(has_id(found, "reduce.rigid-modes"));
  ASSERT_EQ(body.num_modes(), 4);
  expect_near(body.frequency_hz, expected.frequency_hz, 1e-10, "frequency");
  expect_near(body.modal_mass, 9 * MatrixXd::Identity(4, 4), 1e-9, "modal mass");
  expect_near(body.exact.gamma0, 3 * expected.exact.gamma0, 1e-9, "gamma 0");
  expect_near(body.effective_mass, expected.effective_mass, 1e-9, "effective mass");

  // Eigenvalues in other units show.
  given.modes.eigenvalue *= 1.01;
  Diagnostics warned;
  reduce_given(deck, spec, given, &warned);
  EXPECT_TRUE(has_id(warned, "reduce.modes-differ"));

  // A sum of two modes is none; the digits that single precision loses do not count.
  Diagnostics mixed;
  MatrixXd Phi_mixed = Phi;
  Phi_mixed.col(7) += .1 * Phi.col(8);
  given.modes.Phi.values = Phi_mixed.sparseView();
  given.modes.eigenvalue.resize(0);
  reduce_given(deck, spec, given, &mixed);
  EXPECT_TRUE(has_id(mixed, "reduce.modes-residual"));
  Diagnostics printed;
  given.modes.Phi.values = MatrixXd(Phi.cast<float>().cast<double>()).sparseView();
  reduce_given(deck, spec, given, &printed);
  EXPECT_FALSE(has_id(printed, "reduce.modes-residual"));

  // No mass in a mode.
  given.modes.Phi.values = MatrixXd(VectorXd::Unit(Phi.rows(), scalar)).sparseView();
  given.modes.eigenvalue.resize(0);
  given.M.values.coeffRef(scalar, scalar) = 0;
  EXPECT_EQ(fail_to_reduce(deck, spec, given), "reduce.no-modal-mass");
}

TEST(ReduceMatrices, ModesAreComparedInBasicAxes) {
  const auto deck = read(kDeck);
  const auto spec = make_spec(3);
  Diagnostics diagnostics;
  const auto body = stiffening::reduce(deck, spec, {}, diagnostics).body;
  const Exported own(deck);
  stiffening::GivenModes theirs;
  theirs.Phi = own.given.K;
  theirs.Phi.values = MatrixXd(-2 * body.full_phi.rowwise().reverse()).sparseView();
  theirs.eigenvalue = body.eigenvalue.reverse();
  auto check = stiffening::compare_modes(body, deck, theirs, diagnostics);
  expect_near(check.mac.rowwise().reverse().diagonal(), VectorXd::Ones(3), 1e-12, "MAC");
  expect_near(check.frequency_hz.reverse(), body.frequency_hz, 1e-12, "frequency");
  EXPECT_LT(check.mac(0, 0), 0.5);
  // The same numbers in displacement axes are other motions.
  theirs.Phi.is_basic = false;
  check = stiffening::compare_modes(body, deck, theirs, diagnostics);
  EXPECT_LT(check.mac(0, 2), 0.999);
  theirs.Phi.row_dofs.col(0).array() += 1000;
  try {
    stiffening::compare_modes(body, deck, theirs, diagnostics);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.items().front().id, "reduce.no-common-nodes");
  }
}

TEST(ReduceMatrices, WithoutGeometricStiffnessItSaysSo) {
  const auto deck = read(kDeck);
  const Exported own(deck);
  Diagnostics found;
  const auto body = reduce_given(deck, make_spec(2), own.given, &found);
  EXPECT_TRUE(has_id(found, "reduce.no-stiffening"));
  for (const bool computed : body.kg_inertial_computed) EXPECT_FALSE(computed);
  for (const auto& K_G : body.kg_inertial) EXPECT_EQ(K_G.norm(), 0);
}

TEST(ReduceMatrices, Errors) {
  const auto deck = read(kDeck);
  const Exported own(deck);
  const auto fails = [&](const GivenMatrices& given, const std::string& id, const std::string& words,
                         records::BodySpec spec = make_spec(2)) {
    Diagnostics diagnostics;
    try {
      stiffening::reduce_matrices(deck, spec, given, {}, diagnostics);
      ADD_FAILURE() << id;
    } catch (const InputError& error) {
      EXPECT_EQ(error.items().back().id, id);
      EXPECT_THAT(error.items().back().what, testing::HasSubstr(words));
    }
  };
  auto given = own.given;
  given.K.values.conservativeResize(36, 36);
  fails(given, "reduce.matrix-size", "36 rows, its list of dofs has 37");
  given.K.row_dofs.resize(0, 2);
  fails(given, "reduce.matrix-size", "36 rows, 7 grids and scalar points have 37");
  given = own.given;
  given.M.row_dofs(3, 0) = 99;
  fails(given, "reduce.matrix-dof", "row 4 of M belongs to point 99");
  given = own.given;
  given.M.row_dofs(3, 1) = 7;
  fails(given, "reduce.matrix-dof", "component 7 of point 1, expected 1 to 6");
  given = own.given;
  given.M.row_dofs.row(3) = given.M.row_dofs.row(2);
  fails(given, "reduce.matrix-dof", "as a row before");
  given = own.given;
  given.K.values.coeffRef(8, 7) *= 1.001;
  fails(given, "reduce.not-symmetric", "K is not symmetric: (8, 9)");
  given = own.given;
  given.M.values.coeffRef(8, 8) = -1;
  fails(given, "reduce.negative-mass", "grid 2 component 3");
  given = own.given;
  given.M.values *= 0;
  fails(given, "reduce.negative-mass", "carry the mass 0");
  auto spec = make_spec(2);
  spec.mass = "lumped";
  fails(own.given, "reduce.bad-mass", "the mass matrix is given", spec);
  spec = make_spec(2);
  spec.integrals = "consistent";
  fails(own.given, "reduce.bad-integrals", "mass matrix given is lumped", spec);
  given = own.given;
  given.geometric.push_back({"pull", own.given.K});
  given.geometric.back().load = own.given.K;
  given.geometric.back().load_column = 38;
  fails(given, "reduce.matrix-size", "column 38 of K, which has 37");

  // Warnings: a mass that no rigid body has; an order that the matrix does not tell.
  given = own.given;
  for (int i = 0; i < 37; ++i)
    if (given.M.row_dofs(i, 1) == 3) given.M.values.coeffRef(i, i) += 1;
  Diagnostics found;
  reduce_given(deck, make_spec(2), given, &found);
  EXPECT_TRUE(has_id(found, "reduce.not-rigid-mass"));
  const auto resequenced = read(replace(kDeck, "ENDDATA", "SEQGP,1,6\nENDDATA"));
  given = own.given;
  given.K.row_dofs.resize(0, 2);
  Diagnostics ordered;
  reduce_given(resequenced, make_spec(2), given, &ordered);
  EXPECT_TRUE(has_id(ordered, "reduce.matrix-order"));
}

}  // namespace
}  // namespace bough
