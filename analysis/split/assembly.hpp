#pragma once
/// \file Joints of the parts, and the tree of hinges that they make.
#include <map>
#include <set>
#include <vector>

#include "analysis/split/partition.hpp"

namespace bough::analysis::splitting {

/// One grid that parts share, or several: rigidly connected to a new one, or each joined by a constraint.
struct Joint {
  std::vector<int> grids;
  std::set<int> parts;
  int node = 0;                                 ///< the grid, or the new one; 0 with is_by_grids
  bool is_new = false;                          ///< each part gets the grid `node` and an RBE2 from it to `grids`
  bool is_average = false;                      ///< an RBE3 instead of the RBE2
  bool is_by_grids = false;                     ///< each grid is an interface node of all its parts
  Eigen::Vector3d x = Eigen::Vector3d::Zero();  ///< of node, in basic
};

/// A fixed joint of two parts; of the ground with a part, those of the components that are held.
struct PartLink {
  int parent = -1, child = 0;  ///< parts; -1: the ground
  int node = 0;                ///< grid of both; of the ground: where it holds the part
  unsigned held = 0b111111;    ///< components that the link holds, in the CD axes of the grid
  bool closes_loop = false;    ///< a constraint instead of a hinge
  bool is_by_grids = false;    ///< a constraint of a joint by its grids
  /// Point of a hinge of the ground without a node, in basic.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

struct Assembly {
  std::vector<Joint> joints;
  std::vector<PartLink> links;    ///< the first is the hinge of part 0
  bool is_held = false;           ///< part 0 is held by the constraints of the deck: its hinge is fixed at node 0
  std::vector<int> clamp;         ///< of each part: the grid at which its hinge carries it; 0 with is_held
  std::vector<char> is_averaged;  ///< of each part: its clamp is an average, of which the grid depends
  std::vector<std::vector<int>> interface;  ///< of each part: grids of its other links
};

/// Returns true if three of the grids are not on one line.
bool spans_plane(const Structure& structure, const std::vector<int>& grids);

/// Joints along the grids that parts share.
///
/// \param interface  "rigid", "average" or "grids", of joints of several grids
/// \throws InputError split.weak-cut if a joint does not transfer moments, split.dependent-cut if grids of a joint of
///     several depend on a rigid element
std::vector<Joint> find_joints(const Structure& structure, const Partition& partition, const std::string& interface);

/// The part with the most held components; the first of a free structure.
int find_most_held(const Structure& structure, const Partition& partition);

/// Hinges from part 0 on, breadth first, and constraints that close loops or hold parts at the ground. A part after a
/// joint by its grids has a free hinge to the ground, and a constraint at each grid. Parts are numbered in the order of
/// the hinges, in `partition` and `joints` too.
/// \param is_held  part 0 is held by the deck
/// \throws InputError split.loose-parts, split.held-grids, split.grounded
Assembly make_assembly(const Structure& structure, std::vector<Joint> joints, bool is_held, int root,
                       Partition& partition);

}  // namespace bough::analysis::splitting
