#pragma once
/// \file Binary glTF 2.0 (.glb): drawings that move, in one file that browsers and office programs show.
#include <string>
#include <vector>

#include "report/drawing.hpp"

namespace bough::report {

/// A drawing at its place; its shapes are morph targets. Rows of position and rotation belong to GltfScene::time;
/// empty: it rests at the origin.
struct GltfBody {
  std::string name;
  Drawing drawing;
  Eigen::MatrixXd position;  ///< nt x 3
  Eigen::MatrixXd rotation;  ///< nt x 4, w x y z
  Eigen::MatrixXd weights;   ///< nt x shapes
};

/// One animation over `time` moves all bodies; or, without time, one animation for each shape of the first body.
struct GltfScene {
  std::string name;
  Eigen::VectorXd time;  ///< ascending
  std::vector<GltfBody> bodies;
  std::vector<std::string> shape_names;  ///< without time: of the animations
  double shape_period = 2;               ///< seconds of their swing
};

/// glTF 2.0 specification, Khronos (2021): chunks JSON and BIN, one buffer, little endian. Numbers are floats, so
/// samples whose times are one float number are drawn once; times start at zero (the first is `extras.first_time`).
std::string make_glb(const GltfScene& scene);

}  // namespace bough::report
