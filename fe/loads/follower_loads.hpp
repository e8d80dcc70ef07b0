#pragma once
/// \file Loads that follow the grids: pressures without a direction, FORCE1, FORCE2, MOMENT1, MOMENT2.
#include <array>
#include <functional>
#include <vector>

#include "fe/model/model.hpp"

namespace bough::fe {

/// Pressure along the normal of a face, on the area that the face has where its nodes are.
struct FollowerPressure {
  std::vector<int> nodes;         ///< corners, then the midside nodes that are there; indices of nodes
  std::vector<char> has_midside;  ///< as of calc_face_load
  std::vector<double> p;          ///< [F/L²] at the corners
};

/// Force or moment of fixed size along x_1 - x_0, or along (x_1 - x_0) × (x_3 - x_2).
struct FollowerForce {
  int node = 0;
  bool is_moment = false, is_cross = false;
  double size = 0;             ///< [F or F L]
  std::array<int, 4> nodes{};  ///< indices of nodes; two unless `is_cross`
};

struct FollowerLoads {
  std::vector<FollowerPressure> pressures;
  std::vector<FollowerForce> forces;

  /// Returns true if no load follows the grids.
  bool empty() const { return pressures.empty() && forces.empty(); }
};

/// The loads of a set that follow; errors of its cards are those of calc_load().
FollowerLoads find_follower_loads(const Model& model, const records::Deck& deck, int set);

/// F += scale times the loads of nodes that are at x + u. u, F: num_gdofs, basic; rows of rotations of u are not read.
void add_follower_forces(const NodeTable& nodes, const FollowerLoads& loads, double scale, const VectorXd& u,
                         VectorXd& F);

/// Load stiffness: calls visit(gdofs, K) for each load, K = -∂F/∂u of the same F, without symmetry. A dof may occur
/// twice. Source: H. D. Hibbitt, IJNME 14 (1979) 937.
void visit_follower_stiffness(const NodeTable& nodes, const FollowerLoads& loads, const VectorXd& u,
                              const std::function<void(const std::vector<int>& gdofs, const MatrixXd& K)>& visit);

}  // namespace bough::fe
