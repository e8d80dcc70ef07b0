// The Simscape set of a clamped Euler beam reduced to its tip: the free beam element's own matrices.
#include "formats/export/reduced_solid.hpp"

#include <gtest/gtest.h>

#include "base/rotation.hpp"

namespace bough {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr double L = 2, EA = 700, EI = 3, mu = 5;

/// Bending in a plane: v1 θ1 v2 θ2, stiffness and consistent mass (Przemieniecki, Theory of Matrix Structural Analysis,
/// 1968, eqs. 5.115 and 11.27), placed among the twelve dofs; sign: of the rotation in that plane.
void add_bending(MatrixXd& K, MatrixXd& M, int v, int r, double sign) {
  Eigen::Matrix4d k, m;
  k << 12, 6 * L, -12, 6 * L, 6 * L, 4 * L * L, -6 * L, 2 * L * L, -12, -6 * L, 12, -6 * L, 6 * L, 2 * L * L, -6 * L,
      4 * L * L;
  m << 156, 22 * L, 54, -13 * L, 22 * L, 4 * L * L, 13 * L, -3 * L * L, 54, 13 * L, 156, -22 * L, -13 * L, -3 * L * L,
      -22 * L, 4 * L * L;
  const int at[4] = {v, r, v + 6, r + 6};
  const double s[4] = {1, sign, 1, sign};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      K(at[i], at[j]) += s[i] * s[j] * k(i, j) * EI / (L * L * L);
      M(at[i], at[j]) += s[i] * s[j] * m(i, j) * mu * L / 420;
    }
}

void add_axial(MatrixXd& K, MatrixXd& M, int d, double stiffness, double inertia) {
  for (int i : {d, d + 6})
    for (int j : {d, d + 6}) {
      K(i, j) += (i == j ? 1 : -1) * stiffness / L;
      M(i, j) += (i == j ? 2 : 1) * inertia * L / 6;
    }
}

class ReducedSolid : public testing::Test {
 protected:
  ReducedSolid() {
    add_axial(K_, M_, 0, EA, mu);
    add_axial(K_, M_, 3, 2, 0.4);
    add_bending(K_, M_, 1, 5, 1);
    add_bending(K_, M_, 2, 4, -1);
    // Clamped at node 1 in the origin; η are the six displacements of node 2, mixed by a matrix of full rank.
    const Vector3d p(L, 0, 0);
    MatrixXd R = MatrixXd::Identity(12, 6);
    R.bottomRows(6).setIdentity();
    R.block(6, 3, 3, 3) = -skew(p);
    mix_ = MatrixXd::Identity(6, 6) + 0.3 * MatrixXd::Ones(6, 6);
    MatrixXd Phi = MatrixXd::Zero(12, 6);
    Phi.bottomRows(6) = mix_;
    const MatrixXd rigid = R.transpose() * M_ * R, coupling = R.transpose() * M_ * Phi;
    body_.mass = rigid(0, 0);
    body_.cg = Vector3d(L / 2, 0, 0);
    body_.inertia = rigid.bottomRightCorner(3, 3);
    body_.node_id = {1, 2};
    body_.node_xyz = MatrixXd::Zero(2, 3);
    body_.node_xyz.row(1) = p.transpose();
    body_.interface_nodes = {2};
    body_.phi = {Phi.topRows(6), Phi.bottomRows(6)};
    body_.eigenvalue = body_.frequency_hz = Eigen::VectorXd::Zero(6);
    body_.kind.assign(6, records::ModeKind::Constraint);
    body_.modal_mass = Phi.transpose() * M_ * Phi;
    body_.modal_stiffness = Phi.transpose() * K_ * Phi;
    body_.modal_damping = 0.01 * body_.modal_stiffness;
    body_.integrals_method = "consistent";
    body_.consistent.gamma0 = coupling.topRows(3);
    body_.consistent.gamma1 = coupling.bottomRows(3);
  }
  MatrixXd K_ = MatrixXd::Zero(12, 12), M_ = K_, mix_;
  records::FlexBody body_;
  std::string why_;
};

TEST_F(ReducedSolid, GivesTheFreeElement) {
  const auto solid = exports::calc_reduced_solid(body_, why_);
  ASSERT_TRUE(solid) << why_;
  EXPECT_EQ(solid->node, (std::vector<int>{0, 2}));
  EXPECT_EQ(solid->P(1, 0), L);
  EXPECT_LT((solid->K - K_).norm(), 1e-12 * K_.norm());
  EXPECT_LT((solid->M - M_).norm(), 1e-12 * M_.norm());
  EXPECT_LT((solid->C - 0.01 * K_).norm(), 1e-12 * K_.norm());
}

TEST_F(ReducedSolid, TheNodeInTheBodyFrameMayBeOfTheInterface) {
  body_.interface_nodes = {1, 2};
  const auto solid = exports::calc_reduced_solid(body_, why_);
  ASSERT_TRUE(solid) << why_;
  EXPECT_EQ(solid->node, (std::vector<int>{1, 2}));
  EXPECT_LT((solid->K - K_).norm(), 1e-12 * K_.norm());
}

TEST_F(ReducedSolid, SaysWhyThereIsNone) {
  body_.interface_nodes = {};
  EXPECT_FALSE(exports::calc_reduced_solid(body_, why_));
  EXPECT_NE(why_.find("6 constraint modes and 0 interface nodes"), std::string::npos) << why_;
  body_.interface_nodes = {1};
  EXPECT_FALSE(exports::calc_reduced_solid(body_, why_));
  EXPECT_NE(why_.find("one to one"), std::string::npos) << why_;
  body_.kind.assign(6, records::ModeKind::Normal);
  EXPECT_FALSE(exports::calc_reduced_solid(body_, why_));
  EXPECT_NE(why_.find("no constraint modes"), std::string::npos) << why_;
}

}  // namespace
}  // namespace bough
