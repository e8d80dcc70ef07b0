#include "fe/elements/superelement.hpp"

namespace bough::fe {

void Superelement::add_structural_damping(double g, Eigen::Ref<MatrixXd> K) const {
  add(g, m_.K, K);
  add(1, m_.K4, K);
}

std::vector<std::string> Superelement::internal_force_names() const {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= m_.K_G.size(); ++i) names.push_back("f" + std::to_string(i));
  return names;
}

}  // namespace bough::fe
