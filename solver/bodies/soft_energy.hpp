#pragma once
/// \file Strain energy of the soft modes of a body of second order to degree 4: what such a body leaves out
/// (docs/theory/third-order.md, "Next order").
#include "solver/bodies/node.hpp"

namespace bough::solver {

class SoftEnergy {
 public:
  /// next: with modes of the body.
  explicit SoftEnergy(const records::NextOrder& next);

  /// Estimated error of the deflection φη of a node in a static state, relative to it: the way to the state that the
  /// same load has with V_3 and V_4. 0: no such state is found. K: modal stiffness. No allocation.
  double calc_error(const Node& node, const MatrixXd& K, const ConstVectorRef& eta) const;

  /// Modes whose energy is known, ascending.
  const std::vector<int>& modes() const { return modes_; }
  /// V_4 [F L] of mode modes()[i] at unit amplitude. No allocation.
  double calc_quartic(std::size_t i) const;

 private:
  std::vector<int> modes_;
  Polynomials energy_;  ///< V_3, V_4
};

}  // namespace bough::solver
