#include "modal/compare/refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bough::modal {

using Eigen::Index;
using records::FlexBody;

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Corners come first in every element type.
Index count_corners(const std::string& type, Index nodes) {
  static const std::vector<std::pair<std::string, Index>> table{{"line", 2},    {"tri", 3},   {"quad", 4}, {"tetra", 4},
                                                                {"pyramid", 5}, {"penta", 6}, {"hexa", 8}};
  for (const auto& [name, count] : table)
    if (type.rfind(name, 0) == 0) return std::min(count, nodes);
  return 0;
}

Convergence make(int mode, std::string quantity, const std::array<double, 3>& value, const std::array<double, 3>& h) {
  Convergence c{mode, std::move(quantity), value, calc_observed_order(value, h), kNothing};
  if (!std::isnan(c.order)) c.extrapolated = value[2] + (value[2] - value[1]) / (std::pow(h[1] / h[2], c.order) - 1);
  return c;
}

}  // namespace

double calc_element_size(const records::BodyMesh& mesh) {
  double sum = 0;
  long count = 0;
  for (const auto& block : mesh.blocks) {
    const Index corners = count_corners(block.type, block.connectivity.cols());
    for (Index e = 0; e < block.connectivity.rows(); ++e)
      for (Index k = 0; k + 1 < corners; ++k) {
        const int i = block.connectivity(e, k), j = block.connectivity(e, k + 1);
        if (i < 0 || j < 0) continue;
        sum += (mesh.grid_xyz.row(i) - mesh.grid_xyz.row(j)).norm();
        ++count;
      }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

double calc_observed_order(const std::array<double, 3>& value, const std::array<double, 3>& h) {
  constexpr double kEqual = 1e-10, kMinOrder = 0.1, kMaxOrder = 12;
  const double first = value[0] - value[1], second = value[1] - value[2];
  const double size = std::max({std::abs(value[0]), std::abs(value[1]), std::abs(value[2])});
  if (!(std::abs(second) > kEqual * size) || !(std::abs(first) > kEqual * size)) return kNothing;
  const auto excess = [&](double p) {
    return (std::pow(h[0] / h[2], p) - std::pow(h[1] / h[2], p)) / (std::pow(h[1] / h[2], p) - 1) - first / second;
  };
  double low = kMinOrder, high = kMaxOrder;
  if (!(excess(low) < 0) || !(excess(high) > 0)) return kNothing;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::vector<Convergence> calc_convergence(const std::array<const FlexBody*, 3>& bodies,
                                          const std::array<double, 3>& h) {
  // The coarser bodies' modes in the order of the finest's; only those that all have.
  const FlexBody& fine = *bodies[2];
  const auto model = ModalModel::from(fine);
  std::array<std::vector<ModePair>, 2> pairs;
  std::array<Vector3d, 2> offset;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto other = ModalModel::from(*bodies[i]);
    const auto match = match_nodes(model, other);
    offset[i] = match.offset;
    pairs[i] = pair_modes(model, other, match, calc_mac(model, other, match));
  }
  const auto has = [](const std::vector<ModePair>& list, int a) {
    return std::any_of(list.begin(), list.end(), [a](const ModePair& p) { return p.a == a; });
  };
  for (std::size_t i = 0; i < 2; ++i)
    pairs[i].erase(
        std::remove_if(pairs[i].begin(), pairs[i].end(), [&](const ModePair& p) { return !has(pairs[1 - i], p.a); }),
        pairs[i].end());
  const std::array<FlexBody, 3> aligned{align_body(fine, *bodies[0], pairs[0], offset[0]),
                                        align_body(fine, *bodies[1], pairs[1], offset[1]), keep_paired(fine, pairs[0])};
  std::array<std::array<MatrixXd, 3>, kNumMethods> norm;
  const MatrixXd scale = calc_integral_scale(aligned[2]);
  for (int m = 0; m < kNumMethods; ++m)
    for (std::size_t i = 0; i < 3; ++i)
      if (const auto& set = get_method(aligned[i], m); !set.empty())
        norm[static_cast<std::size_t>(m)][i] = calc_integral_norms(set);

  std::vector<Convergence> rows;
  for (std::size_t j = 0; j < pairs[0].size(); ++j) {
    const int mode = pairs[0][j].a + 1;
    const auto at = static_cast<Index>(j);
    rows.push_back(
        make(mode, "Hz", {aligned[0].frequency_hz[at], aligned[1].frequency_hz[at], aligned[2].frequency_hz[at]}, h));
    for (std::size_t m = 0; m < kNumMethods; ++m) {
      const auto& of = norm[m];
      if (of[0].size() == 0 || of[1].size() == 0 || of[2].size() == 0) continue;
      for (int k = 0; k < kNumIntegrals; ++k) {
        if (of[2](at, k) < 1e-9 * scale(at, k)) continue;  // vanishes
        if (m == 2 && k == 3 && !(can_move_gamma3(offset[0]) && can_move_gamma3(offset[1]))) continue;
        rows.push_back(make(mode, std::string(kMethodNames[m]) + " Γ" + std::to_string(k),
                            {of[0](at, k), of[1](at, k), of[2](at, k)}, h));
      }
    }
  }
  return rows;
}

}  // namespace bough::modal
