/// Body frames: their conditions hold, and what a body is does not depend on them. Damping of any coordinates.
#include "modal/bases/frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "modal/bases/damping.hpp"
#include "modal/bases/ritz.hpp"
#include "tests/support/modal.hpp"

namespace bough {
namespace {

using modal::bases::DampingSpec;
using modal::bases::DampingTable;
using modal::bases::FrameKind;
using modal::bases::FrameSpec;

fe::Model make_model() {
  Diagnostics diagnostics;
  return fe::build_model(test::make_space_frame().deck, {}, diagnostics);
}

MatrixXd calc_free_modes(const fe::Model& model, int count) {
  Diagnostics diagnostics;
  modal::EigenOptions options;
  options.num_modes = 6 + count;
  return modal::calc_normal_modes(model, options, diagnostics).Phi.rightCols(count);
}

const std::vector<FrameSpec> kFrames = {
    {FrameKind::MeanAxes, {}},   {FrameKind::Node, {3}},       {FrameKind::ThreeNodes, {1, 9, 106}},
    {FrameKind::MassCentre, {}}, {FrameKind::MassCentre, {9}}, {FrameKind::MassCentre, {1, 9, 106}}};

TEST(Frame, ConditionsHold) {
  const auto model = make_model();
  const MatrixXd Phi = calc_free_modes(model, 5);
  const auto at = [&](const MatrixXd& X, int id, int first) -> MatrixXd {
    return X.middleRows(model.node(model.find_node(id)).first_gdof + first, 3);
  };
  const MatrixXd MR = fe::calc_mass_times(model, model.mass_kind(), model.calc_rigid_modes());
  for (const auto& frame : kFrames) {
    const MatrixXd C = modal::bases::calc_reference_conditions(model, frame);
    // A disturbed basis: the rigid motion in it must go.
    const MatrixXd disturbed = Phi + model.calc_rigid_modes() * MatrixXd::Random(6, 5);
    const MatrixXd shifted = modal::bases::shift_to_frame(model, C, disturbed);
    EXPECT_LT((C * shifted).cwiseAbs().maxCoeff(), 1e-11 * C.cwiseAbs().maxCoeff() * Phi.cwiseAbs().maxCoeff());
    EXPECT_LT((shifted - modal::bases::shift_to_frame(model, C, Phi)).norm(), 1e-10 * Phi.norm());
    if (frame.kind == FrameKind::MeanAxes) {
      EXPECT_LT((shifted - Phi).norm(), 1e-9 * Phi.norm());
    }
    if (frame.kind == FrameKind::Node) {
      EXPECT_LT((at(shifted, 3, 0).norm() + at(shifted, 3, 3).norm()), 1e-11);
    }
    if (frame.kind == FrameKind::MassCentre) {
      EXPECT_LT((MR.leftCols(3).transpose() * shifted).cwiseAbs().maxCoeff(), 1e-10);
    }
    if (frame.kind == FrameKind::MassCentre && frame.nodes.size() == 1) {
      EXPECT_LT(at(shifted, 9, 3).cwiseAbs().maxCoeff(), 1e-10);
    }
    if (frame.nodes.size() == 3) {
      const Vector3d a = model.node(model.find_node(1)).x, b = model.node(model.find_node(9)).x,
                     c = model.node(model.find_node(106)).x;
      const Vector3d normal = (b - a).cross(c - a).normalized();
      const MatrixXd b_moves = at(shifted, 9, 0) - at(shifted, 1, 0), c_moves = at(shifted, 106, 0) - at(shifted, 1, 0);
      const Vector3d along = (b - a).normalized();
      EXPECT_LT((b_moves - along * (along.transpose() * b_moves)).cwiseAbs().maxCoeff(), 1e-10);
      EXPECT_LT((normal.transpose() * c_moves).cwiseAbs().maxCoeff(), 1e-10);
      if (frame.kind == FrameKind::ThreeNodes) {
        EXPECT_LT(at(shifted, 1, 0).cwiseAbs().maxCoeff(), 1e-10);
      }
    }
  }
}

// Rigid motions and shifted shapes together span what they did: the same free frequencies from every frame.
TEST(Frame, FreeFrequenciesDoNotDependOnIt) {
  const auto model = make_model();
  const MatrixXd Phi = calc_free_modes(model, 5), R = model.calc_rigid_modes();
  VectorXd first;
  for (const auto& frame : kFrames) {
    const MatrixXd C = modal::bases::calc_reference_conditions(model, frame);
    MatrixXd X(model.num_gdofs(), 11);
    X << R, modal::bases::shift_to_frame(model, C, Phi);
    const MatrixXd M = X.transpose() * fe::calc_mass_times(model, model.mass_kind(), X);
    const MatrixXd K = X.transpose() * fe::calc_stiffness_times(model, X);
    const VectorXd lambda = Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M).eigenvalues();
    EXPECT_LT(lambda.head(6).cwiseAbs().maxCoeff(), 1e-7 * lambda(6));
    if (first.size() == 0) first = lambda;
    for (int j = 6; j < 11; ++j) EXPECT_NEAR(lambda(j) / first(j), 1, 1e-10);
  }
}

TEST(Frame, BadFramesAreErrors) {
  const auto model = make_model();
  for (const auto& frame : std::vector<FrameSpec>{{FrameKind::ThreeNodes, {1, 5, 9}},
                                                  {FrameKind::ThreeNodes, {1, 9}},
                                                  {FrameKind::Node, {}},
                                                  {FrameKind::Node, {777}},
                                                  {FrameKind::MassCentre, {1, 2}}}) {
    try {
      modal::bases::calc_reference_conditions(model, frame);
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_EQ(error.items().front().id, "modal.bad-frame");
    }
  }
}

TEST(Damping, TableIsReadAsTabdmp1) {
  DampingSpec spec;
  spec.table = {{1, 0.02}, {3, 0.04}, {10, 0.04}};
  EXPECT_NEAR(modal::bases::calc_table_ratio(spec, 2), 0.03, 1e-15);
  EXPECT_NEAR(modal::bases::calc_table_ratio(spec, 0.5), 0.015, 1e-15);  // the end lines go on
  EXPECT_NEAR(modal::bases::calc_table_ratio(spec, 50), 0.04, 1e-15);
  spec.table_kind = DampingTable::Structural;
  EXPECT_NEAR(modal::bases::calc_table_ratio(spec, 2), 0.015, 1e-15);
  spec.table = {{1, 25}};
  spec.table_kind = DampingTable::Quality;
  EXPECT_NEAR(modal::bases::calc_table_ratio(spec, 7), 0.02, 1e-15);
}

// Damping belongs to the motion: other coordinates of the same motion, η = T q, have TᵀDT.
TEST(Damping, IsTheSameInEveryCoordinates) {
  const VectorXd omega = (VectorXd(3) << 2 * std::numbers::pi, 20, 70).finished();
  const MatrixXd I = MatrixXd::Identity(3, 3), K = omega.cwiseAbs2().asDiagonal();
  const MatrixXd T = (MatrixXd(3, 3) << 1, 0.2, 0.3, -0.4, 2, 0.1, 0.5, 0.3, 1).finished();
  MatrixXd K_g = (MatrixXd(3, 3) << 5, 1, 2, 1, 8, 3, 2, 3, 30).finished();
  DampingSpec spec;
  EXPECT_TRUE(spec.is_zero());
  spec.table = {{1, 0.02}, {3, 0.04}};
  spec.alpha = 0.3;
  spec.beta = 1e-3;
  spec.structural = 0.01;
  const MatrixXd D = modal::bases::calc_damping(I, K, spec, K_g, {});
  EXPECT_NEAR(D(0, 0), 2 * 0.02 * omega(0) + 0.01 * omega(0) + 5 / omega(0) + 0.3 + 1e-3 * K(0, 0), 1e-12);
  EXPECT_NEAR(D(0, 1), 0, 1e-15);
  const MatrixXd M_T = T.transpose() * T, K_T = T.transpose() * K * T, K_gT = T.transpose() * K_g * T;
  const MatrixXd D_T = modal::bases::calc_damping(M_T, K_T, spec, K_gT, {});
  EXPECT_LT((D_T - T.transpose() * D * T).norm(), 1e-10 * D.norm());
  spec.residual_ratio = 0.5;
  const MatrixXd D_r = modal::bases::calc_damping(I, K, spec, {}, {false, false, true});
  EXPECT_NEAR(D_r(2, 2), 2 * 0.5 * 70 + 0.01 * 70 + 0.3 + 1e-3 * 4900, 1e-10);
}

// Vectors that repeat others, and massless ones, are left out; low values keep their digits beside high ones.
TEST(Ritz, LeavesDependentVectorsOut) {
  const VectorXd k = (VectorXd(3) << 1, 1e3, 1e6).finished();
  MatrixXd T = MatrixXd::Zero(3, 5);
  T << 1, 0.5, 0.2, 1.5, 0, 0, 1, 0.3, 1, 0, 0, 0, 1, 0, 0;  // the fourth is the sum of two, the fifth nothing
  const auto pairs = modal::bases::calc_ritz_pairs(T.transpose() * T, T.transpose() * k.asDiagonal() * T);
  ASSERT_EQ(pairs.lambda.size(), 3);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(pairs.lambda(j) / k(j), 1, 1e-9);
  EXPECT_LT((pairs.N.transpose() * (T.transpose() * T) * pairs.N - MatrixXd::Identity(3, 3)).norm(), 1e-9);
}

}  // namespace
}  // namespace bough
