#pragma once
/// \file Grids that follow the mean of others (RBE3), for motions beyond first order.
#include <vector>

#include "fe/corotational/mean_series.hpp"
#include "fe/model/model.hpp"
#include "fe/model/rigid_arms.hpp"
#include "formats/records/deck.hpp"

namespace bough::fe {

/// Returns the means of the RBE3s of a deck that join translations of grids alike, all three each, with all rotations
/// or none, and whose dependent components are 123 or 123456 of the reference grid.
std::vector<WeightedMean> list_weighted_means(const records::Deck& deck, const Model& model);

/// A grid that goes with a mean as part of a rigid body: the reference grid, and the ends of rigid arms on it.
struct MeanTie {
  int node = 0;
  int mean = 0;  ///< index of the mean
  bool translates = false, rotates = false;
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();  ///< from the centre, basic
};

class MeanTies {
 public:
  /// `arms`: of the same model.
  MeanTies(const records::Deck& deck, const Model& model, const RigidArms& arms);

  /// One per dependent grid, ascending by node.
  const std::vector<MeanTie>& list() const { return ties_; }
  /// The tie of a node; nullptr: none.
  const MeanTie* find(int node) const;
  /// The mean of a tie.
  const WeightedMean& get_mean(const MeanTie& tie) const { return get_mean(tie.mean); }
  const WeightedMean& get_mean(int mean) const { return means_[static_cast<std::size_t>(mean)]; }
  /// Ids of grids and scalar points that equations join to others in no such way: MPC, splines, some components alone.
  const std::vector<int>& others() const { return others_; }

 private:
  std::vector<WeightedMean> means_;
  std::vector<MeanTie> ties_;
  std::vector<int> others_;
};

}  // namespace bough::fe
