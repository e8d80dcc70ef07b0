/// DMIG selected by K2GG, M2GG, B2GG: a frame's own matrices, written out in skewed displacement systems, give the
/// frame.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "fe/elements/damping.hpp"
#include "model_matrices.hpp"
#include "text_model.hpp"

namespace bough::fe {
namespace {

using test::build;
using test::count;
using test::get_mass;
using test::get_stiffness;
using test::rotate_to_displacement_axes;

const std::string kGrids =
    "CORD2R,3,,1.,2.,3.,2.,3.,5.\n,4.,1.,0.\nCORD2C,4,,0.,0.,-1.,0.,1.,1.\n,3.,0.,0.\nPARAM,WTMASS,.0025\n"
    "PARAM,COUPMASS,1\n"
    "GRID,1,,0.,0.,0.,3\nGRID,2,,1.,.2,.1,4\nGRID,3,,1.3,1.4,-.2\nGRID,4,,.5,2.7,2.,3\nSPOINT,9\nCELAS2,8,7000.,9,0,3,"
    "2\n"
    "CMASS2,7,40.,9\nSPC1,1,123456,1\n";
const std::string kBars =
    "CBAR,1,5,1,2,0.,1.,1.\nCBAR,2,5,2,3,0.,0.,1.\nCBAR,3,5,3,4,1.,0.,0.\nPBAR,5,6,.01,2.-4,1.-4,1.5-4\n"
    "MAT1,6,7.+7,,.3,2700.\n";

/// A symmetric DMIG in free field with all digits, its terms now above, now below the diagonal.
std::string write_dmig(const Model& model, const std::string& name, const MatrixXd& A, int form = 6) {
  const auto map = model.calc_dof_map();
  std::string text = "DMIG," + name + ",0," + std::to_string(form) + ",2,0\n";
  char line[120];
  for (int i = 0; i < A.rows(); ++i)
    for (int j = 0; j < (form == 6 ? i + 1 : A.cols()); ++j) {
      if (A(i, j) == 0) continue;
      const bool swap = form == 6 && (i + j) % 2 == 0;
      const int r = swap ? j : i, c = swap ? i : j;
      std::snprintf(line, sizeof line, "DMIG,%s,%d,%d,,%d,%d,%.17g\n", name.c_str(), map(c, 0), map(c, 1), map(r, 0),
                    map(r, 1), form == 6 ? A(i, j) : A(r, c));
      text += line;
    }
  return text;
}

/// 1/ω², ascending: M φ = 1/ω² K φ, for the end of a bar turns about it without mass.
VectorXd calc_inverse_eigenvalues(const Model& model) {
  const MatrixXd T = MatrixXd(model.T());
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(T.transpose() * get_mass(model) * T,
                                                            T.transpose() * get_stiffness(model) * T)
      .eigenvalues();
}

TEST(DirectMatrices, ABarsOwnMatricesAreTheBars) {
  const std::string case_control = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n";
  const auto bars = build(case_control + kGrids + kBars);
  const auto ends = build(case_control + kGrids);
  // What the bars alone bring; the mass is already times WTMASS, which does not act on M2GG.
  const MatrixXd K = get_stiffness(bars) - get_stiffness(ends), M = get_mass(bars) - get_mass(ends);
  const auto direct =
      build("SOL 103\nCEND\nSPC = 1\nK2GG = 4.*KA, 2.*KB\nM2GG = MA\nBEGIN BULK\nPARAM,CK2,.5\nPARAM,CM2,2.\n" +
            kGrids + write_dmig(bars, "KA", rotate_to_displacement_axes(bars, K) / 4) +
            write_dmig(bars, "KB", rotate_to_displacement_axes(bars, K) / 2, 1) +
            write_dmig(bars, "MA", rotate_to_displacement_axes(bars, M) / 2));
  EXPECT_LT((get_stiffness(direct) - get_stiffness(bars)).norm(), 1e-13 * K.norm());
  EXPECT_LT((get_mass(direct) - get_mass(bars)).norm(), 1e-13 * M.norm());
  const VectorXd f = calc_inverse_eigenvalues(bars), g = calc_inverse_eigenvalues(direct);
  ASSERT_EQ(f.size(), 19);
  EXPECT_LT(std::max(std::abs(f[0]), std::abs(g[0])), 1e-12 * f[18]);  // the turn about the last bar
  EXPECT_GT(f[1], 1e-9 * f[18]);
  EXPECT_LT(((g - f).array() / f.array()).tail(18).abs().maxCoeff(), 1e-9);
  // An element per pair of coupled points, the scalar point's spring apart.
  int elements = 0;
  for (const auto& element : direct.elements()) elements += element->card() == "DMIG" ? 1 : 0;
  EXPECT_EQ(elements, 2 * (4 + 3));
}

TEST(DirectMatrices, DampingGoesToB) {
  const auto model = build("CEND\nB2GG = BA\nBEGIN BULK\n" + kGrids +
                           "DMIG,BA,0,6,1,0\nDMIG,BA,3,2,,3,2,5.\n,9,0,-4.\nDMIG,BA,9,0,,9,0,3.\n");
  MatrixXd B = MatrixXd::Zero(model.num_gdofs(), model.num_gdofs());
  for (const auto& element : model.elements()) {
    if (!element->damping()) continue;
    MatrixXd own = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
    element->damping()->add_damping(1, own);
    B(element->gdofs(), element->gdofs()) += own;
  }
  const int g = model.node(model.find_node(3)).first_gdof + 1, s = model.node(model.find_node(9)).first_gdof;
  EXPECT_EQ(B(g, g), 5);
  EXPECT_EQ(B(g, s), -4);
  EXPECT_EQ(B(s, g), -4);
  EXPECT_EQ(B(s, s), 3);
  EXPECT_EQ(B.cwiseAbs().sum(), 16);
  EXPECT_EQ((get_stiffness(model) - get_stiffness(build(kGrids))).norm(), 0);
}

TEST(DirectMatrices, WhatIsWrong) {
  const std::string head = "CEND\nK2GG = KA\nBEGIN BULK\n";
  EXPECT_EQ(count(head + kGrids, "fe.missing-direct"), 1);
  EXPECT_EQ(count(kGrids + "DMIG,KA,0,6,1,0\n", "fe.direct-unused"), 1);
  // Of responses: the case control says that its command is not used.
  EXPECT_EQ(count("K2PP = KA\n" + kGrids + "DMIG,KA,0,6,1,0\n", "fe.direct-unused"), 0);
  EXPECT_EQ(count(head + kGrids + "DMIG,KA,0,1,1,0\nDMIG,KA,1,1,,2,1,1.\n", "fe.direct-not-symmetric"), 1);
  EXPECT_EQ(count(head + kGrids + "DMIG,KA,0,9,1,0,,,1\nDMIG,KA,1,1,,1,1,1.\n", "fe.direct-not-symmetric"), 1);
  EXPECT_EQ(count(head + kGrids + "DMIG,KA,0,6,3,0\nDMIG,KA,1,1,,2,1,1.,2.\n", "fe.direct-complex"), 1);
  EXPECT_EQ(count(head + kGrids + "DMIG,KA,0,6,3,0\nDMIG,KA,1,1,,2,1,1.,0.\n", "fe.direct-complex"), 0);
  EXPECT_EQ(count(head + kGrids + "DMIG,KA,0,6,1,0\nDMIG,KA,1,1,,77,1,1.\n,77,2,1.\n", "fe.missing-grid"), 1);
  EXPECT_EQ(count(head + kGrids + "DMIG,KA,0,6,1,0\nDMIG,KA,1,1,,2,0,1.\n", "fe.bad-component"), 1);
  EXPECT_EQ(count(head + kGrids + "DMIG,KA,0,6,1,0\nDMIG,KA,1,1,,2,1,1.\nPARAM,CK1,2.\n", "fe.unsupported-param"), 1);
}

}  // namespace
}  // namespace bough::fe
