#pragma once
/// \file Small controlled systems and what they should do: matrix exponentials of their own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <unsupported/Eigen/MatrixFunctions>

#include "tests/solver/support/runs.hpp"

namespace bough::solver::testing {

inline records::ControllerRecord make_law(const std::string& name, const std::string& type,
                                          const std::vector<std::string>& inputs,
                                          const std::map<std::string, std::vector<double>>& numbers = {}) {
  records::ControllerRecord r;
  r.name = name;
  r.type = type;
  r.inputs = inputs;
  r.settings.numbers = numbers;
  r.at = {"system.toml", 40, 1};
  return r;
}

inline records::ActuatorRecord make_drive(const std::string& name, const std::string& hinge, const std::string& input) {
  records::ActuatorRecord r;
  r.name = name;
  r.type = "hinge";
  r.hinge = hinge;
  r.input = input;
  r.at = {"system.toml", 50, 1};
  return r;
}

inline records::FunctionRecord make_step(const std::string& name, double value, double at) {
  return make_function(name, "step", {{"value", value}, {"at", at}});
}

/// A rotor of inertia 2 about z on a hinge, with sensors angle and rate and a drive with the input "law".
inline records::SystemSpec make_axis() {
  records::SystemSpec spec;
  spec.bodies = {make_body_record("rotor", 1, {1, 1, 2})};
  spec.hinges = {make_hinge_record("axis", records::HingeType::Revolute, "ground", "rotor")};
  spec.hinges[0].axis = {0, 0, 1};
  spec.sensors = {make_sensor("angle", records::SensorType::HingeAngle, "", "axis"),
                  make_sensor("rate", records::SensorType::HingeRate, "", "axis")};
  spec.actuators = {make_drive("drive", "axis", "law")};
  spec.simulation.duration = 5;
  spec.simulation.output_step = 0.05;
  spec.simulation.integrator = "rk";
  spec.simulation.relative_tolerance = 1e-11;
  spec.simulation.absolute_tolerance = 1e-13;
  spec.simulation.at = {"system.toml", 20, 1};
  return spec;
}

/// x(t) of ẋ = A x + b.
inline VectorXd propagate(const MatrixXd& A, const VectorXd& b, const VectorXd& x, double t) {
  const auto n = A.rows();
  MatrixXd all = MatrixXd::Zero(n + 1, n + 1);
  all.topLeftCorner(n, n) = A;
  all.topRightCorner(n, 1) = b;
  VectorXd start(n + 1);
  start << x, 1;
  return ((all * t).exp() * start).head(n);
}

}  // namespace bough::solver::testing
