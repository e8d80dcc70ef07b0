#pragma once
/// \file Convergence over three meshes of one body: observed orders and extrapolated values.
#include "modal/compare/bodies.hpp"

namespace bough::modal {

/// Mean length of the edges between successive corners of the elements of a body's mesh; 0 without elements.
double calc_element_size(const records::BodyMesh& mesh);

struct Convergence {
  int mode = 0;          ///< 1-based, of the finest body
  std::string quantity;  ///< "Hz", "lumped Γ0" ...
  std::array<double, 3> value{};
  double order = 0;         ///< NaN where the values do not tell: equal to ten digits, or no order fits
  double extrapolated = 0;  ///< from the two finest meshes with that order; NaN without one
};

/// Frequencies, and |Γ0|..|Γ4| of each method, of modes that all three have; element sizes h coarse to fine.
std::vector<Convergence> calc_convergence(const std::array<const records::FlexBody*, 3>& bodies,
                                          const std::array<double, 3>& h);

/// p with (a - b) / (b - c) = (h_a^p - h_b^p) / (h_b^p - h_c^p), 0.1 to 12; NaN when there is none.
double calc_observed_order(const std::array<double, 3>& value, const std::array<double, 3>& h);

}  // namespace bough::modal
