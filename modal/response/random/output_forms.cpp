#include "modal/response/random/output_forms.hpp"

#include <algorithm>
#include <cmath>

namespace bough::modal::response {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Names = std::vector<std::string>;

/// σ_v² = |F σ|²; no rows where the components have no von Mises stress.
MatrixXd make_von_mises(const Names& kinds) {
  const double root3 = std::sqrt(3.0);
  if (kinds == Names{"xx", "torsion"}) return Eigen::Vector2d(1, root3).asDiagonal();
  MatrixXd F;
  if (kinds == Names{"xx", "yy", "xy"}) {
    F.setZero(3, 3);
    F << 1, -0.5, 0, 0, root3 / 2, 0, 0, 0, root3;
  } else if (kinds == Names{"xx", "yy", "zz", "xy", "yz", "zx"}) {
    F.setZero(6, 6);
    for (int i = 0; i < 3; ++i) {
      F(i, i) = std::sqrt(0.5);
      F(i, (i + 1) % 3) = -std::sqrt(0.5);
      F(i + 3, i + 3) = root3;
    }
  }
  return F;
}

}  // namespace

std::vector<OutputForm> list_output_forms(const Names& components, bool of_stress) {
  std::vector<OutputForm> forms;
  const auto num = static_cast<Index>(components.size());
  Names kinds;  // of the point so far
  for (std::size_t i = 0; i < components.size(); ++i) {
    MatrixXd F = MatrixXd::Zero(1, num);
    F(0, static_cast<Index>(i)) = 1;
    forms.push_back({components[i], std::move(F)});
    if (!of_stress) continue;
    const auto get_point = [](const std::string& name) { return name.substr(std::min(name.find('@'), name.size())); };
    const auto point = get_point(components[i]);
    kinds.push_back(components[i].substr(0, components[i].size() - point.size()));
    const bool is_last = i + 1 == components.size() || get_point(components[i + 1]) != point;
    if (!is_last) continue;
    const MatrixXd of_point = make_von_mises(kinds);
    if (of_point.rows() > 0) {
      MatrixXd all = MatrixXd::Zero(of_point.rows(), num);
      all.middleCols(static_cast<Index>(i + 1 - kinds.size()), of_point.cols()) = of_point;
      forms.push_back({"von_mises" + point, std::move(all)});
    }
    kinds.clear();
  }
  return forms;
}

}  // namespace bough::modal::response
