#include "fe/elements/viscous.hpp"

namespace bough::fe {

Viscous::Viscous(int id, std::vector<int> nodes, std::vector<int> gdofs, double ce, double cr, const Vector3d& axis)
    : Element(id, "CVISC", std::move(nodes), std::move(gdofs)), ce_(ce), cr_(cr), axis_(axis) {
  BOUGH_DEMAND(num_dofs() == 12);
}

void Viscous::add_damping(double scale, Eigen::Ref<MatrixXd> B) const {
  const Matrix3d along = axis_ * axis_.transpose();
  for (const int part : {0, 3}) {
    const Matrix3d block = scale * (part == 0 ? ce_ : cr_) * along;
    B.block<3, 3>(part, part) += block;
    B.block<3, 3>(part + 6, part + 6) += block;
    B.block<3, 3>(part, part + 6) -= block;
    B.block<3, 3>(part + 6, part) -= block;
  }
}

}  // namespace bough::fe
