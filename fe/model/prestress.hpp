#pragma once
/// \file Prestress: the state of stress that a model starts from, and its terms of the stiffness
/// (docs/theory/preload.md).
#include <string>

#include "fe/model/links.hpp"

namespace bough::fe {

using Vector12d = Eigen::Matrix<double, 12, 1>;

/// K_G0 of a load with its static solution, in the order of the elements and on the g-set: good for every model of the
/// same deck, whatever its constraints.
struct Prestress {
  std::string name;                   ///< what loads: "subcase 1 (LOAD 3)", for messages and files
  SourceLocation at;                  ///< what asks for it
  std::vector<VectorXd> force;        ///< internal forces by index into Model::elements(); empty where there are none
  std::vector<QuadraticForm> forms;   ///< of one load: arms, carried masses, links, pressures
  Vector12d A_I = Vector12d::Zero();  ///< of the accelerated frame among the loads, about Bo
};

}  // namespace bough::fe
