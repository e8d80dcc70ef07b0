#pragma once
/// \file Work-equivalent nodal forces of a traction on a surface element face.
#include <functional>
#include <vector>

#include <Eigen/Dense>

namespace bough::fe {

/// Traction per area at position x, of magnitude p, with unit normal n: a vector.
using Traction = std::function<Eigen::Vector3d(double p, const Eigen::Vector3d& x, const Eigen::Vector3d& n)>;

/// f_i = ∫ N_i t dA over a face of three or four corners (3 x m), its normal by the order of the corners.
/// corners: positions; midside[k]: position of the node on edge k -> k+1; `has_midside[k]` tells whether it is there
/// (both empty: none), eight each on a face of a cubic brick, two a side. p: intensity at the corners, interpolated
/// linearly between them. Columns: the corners, then the midside nodes present. The vector area n dA = x,r × x,s dr ds
/// of a warped face is integrated exactly.
Eigen::Matrix3Xd calc_face_load(const std::vector<Eigen::Vector3d>& corners,
                                const std::vector<Eigen::Vector3d>& midside, const std::vector<char>& has_midside,
                                const std::vector<double>& p, const Traction& traction);

/// -∂f/∂u of the pressure p n on the face as it follows its nodes u (3 m, node after node), same arguments. Over a
/// surface whose edge is held, or that has none, the skew parts of the faces cancel for a uniform pressure: the load
/// has a potential then (H. D. Hibbitt, "Some follower forces and load stiffness", IJNME 14 (1979) 937).
Eigen::MatrixXd calc_follower_stiffness(const std::vector<Eigen::Vector3d>& corners,
                                        const std::vector<Eigen::Vector3d>& midside,
                                        const std::vector<char>& has_midside, const std::vector<double>& p);

}  // namespace bough::fe
