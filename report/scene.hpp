#pragma once
/// \file The moving system as the page draws it: bodies, hinges, sensors, arrows of forces and moments.
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "report/drawing.hpp"

namespace bough::report {

/// A body of the moving system; its channels are /bodies/NAME/... .
struct SceneBody {
  std::string name;
  Drawing drawing;
  std::vector<std::string> mode_names{};      ///< of a flexible body: "mode 3, 12.41 Hz"
  std::vector<Eigen::MatrixXd> all_shapes{};  ///< as drawing.shapes, of every mode, if the drawing has fewer
  double size = 0;  ///< of the flexible body, against which deflections are held; 0: rigid or not known
};

/// p in the frame of the body (ground: inertial), which goes with the body's point `point` when >= 0.
struct ScenePlace {
  int body = -1;  ///< index of a body; -1: ground
  int point = -1;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
};

/// Drawn at a point of the parent.
struct SceneHinge {
  std::string name, type;
  ScenePlace at;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();          ///< in the frame of the parent; zero: none
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< hinge axes of the parent, in its frame
};

struct SceneSensor {
  std::string name, type;
  ScenePlace at;
  std::optional<ScenePlace> to;                    ///< of a distance
  std::vector<Eigen::Vector3d> axes;               ///< in the frame of the body: x, y, z of an instrument
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< of the hinge that is measured; zero: none
};

/// The vector is R_W(frame) axes v of a channel with three components v, the first column of axes times one component;
/// with `towards` it points there from `at`, times `factor`.
struct SceneArrow {
  std::string name;
  bool is_moment = false, is_reaction = false;
  ScenePlace at;
  std::optional<ScenePlace> towards;
  int frame = -1;  ///< body whose axes; -1: inertial
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double factor = 1;
  std::string channel;
  int column = -1;         ///< of the channel; -1: three components
  Eigen::VectorXd values;  ///< without a channel: at the times of the run
};

struct Scene {
  std::vector<SceneBody> bodies;
  std::vector<SceneHinge> hinges;
  std::vector<SceneSensor> sensors;
  std::vector<SceneArrow> arrows;
};

}  // namespace bough::report
