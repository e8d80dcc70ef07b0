/// RBE3, RROD and scalar points, from decks to the transformation.
#include <gtest/gtest.h>

#include "fe/matrices/assembly.hpp"
#include "text_model.hpp"

namespace bough::fe {
namespace {

using test::build;
using test::count;

MatrixXd get_dense(const Model& model) { return MatrixXd(model.T()); }

/// Motions of all grids that T can give hold the six rigid ones.
void expect_rigid_motions(const Model& model) {
  const MatrixXd T = get_dense(model), U = model.calc_rigid_modes();
  const MatrixXd q = T.colPivHouseholderQr().solve(U);
  EXPECT_LT((T * q - U).norm(), 1e-12 * U.norm());
}

const std::string kSquare =
    "CORD2R,3,,1.,2.,3.,2.,3.,5.\n,4.,1.,0.\nGRID,9,,0.,0.,0.\nGRID,1,,1.,1.,0.\nGRID,2,,-1.,1.,0.,3\n"
    "GRID,3,,-1.,-1.,0.\nGRID,4,,1.,-1.,0.\n";

TEST(Rbe3, CarriesRigidMotionsAndSpreadsForces) {
  const auto model = build(kSquare + "RBE3,5,,9,123456,1.,123,1,2\n,3,4\n");
  EXPECT_EQ(model.num_fdofs(), 24);
  expect_rigid_motions(model);
  // A force at the centre goes to the four grids in equal parts, a moment about z as tangential forces M / (4 r).
  const MatrixXd T = get_dense(model);
  VectorXd F = VectorXd::Zero(30);
  const int ref = model.node(model.find_node(9)).first_gdof;
  F[ref + 2] = 8;
  F[ref + 5] = 4;
  const VectorXd spread = T.transpose() * F;
  for (int grid : {1, 3, 4}) {  // in basic axes
    const Node& node = model.node(model.find_node(grid));
    const int f = model.find_fdof(model.find_node(grid), 1);
    const Vector3d tangent = Vector3d::UnitZ().cross(node.x);
    EXPECT_LT((spread.segment<3>(f) - Vector3d(0, 0, 2) - 4.0 / 8 * tangent).norm(), 1e-12) << grid;
  }
}

TEST(Rbe3, TheFitPassesThroughTwoPairs) {
  const auto model = build(kSquare + "RBE3,5,,9,123,1.,123,1,2\n,3.,123,3,4\n");
  const MatrixXd T = get_dense(model);
  const int row = model.node(model.find_node(9)).first_gdof + 2;
  const int f1 = model.find_fdof(model.find_node(1), 3), f3 = model.find_fdof(model.find_node(3), 3);
  // Least squares of w = a + b y with weights 1 1 3 3 through the means at y = 1 and y = -1: exact there, w(0) is the
  // mean.
  EXPECT_NEAR(T(row, f1), 0.25, 1e-12);
  EXPECT_NEAR(T(row, f3), 0.25, 1e-12);
  expect_rigid_motions(model);
}

TEST(Rbe3, OtherDependentComponentsKeepTheSameMotions) {
  const std::string card = "RBE3,5,,9,123,1.,123,1,2\n,3,4";
  const MatrixXd A = get_dense(build(kSquare + card + "\n"));
  const MatrixXd B = get_dense(build(kSquare + card + "\n,UM,1,3,2,12\n"));
  ASSERT_EQ(A.cols(), B.cols());
  const MatrixXd q = A.colPivHouseholderQr().solve(B);
  EXPECT_LT((A * q - B).norm(), 1e-12 * B.norm());
}

TEST(Rbe3, Errors) {
  EXPECT_EQ(
      count("GRID,1,,0.,1.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\nRBE3,5,,1,123,1.,123,2,3\n", "fe.rbe3-mechanism"),
      1);
  EXPECT_EQ(count(kSquare + "RBE3,5,,9,123,1.,123,1,2\n,3,4\n,UM,1,3\n", "fe.rigid-independent"), 1);
  EXPECT_EQ(count(kSquare + "RBE3,5,,9,123,1.,123,1,77\n", "fe.missing-grid"), 1);
}

TEST(Rrod, KeepsItsLength) {
  const auto model = build("GRID,1,,0.,0.,0.\nGRID,2,,3.,4.,0.\nRROD,5,1,2,,2\n");
  EXPECT_EQ(model.num_fdofs(), 11);
  expect_rigid_motions(model);
  const MatrixXd T = get_dense(model);
  const MatrixXd stretch = 0.6 * (T.row(6) - T.row(0)) + 0.8 * (T.row(7) - T.row(1));
  EXPECT_LT(stretch.norm(), 1e-14);
  EXPECT_EQ(count("GRID,1,,0.,0.,0.\nGRID,2,,3.,4.,0.\nRROD,5,1,2,,3\n", "fe.rigid-independent"), 1);
}

TEST(ScalarPoints, SpringsAndMassesBetweenThem) {
  const auto model = build(
      "SPOINT,11,THRU,12\nCELAS4,1,5.,11,12\nCELAS3,2,3,12\nPELAS,3,7.\nCMASS4,3,2.,13\nCMASS3,4,6,11,13\nPMASS,6,.5\n"
      "SPC1,1,0,13\n");
  ASSERT_EQ(model.num_gdofs(), 3);
  EXPECT_EQ(model.num_fdofs(), 2);
  MatrixXd K = calc_stiffness_times(model, MatrixXd::Identity(3, 3));
  MatrixXd expected(3, 3);
  expected << 5, -5, 0, -5, 12, 0, 0, 0, 0;
  EXPECT_LT((K - expected).norm(), 1e-14);
  K = calc_mass_times(model, MassKind::Lumped, MatrixXd::Identity(3, 3));
  expected << 0.5, 0, -0.5, 0, 0, 0, -0.5, 0, 2.5;
  EXPECT_LT((K - expected).norm(), 1e-14);
  EXPECT_EQ(count("GRID,11\nSPOINT,11\n", "fe.grid-and-scalar"), 1);
}

}  // namespace
}  // namespace bough::fe
