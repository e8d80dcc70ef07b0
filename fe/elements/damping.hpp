#pragma once
/// \file Viscous damping of an element.
#include <Eigen/Dense>

namespace bough::fe {

class Damping {
 public:
  /// B += scale B_e, N x N. Symmetric; B_e times any rigid-body motion is zero for an ungrounded element.
  virtual void add_damping(double scale, Eigen::Ref<Eigen::MatrixXd> B) const = 0;

 protected:
  ~Damping() = default;
};

}  // namespace bough::fe
