#pragma once
/// \file Element forces of Bough in Nastran's columns and signs.
#include <functional>
#include <map>
#include <optional>

#include "fe/model/model.hpp"
#include "formats/records/listing.hpp"
#include "formats/records/static_result.hpp"

namespace bough::analysis {

/// Resultants by CBEAM of the loads along it, forces x y z and moment x in its axes.
using BeamLoads = std::map<int, Eigen::Vector4d>;

/// Elements of a model by their card and id.
using ElementIndex = std::map<std::pair<std::string, int>, const fe::Element*>;
/// Indexes all elements of the model; the pointers are valid as long as the model.
ElementIndex index_elements(const fe::Model& model);

/// The elements of `forces` that `is_wanted` names; none where Nastran's table of that card is not written.
/// CBAR, CWELD: M1 M2 of end A, of end B, V1 V2, axial, torque, with M1 = Mz, M2 = -My of the section at x. Shells: the
/// mean over the element, as that of the stresses, moments with Nastran's sign, -∫σ z dz, in Nastran's element axes.
std::optional<records::ListedElements> make_listed_forces(const fe::Model& model, const ElementIndex& elements,
                                                          const records::ElementForces& forces, const BeamLoads& loads,
                                                          const std::function<bool(int)>& is_wanted);

/// Angle from side 1-2 to the x axis of Nastran's CQUAD4, which bisects the diagonals 1-3 and 4-2.
double calc_quad_angle(const std::array<Eigen::Vector3d, 4>& x);

/// Components xx yy xy in axes turned by `angle`.
Eigen::Vector3d turn_plane(const Eigen::Vector3d& s, double angle);

}  // namespace bough::analysis
