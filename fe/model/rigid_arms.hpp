#pragma once
/// \file Grids that follow another grid as parts of a rigid body (RBE2, RBAR, RBE1 with one independent grid), for
/// motions beyond first order.
#include <vector>

#include "fe/model/model.hpp"

namespace bough::fe {

/// A grid at the end of an arm on another one: its translations, its rotations or both follow.
struct RigidArm {
  int node = 0, parent = 0;  ///< indices into model.nodes()
  bool translates = false, rotates = false;
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();  ///< from the parent, basic
};

class RigidArms {
 public:
  /// Read off the constraint equations u_g = T u_f of the model, chains resolved.
  explicit RigidArms(const Model& model);

  /// All arms, one per dependent grid.
  const std::vector<RigidArm>& list() const { return arms_; }
  /// The arm of a node; nullptr: it moves by itself.
  const RigidArm* find(int node) const;
  /// Ids of grids and scalar points that equations join to others in another way: RBE3, MPC, some components alone.
  const std::vector<int>& others() const { return others_; }

 private:
  std::vector<RigidArm> arms_;  ///< by node, ascending
  std::vector<int> others_;
};

}  // namespace bough::fe
