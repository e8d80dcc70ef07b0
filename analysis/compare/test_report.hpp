#pragma once
/// \file Modes of an analysis against the shapes of a test, and places for sensors.
#include <optional>
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "modal/compare/correlation.hpp"

namespace bough::analysis {

struct TestRequest {
  std::string model;           ///< modes file or flexible body
  std::string shapes;          ///< universal file of the test
  std::string deck;            ///< of the model, for guyan and irs
  std::string kind = "serep";  ///< test-analysis model: serep, guyan, irs
};

struct TestReport {
  std::string file_a, file_b;
  modal::ModalModel a, b;  ///< analysis; test, with real shapes
  modal::NodeMatch match;
  std::vector<modal::MeasuredDof> dofs;
  Eigen::MatrixXd mac;                 ///< at the measured dofs
  std::vector<modal::ModePair> pairs;  ///< in order of the analysis
  Eigen::VectorXd collinearity;        ///< modal phase collinearity of each test mode
  Eigen::VectorXd damping;             ///< of the test modes
  std::string kind;
  Eigen::MatrixXd mass;      ///< of the test-analysis model, dofs x dofs
  Eigen::VectorXd model_hz;  ///< frequencies of the test-analysis model; empty: those of the analysis (SEREP)
  Eigen::MatrixXd cross_orthogonality;  ///< analysis x test, shapes of unit mass in `mass`
  Eigen::MatrixXd self_orthogonality;   ///< test x test
  Eigen::VectorXd comac;                ///< per measured dof
};

/// Warning: cli.test-dofs. Throws InputError "cli.no-common-nodes", "cli.test-unmeasured", "cli.test-rank",
/// "cli.test-deck", "cli.test-axes", those of the readers and of fe.
TestReport compare_with_test(const TestRequest& request, Events& events);

struct SensorReport {
  std::string file;
  modal::ModalModel model;
  std::vector<std::pair<int, int>> dofs;  ///< node id, component 1..3, ascending
  Eigen::VectorXd independence;           ///< diagonal of A of each
  Eigen::MatrixXd mac;                    ///< of the modes with themselves at these dofs
  int num_candidates = 0;
};

/// Places for `number` sensors among the translations of all nodes, by effective independence of the modes of a file.
/// Throws InputError "cli.few-sensors", "cli.test-rank" and those of the readers.
SensorReport place_sensors(const std::string& file, int number, Events& events);

}  // namespace bough::analysis
