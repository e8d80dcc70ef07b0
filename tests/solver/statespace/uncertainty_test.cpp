#include "solver/statespace/uncertainty.hpp"

#include <gtest/gtest.h>

#include "solver/statespace/poles.hpp"

namespace bough::statespace {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Two masses in a row on springs, pushed at the second; outputs: its place and its acceleration.
records::LinearModel make_chain(double m1, double k2, double c2) {
  MatrixXd M(2, 2), K(2, 2), D(2, 2);
  M << m1, 0, 0, 1.5;
  K << 40 + k2, -k2, -k2, k2;
  D << 0.3 + c2, -c2, -c2, c2;
  records::LinearModel model;
  model.mass = M;
  model.A = MatrixXd::Zero(4, 4);
  model.A.topRightCorner(2, 2).setIdentity();
  model.A.bottomLeftCorner(2, 2) = -M.inverse() * K;
  model.A.bottomRightCorner(2, 2) = -M.inverse() * D;
  model.B = MatrixXd::Zero(4, 1);
  model.B.bottomRows(2) = M.inverse().col(1);
  model.C = MatrixXd::Zero(2, 4);
  model.C(0, 1) = 1;
  model.C.row(1) = model.A.row(3);
  model.D = MatrixXd::Zero(2, 1);
  model.D(1, 0) = model.B(3, 0);
  model.states.name = {"a", "b", "a_dot", "b_dot"};
  model.inputs = {{"push"}, {"F"}};
  model.outputs = {{"place", "felt"}, {"L", "L/T^2"}};
  model.poles = calc_poles(model.A, model.states.name);
  return model;
}

records::LinearModel make_uncertain_chain() {
  const std::vector<ParameterEnds> ends{
      {"m1", 1, 3, make_chain(1, 10, 0.2), make_chain(3, 10, 0.2)},
      {"k2", 4, 16, make_chain(2, 4, 0.2), make_chain(2, 16, 0.2)},
      {"c2", 0, 0.4, make_chain(2, 10, 0), make_chain(2, 10, 0.4)},
  };
  return make_uncertain_model(make_chain(2, 10, 0.2), ends, make_chain(3, 16, 0.4), 1e-13, {});
}

TEST(Uncertainty, IsTheModelAtEachValue) {
  const auto model = make_uncertain_chain();
  ASSERT_EQ(model.uncertainty.size(), 3U);
  for (const auto& one : model.uncertainty) EXPECT_EQ(one.size, 1) << one.name;
  EXPECT_EQ(model.inputs.name, (std::vector<std::string>{"m1:w1", "k2:w1", "c2:w1", "push"}));
  EXPECT_EQ(model.outputs.name.front(), "m1:z1");
  for (const double a : {-1.0, -0.3, 0.8})
    for (const double b : {-0.7, 1.0})
      for (const double c : {-1.0, 0.5}) {
        const auto closed = close_uncertainty(model, Eigen::Vector3d(a, b, c));
        const auto expected = make_chain(2 + a, 10 + 6 * b, 0.2 + 0.2 * c);
        EXPECT_TRUE(closed.A.isApprox(expected.A, 1e-13));
        EXPECT_TRUE(closed.B.isApprox(expected.B, 1e-13));
        EXPECT_TRUE(closed.C.isApprox(expected.C, 1e-13));
        EXPECT_TRUE(closed.D.isApprox(expected.D, 1e-13));
        EXPECT_TRUE(closed.poles.imag.isApprox(expected.poles.imag, 1e-12));
        EXPECT_EQ(closed.outputs.name, expected.outputs.name);
      }
}

TEST(Uncertainty, RefusesWhatIsNotAffine) {
  const auto at = [](double s) { return make_chain(2, s * s, 0.2); };
  const std::vector<ParameterEnds> ends{{"s", 2, 4, at(2), at(4)}};
  EXPECT_THROW(make_uncertain_model(at(3), ends, at(4), 1e-13, {}), InputError);
  const std::vector<ParameterEnds> none{{"s", 2, 4, at(3), at(3)}};
  EXPECT_THROW(make_uncertain_model(at(3), none, at(3), 1e-13, {}), InputError);
}

/// The mass becomes zero beyond the range of its parameter: the equations have no solution.
TEST(Uncertainty, TellsWhereThereIsNoSolution) {
  const auto model = make_uncertain_chain();
  try {
    close_uncertainty(model, Eigen::Vector3d(-2, 0, 0));
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items().front().id, "linear.no-inverse");
  }
}

TEST(Uncertainty, EigenvectorsOfBadlyScaledMatrices) {
  const auto model = make_chain(2, 10, 0.2);
  MatrixXd A = model.A;
  const VectorXd scale = Eigen::Vector4d(1e-6, 1, 1e5, 1e-3);
  A = scale.asDiagonal() * A * scale.cwiseInverse().asDiagonal();
  for (Eigen::Index i = 0; i < 4; ++i) {
    const std::complex<double> value(model.poles.real[i], model.poles.imag[i]);
    const Eigen::VectorXcd v = calc_eigenvector(A, value);
    EXPECT_NEAR(v.norm(), 1, 1e-14);
    const Eigen::VectorXcd off = (A * v - value * v).cwiseQuotient(scale.cast<std::complex<double>>());
    EXPECT_LT(off.norm(), 1e-8 * v.cwiseQuotient(scale.cast<std::complex<double>>()).norm());
  }
}

}  // namespace
}  // namespace bough::statespace
