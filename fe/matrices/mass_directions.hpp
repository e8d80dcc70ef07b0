#pragma once
/// \file Check that the mass of a model is that of a rigid body: scalar masses and given matrices need not be.
#include "fe/model/model.hpp"

namespace bough::fe {

/// Distance of Φ_Rᵀ M Φ_R (6 x 6; x y z, rotations) from the mass matrix of a rigid body, m 1 on translations and m s̃
/// between them and rotations: the largest difference relative to its translational and rotational parts; round-off for
/// a body.
double calc_mass_difference(const Eigen::Matrix<double, 6, 6>& rigid_mass);

/// Beyond this difference the mass is not one number.
inline constexpr double kMassDifference = 1e-6;

/// Describes the mass along its principal axes, as the grid point weight generator of Nastran prints three, and which
/// elements make it so: "the mass is 4 along x, 10 along y, 4 along z (CMASS2 9)"; `at`: the first such card.
std::string describe_mass(const Model& model, const records::Deck& deck, const Eigen::Matrix<double, 6, 6>& rigid_mass,
                          SourceLocation& at);

/// fe.mass-by-direction (warning) where the mass is no body's.
void report_mass(const Model& model, const records::Deck& deck, const records::MassProperties& properties,
                 Diagnostics& diagnostics);

}  // namespace bough::fe
