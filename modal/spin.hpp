#pragma once
/// \file Frequencies of a flexible body in a frame that spins steadily about an axis through Bo.
#include <vector>

#include "formats/records/flex_body.hpp"

namespace bough::modal {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct SpinFrequencies {
  VectorXd rate;               ///< r rates, rad per unit of time, from 0
  MatrixXd frequency_hz;       ///< r x k, in the spinning frame, ascending; with geometric stiffness
  MatrixXd without_hz;         ///< the same without it
  std::vector<bool> diverges;  ///< r: a motion without stiffening against it grows there; its frequency is 0
  bool has_stiffness = false;  ///< K_G1 of this axis was computed
  int num_modes = 0;           ///< of the lowest modes that took part
};

/// M η̈ + 2Ω G η̇ + (K + Ω² (K_G - S)) η = 0 about η = 0, with axis a (unit, in B): G_jk = a·Γ2_kj, S_jk = aᵀ Γ4_jk a,
/// K_G = Σ a_r a_s K_G1(ωrωs) (docs/theory/flexible-body.md §3, §4). The shapes are first brought to the lowest
/// `most_modes` modes of K and M. What the spin bends statically is not in it: a straight body along a radius is.
SpinFrequencies calc_spin_frequencies(const records::FlexBody& body, const Vector3d& axis, const VectorXd& rates,
                                      int most_modes = 16);

}  // namespace bough::modal
