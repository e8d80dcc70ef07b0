/// Pressure that follows its faces against finite differences; K_G0 as a share of the stiffness of a model.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "base/rotation.hpp"
#include "fe/linear/factor.hpp"
#include "fe/loads/dead_loads.hpp"
#include "fe/loads/second_order.hpp"
#include "fe/shape/face_load.hpp"
#include "fe/statics/build_model.hpp"
#include "fe/statics/preload.hpp"
#include "fe/statics/static_case.hpp"
#include "tests/fe/model/text_model.hpp"

namespace bough::fe {
namespace {

using Points = std::vector<Vector3d>;

const Traction kNormal = [](double p, const Vector3d&, const Vector3d& n) -> Vector3d { return p * n; };

/// -∂f/∂u of calc_face_load by central differences.
MatrixXd differentiate(const Points& corners, const Points& midside, const std::vector<char>& has,
                       const std::vector<double>& p) {
  const auto load = [&](int node, int axis, double step) {
    Points c = corners, m = midside;
    int k = node - static_cast<int>(c.size());
    if (k < 0) {
      c[static_cast<std::size_t>(node)][axis] += step;
    } else {
      std::size_t side = 0;
      for (;; ++side)
        if (has[side] && k-- == 0) break;
      m[side][axis] += step;
    }
    const Matrix3Xd f = calc_face_load(c, m, has, p, kNormal);
    return VectorXd(f.reshaped());
  };
  const int num = static_cast<int>(load(0, 0, 0).size());
  MatrixXd K(num, num);
  const double step = 1e-4;
  for (int i = 0; i < num; ++i) K.col(i) = (load(i / 3, i % 3, -step) - load(i / 3, i % 3, step)) / (2 * step);
  return K;
}

TEST(FollowerPressure, IsTheDerivative) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  const auto jitter = [&](double x, double y) {
    return Vector3d(x + uniform(engine), y + uniform(engine), uniform(engine));
  };
  for (const int n : {3, 4})
    for (const bool is_curved : {false, true}) {
      Points corners{jitter(0, 0), jitter(1, 0), jitter(1, 1)}, midside;
      if (n == 4) corners.push_back(jitter(0, 1));
      std::vector<char> has;
      for (int k = 0; k < n && is_curved; ++k) {
        has.push_back(k != 1);
        const auto a = static_cast<std::size_t>(k), b = static_cast<std::size_t>((k + 1) % n);
        midside.emplace_back(0.5 * (corners[a] + corners[b]) + 0.2 * jitter(0, 0));
      }
      std::vector<double> p{1.0, 2.0, -0.5, 3.0};
      p.resize(static_cast<std::size_t>(n));
      const MatrixXd K = differentiate(corners, midside, has, p);
      const MatrixXd found = calc_follower_stiffness(corners, midside, has, p);
      EXPECT_LT((found - K).norm(), 1e-7 * K.norm()) << n << is_curved;
    }
}

TEST(FollowerPressure, OfAClosedSurfaceIsSymmetricByItself) {
  const Points x{{0, 0, 0}, {1, 0.1, 0}, {1.2, 1, 0.1}, {0, 1, 0}, {0, 0.1, 1}, {1, 0, 1.1}, {1, 1, 1}, {0.1, 1, 0.9}};
  const std::vector<std::vector<int>> faces{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                            {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  MatrixXd whole = MatrixXd::Zero(24, 24), found = whole;
  for (const auto& face : faces) {
    Points corners;
    std::vector<int> dofs;
    for (const int k : face) {
      corners.push_back(x[static_cast<std::size_t>(k)]);
      for (int a = 0; a < 3; ++a) dofs.push_back(3 * k + a);
    }
    whole(dofs, dofs) += differentiate(corners, {}, {}, {2, 2, 2, 2});
    found(dofs, dofs) += calc_follower_stiffness(corners, {}, {}, {2, 2, 2, 2});
  }
  EXPECT_LT((whole - whole.transpose()).norm(), 1e-8 * whole.norm());
  EXPECT_LT((whole - found).norm(), 1e-8 * whole.norm());
}

/// LLᵀ says so of small matrices too, for which CHOLMOD has another method than for large ones.
TEST(SymmetricFactor, OfAnIndefiniteMatrixIsNoCholeskyFactor) {
  if (linear::initialize_petsc().size > 1) GTEST_SKIP() << "CHOLMOD factors on one process";
  for (const int size : {1, 2, 40})
    for (const double last : {1.0, -1.0}) {
      linear::PetscMat A;
      linear::check_petsc(MatCreateSeqAIJ(PETSC_COMM_SELF, size, size, 1, nullptr, A.out()));
      for (int i = 0; i < size; ++i)
        linear::check_petsc(MatSetValue(A.get(), i, i, i + 1 == size ? last : 1.0, INSERT_VALUES));
      linear::check_petsc(MatAssemblyBegin(A.get(), MAT_FINAL_ASSEMBLY));
      linear::check_petsc(MatAssemblyEnd(A.get(), MAT_FINAL_ASSEMBLY));
      const linear::SymmetricFactor factor(linear::SymmetricMatrix(std::move(A)), false);
      EXPECT_EQ(factor.is_definite(), last > 0) << size;
      EXPECT_NEAR(factor.solve(VectorXd::Ones(size))(size - 1, 0), last, 1e-15);
    }
}

/// A frame with an offset bar, a rigid link with a mass, a spring and a shell, loaded in all ways.
constexpr const char* kFrame =
    "SOL 103\nCEND\nSPC = 1\nSUBCASE 1\nLOAD = 10\nTEMP(LOAD) = 20\nSUBCASE 2\nSTATSUB = 1\nMETHOD = 3\nBEGIN BULK\n"
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,.2\nGRID,5,,2.,.5,.3\n"
    "CBAR,1,1,1,2,0.,0.,1.\n,,,0.,0.,.1,0.,.05,.1\nCBAR,2,1,2,3,0.,0.,1.\nCROD,3,2,3,4\nCQUAD4,4,3,1,2,3,4\n"
    "PBAR,1,1,1.-3,2.-6,3.-6,1.-6\nPROD,2,1,1.-4\nPSHELL,3,1,.01,1,,1\nMAT1,1,7.+10,,.3,2700.,1.-5\n"
    "RBE2,6,3,123456,5\nCONM2,7,5,,3.,.1,.2,.0\nSPC1,1,123456,1,4\n"
    "FORCE,10,5,,2000.,1.,2.,3.\nGRAV,10,,9.81,0.,0.,-1.\nPLOAD2,10,500.,4\nTEMPD,20,3.\nPARAM,FOLLOWK,YES\n";

TEST(Prestress, IsTheGeometricStiffnessOfItsLoadWhereverKIs) {
  Diagnostics diagnostics;
  const auto deck = nastran::read_deck_text(kFrame, "deck.bdf", {}, diagnostics);
  diagnostics.throw_if_errors();
  ModelOptions options;
  options.subcase = 1;
  const auto plain = build_model(deck, options, diagnostics);
  const auto load = calc_static_load(plain, deck, plain.subcase(), diagnostics);
  ASSERT_GT(load.followers.size(), 0u);
  const StaticSolver solver(plain, assemble_stiffness(plain, DofSet::Free));
  const VectorXd u = solve_static_case(plain, solver, load).displacement;
  const auto K_G = assemble_geometric_stiffness(plain, DofSet::Global, load, u, &load.initial);

  options.subcase = 2;
  options.prestress = calc_subcase_prestress(deck, options, deck.subcases[1], diagnostics);
  ASSERT_TRUE(options.prestress);
  EXPECT_EQ(options.prestress->name, "subcase 1 (LOAD 10, TEMPERATURE 20)");
  EXPECT_NEAR(options.prestress->A_I[2], 9.81, 1e-12);
  EXPECT_TRUE(diagnostics.has("fe.preload"));
  const auto model = build_model(deck, options, diagnostics);
  const int n = model.num_gdofs();
  const MatrixXd one = MatrixXd::Identity(n, n), K0 = multiply(K_G, one);
  EXPECT_GT(K0.norm(), 1);
  EXPECT_LT((calc_prestress_times(model, one) - K0).norm(), 1e-10 * K0.norm());
  EXPECT_LT((calc_stiffness_times(model, one) - calc_stiffness_times(plain, one) - K0).norm(), 1e-6 * K0.norm());
  const MatrixXd T = model.T(), K_f = multiply(assemble_stiffness(model, DofSet::Free),
                                               MatrixXd::Identity(model.num_fdofs(), model.num_fdofs()));
  const MatrixXd expected = T.transpose() * (calc_stiffness_times(plain, T) + K0 * T);
  EXPECT_LT((K_f - expected).norm(), 1e-12 * K_f.norm());
}

/// A free bar with masses on its way and on an arm, pulled at one end; held at the other against the inertia of its
/// acceleration it has the same stress.
TEST(Prestress, InertiaReliefIsTheLoadOfItsAcceleration) {
  const auto calc = [](const std::string& control, const std::string& cards) {
    std::string text =
        "SOL 103\nCEND\n" + control + "SUBCASE 1\nLOAD = 5\nSUBCASE 2\nSTATSUB = 1\nMETHOD = 3\nBEGIN BULK\n";
    for (int i = 1; i <= 6; ++i) text += "GRID," + std::to_string(i) + ",," + std::to_string(0.2 * i) + ",0.,0.\n";
    for (int i = 1; i <= 5; ++i)
      text += "CBAR," + std::to_string(i) + ",1," + std::to_string(i) + "," + std::to_string(i + 1) + ",0.,1.,0.\n";
    text +=
        "GRID,7,,.6,.3,.1\nRBE2,8,3,123456,7\nCONM2,9,7,,2.,.1,.05,.02\nCONM2,10,3,,2.\n,,,,.1,.1,.1\n"
        "PBAR,1,1,1.-3,2.-6,3.-6,1.-6\nMAT1,1,7.+10,,.3,2700.\n" +
        cards;
    Diagnostics diagnostics;
    const auto deck = nastran::read_deck_text(text, "deck.bdf", {}, diagnostics);
    diagnostics.throw_if_errors();
    ModelOptions options;
    options.subcase = 2;
    options.prestress = calc_subcase_prestress(deck, options, deck.subcases[1], diagnostics);
    return std::pair(build_model(deck, options, diagnostics), options.prestress->A_I);
  };
  const std::string pull = "FORCE,5,6,,900.,1.,.2,-.1\n";
  const auto [free, A_I] = calc("", "PARAM,INREL,-2\n" + pull);
  const MatrixXd one = MatrixXd::Identity(free.num_gdofs(), free.num_gdofs());
  const MatrixXd K0 = calc_prestress_times(free, one);
  EXPECT_GT(K0.norm(), 1);
  EXPECT_GT(A_I.head<3>().norm(), 10);
  for (const char* support : {"SUPORT,1,123456\nPARAM,INREL,-1\n", "SUPORT,6,12346,2,3\nPARAM,INREL,-1\n"}) {
    const auto supported = calc("", support + pull).first;
    EXPECT_LT((calc_prestress_times(supported, one) - K0).norm(), 1e-8 * K0.norm()) << support;
  }
  // K_G of a balanced load turns it: nothing is left of a shift, and the whole is in balance.
  const MatrixXd rigid = free.calc_rigid_modes();
  EXPECT_LT((free.T().transpose() * (K0 * rigid.leftCols<3>())).norm(), 1e-9 * K0.norm());
}

// PARAM,FOLLOWK,YES was taken in silence for loads that do not follow.
TEST(Prestress, LoadsThatDoNotFollowAreNamed) {
  const auto count = [](const std::string& cards) {
    Diagnostics diagnostics;
    const auto deck = nastran::read_deck_text(kFrame + cards, "deck.bdf", {}, diagnostics);
    diagnostics.throw_if_errors();
    ModelOptions options;
    options.subcase = 1;
    const auto model = build_model(deck, options, diagnostics);
    calc_static_load(model, deck, model.subcase(), diagnostics);  // without K_G: nothing to say
    EXPECT_EQ(std::ranges::count(diagnostics.items(), "fe.dead-load", &Diagnostic::id), 0);
    report_dead_loads(deck, model.subcase().load, diagnostics);
    std::string what;
    for (const auto& item : diagnostics.items())
      if (item.id == "fe.dead-load") what += item.what + "\n";
    return what;
  };
  EXPECT_EQ(count(""), "");
  EXPECT_EQ(count("PLOAD1,10,1,FY,FR,0.,1.,1.,1.\n"), "");
  EXPECT_EQ(count("FORCE1,10,5,2.,1,2\nFORCE1,10,3,2.,1,2\nMOMENT2,10,3,2.,1,2,1,4\nPLOAD1,10,1,FYE,FR,0.,1.,1.,1.\n"
                  "RFORCE,10,1,,.1,0.,0.,1.\nFORCE1,11,5,2.,1,2\n"),
            "load set 10 keeps its direction where the structure moves, though PARAM,FOLLOWK,YES asks it to follow: "
            "FORCE1 (2), MOMENT2 (1), PLOAD1 in element axes (1), RFORCE (1)\n");
}

}  // namespace
}  // namespace bough::fe
