#pragma once
/// \file GENEL: a stiffness given on any degrees of freedom. Source: Nastran Quick Reference Guide, GENEL; MSC.Nastran
/// Linear Static Analysis User's Guide, "general element".
#include "fe/elements/element.hpp"

namespace bough::fe {

/// K = Bᵀ k B with the deformations B u = u_i - S u_d of its components u_i beyond the rigid-body motion of u_d.
class General final : public Element {
 public:
  /// k: m x m symmetric; B: m x N in basic axes.
  General(int id, std::vector<int> nodes, std::vector<int> gdofs, MatrixXd k, MatrixXd B)
      : Element(id, "GENEL", std::move(nodes), std::move(gdofs)), k_(std::move(k)), B_(std::move(B)) {}

  void add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const override;

 private:
  MatrixXd k_, B_;
};

}  // namespace bough::fe
