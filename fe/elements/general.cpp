#include "fe/elements/general.hpp"

namespace bough::fe {

void General::add_stiffness(double scale, Eigen::Ref<MatrixXd> K) const {
  K += scale * B_.transpose() * k_.selfadjointView<Eigen::Lower>() * B_;
}

}  // namespace bough::fe
