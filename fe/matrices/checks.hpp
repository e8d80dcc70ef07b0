#pragma once
/// \file Checks of a model by `check` besides its matrices: grids, shapes of elements, springs to ground.
#include <array>
#include <string>
#include <vector>

#include "fe/model/model.hpp"

namespace bough::fe {

/// Sets of Nastran's GROUNDCHECK: g before any constraint, n after MPC and rigid elements, f after SPC too.
enum class GroundSet { Global, Independent, Free };

/// Strain energy of the six rigid-body motions of the independent dofs of a set, each divided by the largest that the
/// diagonal of K would allow: about 1e-16 without a ground. The f-set of a supported structure does strain: its
/// supports do not move.
Eigen::Matrix<double, 6, 1> calc_ground_check(const Model& model, GroundSet set);

/// Pairs of grids not further apart than `tolerance` (deck units), ids ascending. Springs and masses between coincident
/// grids are common: a hint, not an error. Of many in one place each is paired with ten others. O(n log n).
std::vector<std::array<int, 2>> find_coincident_grids(const Model& model, double tolerance);
/// 1e-6 of the diagonal of the box around the grids.
double choose_coincidence(const Model& model);

/// Ids of grids that no element, rigid element, MPC, orientation or coordinate system names.
std::vector<int> find_unused_grids(const Model& model, const records::Deck& deck);

/// Shape of a plane or solid element by its corners.
struct ElementQuality {
  double aspect = 1;    ///< longest edge over shortest
  double warp_deg = 0;  ///< quadrilateral: largest angle between a corner's normal and the mean one
  double jacobian = 1;  ///< smallest Jacobian at a corner over the largest; not positive: folded or inside out
};
/// type: "tri3", "quad4", "tetra4", "penta6" or "hexa8".
ElementQuality calc_quality(const std::string& type, const std::vector<Vector3d>& corners);

/// The worst of each measure among the elements of one card, with the element that has it.
struct WorstQuality {
  std::string card;
  int count = 0;
  ElementQuality worst;
  int aspect_id = 0, warp_id = 0, jacobian_id = 0;
};
/// Finds the worst aspect ratio, warp and Jacobian of the surface and solid elements of each card; curved shells by
/// their corners.
std::vector<WorstQuality> find_worst_quality(const Model& model);

}  // namespace bough::fe
