#pragma once
/// \file Inertial loads F_I of an accelerated frame, and with them GRAV and RFORCE.
#include <functional>
#include <vector>

#include "fe/elements/carried.hpp"
#include "fe/loads/loads.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/model/model.hpp"

namespace bough::fe {

/// The field a_o + A x of acceleration of places, by the twelve load factors A_I in the order of records::InertialLoad:
/// A = α̃ + ω̃ω̃ (docs/theory/carried-bodies.md).
struct AccelerationField {
  Vector3d a_o = Vector3d::Zero();
  Matrix3d A = Matrix3d::Zero();
};
/// Computes a_o and A of the load factors [12]; ω̃ω̃ = ωωᵀ - |ω|² 1 from the six products.
AccelerationField calc_acceleration_field(const Vector12d& A_I);
/// A_I of a_o, α and ω.
Vector12d calc_load_factors(const Vector3d& a_o, const Vector3d& alpha, const Vector3d& omega);

/// X -> M X on the g-set.
using MassProduct = std::function<MatrixXd(const MatrixXd&)>;

/// F_I A_I, num_gdofs x k, for load factors A_I (12 x k): -M Φ_R for accelerations; for spin what every piece of mass
/// feels where it is. Masses that are not of bodies take their nodal momenta instead (docs/theory/carried-bodies.md);
/// has_approximate_mass() tells. Replicated; O(elements).
MatrixXd calc_inertial_loads(const Model& model, MassKind kind, const MatrixXd& A_I, const MassProduct& mass_times);
MatrixXd calc_inertial_loads(const Model& model, MassKind kind, const MatrixXd& A_I);
/// F_I itself, num_gdofs x 12.
MatrixXd calc_inertial_loads(const Model& model, MassKind kind);

/// The part of calc_inertial_loads() of these superelements, num_gdofs x k.
MatrixXd calc_superelement_loads(const Model& model, MassKind kind, const MatrixXd& A_I,
                                 const std::vector<const Element*>& superelements);

/// Returns true if the mass of an element is off its grids and not that of bodies.
bool has_approximate_mass(const Model& model, MassKind kind);

/// Adds the bodies of an element with OffsetMass, masses times WTMASS, as far as carried.detail requests. \return false
/// if its mass is not that of bodies.
bool calc_carried(const Model& model, const Element& element, MassKind kind, CarriedMass& carried);

/// The part of M on the g-set that moves as the translations of the grids do, and what is not known to do otherwise:
/// all but what calc_carried() tells of.
linear::SymmetricMatrix assemble_grid_mass(const Model& model, MassKind kind);

/// Σ μ_rs z_r z_sᵀ over the points of all carried masses, z = [1 or 0 for an arm, x, u] with u the motions of the point
/// in Phi (num_gdofs x n), x of every column first: 4 + 3n square. Summed over ranks.
MatrixXd calc_carried_gram(const Model& model, MassKind kind, const MatrixXd& Phi);

/// k fields at once, those of the columns of A_I (12 x k).
class AccelerationFields {
 public:
  explicit AccelerationFields(const std::vector<AccelerationField>& fields);
  explicit AccelerationFields(const MatrixXd& A_I);
  /// Forces -Σ_s μ_rs a_s on the points of a carried mass along x, then y, then z: 3 points x k.
  MatrixXd calc_point_loads(const CarriedMass& carried) const;

 private:
  Eigen::Index num_;
  MatrixXd of_place_;  ///< 4 x 3k: a = [1 or 0 for an arm, x] · its column, along x of every load first
};

/// H of all points, rows as those of the forces: 3 points x N.
MatrixXd stack_motions(const CarriedMass& carried);

}  // namespace bough::fe
