#include "fe/elements/superelement.hpp"

namespace bough::fe {

void Superelement::add_structural_damping(double g, Eigen::Ref<MatrixXd> K) const {
  add(g, m_.K, K);
  add(1, m_.K4, K);
}

}  // namespace bough::fe
