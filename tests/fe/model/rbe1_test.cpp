/// RBE1 from decks to the transformation: against RBE2 and RBAR where they are the same, and against rigid kinematics.
#include <gtest/gtest.h>

#include "text_model.hpp"

namespace bough::fe {
namespace {

using test::build;
using test::count;

/// Five grids in general position, three of them in skewed or cylindrical systems.
const std::string kGrids =
    "CORD2R,3,,1.,2.,3.,2.,3.,5.\n,4.,1.,0.\nCORD2C,4,,0.,0.,-1.,0.,1.,1.\n,3.,0.,0.\n"
    "GRID,1,,0.,0.,0.,3\nGRID,2,,1.,.2,.1,4\nGRID,3,,.3,1.4,-.2\nGRID,4,,-.5,.7,2.,3\nGRID,5,,2.,-1.,.6,4\n";

TEST(Rbe1, IsRbe2WhenOneGridIsIndependent) {
  const MatrixXd A = MatrixXd(build(kGrids + "RBE1,9,2,123456\n,UM,1,1235,4,1235,5,1235\n").T());
  const MatrixXd B = MatrixXd(build(kGrids + "RBE2,9,2,1235,1,4,5\n").T());
  ASSERT_EQ(A.cols(), 30 - 12);
  EXPECT_LT((A - B).norm(), 1e-13 * B.norm());
}

TEST(Rbe1, IsRbarBetweenTwoGrids) {
  // Seen from grid 3 grid 2 is across all axes: 1235 here and 24 there hold the bar.
  const MatrixXd A = MatrixXd(build(kGrids + "RBE1,9,3,1235,2,24\n,UM,3,46,2,1356\n").T());
  const MatrixXd B = MatrixXd(build(kGrids + "RBAR,9,3,2,1235,24\n").T());
  ASSERT_EQ(A.cols(), 30 - 6);
  EXPECT_LT((A - B).norm(), 1e-12 * B.norm());
}

/// 3-2-1 over three grids: all motions are the rigid ones, as their six independent components say.
TEST(Rbe1, FollowsTheRigidMotionOfItsSixComponents) {
  const auto model = build(kGrids + "RBE1,9,1,123,2,13,3,3\n,UM,1,456,2,2456,3,12456\n,,4,123456,5,123456\n");
  ASSERT_EQ(model.num_fdofs(), 6);
  // Rigid motions in the displacement axes of the grids.
  MatrixXd U = model.calc_rigid_modes(Vector3d(.2, -.3, .4));
  for (const Node& node : model.nodes())
    for (const int part : {0, 3})
      U.middleRows<3>(node.first_gdof + part) =
          (node.R_basic_cd.transpose() * U.middleRows<3>(node.first_gdof + part)).eval();
  const std::vector<int> independent{0, 1, 2, 6, 8, 14};
  const MatrixXd expected = U * U(independent, Eigen::all).inverse();
  MatrixXd T = MatrixXd(model.T());
  for (const Node& node : model.nodes())
    for (const int part : {0, 3})
      T.middleRows<3>(node.first_gdof + part) =
          (node.R_basic_cd.transpose() * T.middleRows<3>(node.first_gdof + part)).eval();
  EXPECT_LT((T - expected).norm(), 1e-12 * expected.norm());
}

TEST(Rbe1, Errors) {
  // Three grids on a line: the rotation about it is free.
  EXPECT_EQ(count("GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\nRBE1,9,1,123,2,23,3,3\n,UM,1,456\n",
                  "fe.rigid-independent"),
            1);
  EXPECT_EQ(count(kGrids + "RBE1,9,2,123456\n,UM,2,1,4,1235\n", "fe.rigid-independent"), 1);
  EXPECT_EQ(count(kGrids + "RBE1,9,2,123456\n,UM,77,1\n", "fe.missing-grid"), 1);
  EXPECT_EQ(count(kGrids + "SPOINT,8\nRBE1,9,2,123456\n,UM,8,1\n", "fe.missing-grid"), 1);
}

}  // namespace
}  // namespace bough::fe
