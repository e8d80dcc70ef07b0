#include "fe/model/model_size.hpp"

#include <Eigen/Geometry>

namespace bough::fe {

double calc_model_size(const Model& model) {
  Eigen::AlignedBox3d box;
  for (const auto& node : model.nodes())
    if (node.num_dofs == 6) box.extend(node.x);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

}  // namespace bough::fe
