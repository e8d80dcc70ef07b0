#pragma once
/// \file [[constraint]]: what closes loops of a tree of bodies, or couples hinge coordinates, as the user wrote it.
#include <limits>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/flex_body.hpp"

namespace bough::records {

enum class HingeType;

enum class ConstraintType { Hinge, Distance, PointOnLine, PointOnPlane, Coupler, Rolling, KnifeEdge, RateCoupler };

struct ConstraintRecord {
  std::string name;
  ConstraintType type = ConstraintType::Hinge;
  HingeType hinge{};  ///< ConstraintType::Hinge: which; axis, axis2, rotations, translations, pitch as in HingeRecord
  std::string parent = "ground", child;
  int parent_node = 0, child_node = 0;
  Vector3d parent_position = Vector3d::Zero(), child_position = Vector3d::Zero();
  Matrix3d parent_rotation = Matrix3d::Identity(), child_rotation = Matrix3d::Identity();
  Vector3d axis = Vector3d::UnitZ();   ///< also of the line, and the normal of the plane, through Hp
  Vector3d axis2 = Vector3d::UnitY();  ///< also of the rolling disc, in Hc
  std::string rotations, translations;
  double pitch = 0;
  double length = 0;             ///< distance
  double radius = 0, crown = 0;  ///< rolling: of the circle of centres, of the cross-section
  struct Term {
    std::string hinge;
    int coordinate = 1;  ///< 1-based
    double ratio = 1;
  };
  std::vector<Term> terms;  ///< coupler: Σ ratio q = offset; rate coupler: Σ ratio u = 0
  double offset = 0;
  bool active = true;  ///< at the start
  SourceLocation at;
};

}  // namespace bough::records
