#pragma once
/// \file Mass integrals and geometric stiffness of two bodies on their paired modes.
#include "modal/compare/integrals_check.hpp"
#include "modal/compare/shapes.hpp"

namespace bough::modal {

/// b's modes that have a partner, in the order, with the sign and the modal mass of a's, about a's origin: place of a +
/// offset = place of b. Other modes are left out; `pairs` and `a` say which.
records::FlexBody align_body(const records::FlexBody& a, const records::FlexBody& b, const std::vector<ModePair>& pairs,
                             const Vector3d& offset);
/// Returns true if Γ3 of the exact set holds after align_body: with another origin it takes the momentum of the
/// translation dofs alone, which a body does not keep.
bool can_move_gamma3(const Vector3d& offset);
/// a's modes that have a partner.
records::FlexBody keep_paired(const records::FlexBody& a, const std::vector<ModePair>& pairs);

/// |K_a - K_b| / max(|K_a|, |K_b|), Frobenius.
struct StiffnessDifference {
  std::string load;
  double norm_a = 0, norm_b = 0, difference = 0;  ///< difference NaN where both are zero
};

struct BodyComparison {
  std::array<bool, kNumMethods> has{};               ///< both bodies have the set
  std::array<MatrixXd, kNumMethods> difference;      ///< pairs x 5 (calc_integral_differences)
  std::array<MatrixXd, kNumMethods> norm_a, norm_b;  ///< pairs x 5
  std::vector<StiffnessDifference> stiffness;        ///< inertial loads that both have, then locators of one name
  /// Strain energy of degrees 3 to 6 in amplitudes of 1/ω, where both bodies have third order in the same modes.
  std::vector<StiffnessDifference> energy;
  std::string energy_note;  ///< why a body of third order has no rows in `energy`; empty: it has, or none is of it
};
/// Compares a and b on the paired modes, b in the origin, signs and modal masses of a; loads that need a common origin
/// are left out for another one.
BodyComparison compare_bodies(const records::FlexBody& a, const records::FlexBody& b,
                              const std::vector<ModePair>& pairs, const Vector3d& offset);

}  // namespace bough::modal
