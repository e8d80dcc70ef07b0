#pragma once
/// \file Grids that move as parts of rigid bodies (RBE2, RBAR) or with the mean of others (RBE3) under finite
/// rotations. Theory: docs/theory/nonlinear-statics.md.
#include <vector>

#include "fe/corotational/mean_motion.hpp"
#include "fe/model/mean_ties.hpp"
#include "fe/model/rigid_arms.hpp"

namespace bough::fe {

/// Places of all nodes. Start: undeformed.
struct DeformedState {
  /// num_gdofs: translations and scalar points in basic; rotation vectors of the nodes that linear equations turn,
  /// other rows of rotations are zero.
  VectorXd u;
  std::vector<Matrix3d> R;  ///< rotation of every node
};

class FiniteTies {
 public:
  using Triplets = std::vector<Eigen::Triplet<double>>;

  /// `model` outlives this.
  FiniteTies(const records::Deck& deck, const Model& model);

  /// Returns true if no node follows others.
  bool is_empty() const { return order_.empty(); }
  /// Nodes of the ties, those that follow and those that are followed, ascending.
  std::vector<int> list_nodes() const;
  /// Ids of grids and scalar points that equations tie in another way: MPC, splines, single components, RBE3 of single
  /// components or of more than 1,000 grids.
  const std::vector<int>& others() const { return others_; }

  /// Sets displacements and rotations of the nodes that follow.
  void follow(DeformedState& state) const;
  /// num_gdofs x num_gdofs: variation, displacements and spins, by that of the nodes that follow none; zero columns of
  /// the others.
  SparseRows calc_basis(const DeformedState& state) const;
  /// Adds the derivative of calc_basis()ᵀ forces, forces fixed in space (num_gdofs), as a matrix that is still to be
  /// multiplied by the basis from both sides.
  void add_slopes(const DeformedState& state, VectorXd forces, Triplets& entries) const;

 private:
  /// A node that follows: at a rigid arm, else with a mean.
  struct Tie {
    int node = 0, mean = -1;
    bool translates = false, rotates = false;
    Vector3d arm = Vector3d::Zero();
    std::vector<int> of;  ///< nodes that it follows
  };
  int first_gdof(int node) const { return model_.nodes()[static_cast<std::size_t>(node)].first_gdof; }
  MeanMotion calc_mean(const Tie& tie, const DeformedState& state) const;
  MatrixXd calc_tangent(const Tie& tie, const DeformedState& state) const;

  const Model& model_;
  RigidArms arms_;
  MeanTies means_;
  std::vector<Tie> order_;  ///< each after those that it follows
  std::vector<int> others_;
};

}  // namespace bough::fe
