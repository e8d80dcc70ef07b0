#pragma once
/// \file A 6 x 6 spring and damper between two frames A and B.
///
/// x = [p_AB; θ], position of B from A in the axes of A, R_AB = exp(θ̃) with |θ| < π: the rotation vector on the
/// branch of the shorter way. Energy ½ xᵀKx; the wrench on B, in A, is [f; T(θ)⁻ᵀ t] with [f; t] = -Kx - Cẋ, so that
/// its power is that of x. A gets the opposite at the same point. Beyond 172° the run ends
/// ("solver.bushing-past-half-turn").
#include "solver/forces/element.hpp"

namespace bough::solver {

class BushingElement final : public ForceElement {
 public:
  /// \param from  marker A. \param to  marker B. \param K  [6 x 6] stiffness in A, translations first. \param C  [6 x
  /// 6] damping.
  BushingElement(std::string name, SourceLocation at, int from, int to, const Matrix6d& K, const Matrix6d& C)
      : ForceElement(std::move(name)), at_(std::move(at)), from_(from), to_(to), K_(K), C_(C) {}

  ForceResult calc(const Tree& tree, const TreeData& data, Loads* loads) const override;
  std::vector<ForceChannel> channels() const override;

 private:
  SourceLocation at_;
  int from_, to_;
  Matrix6d K_, C_;
};

}  // namespace bough::solver
