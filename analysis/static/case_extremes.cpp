#include "analysis/static/case_extremes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/listing/stress_columns.hpp"

namespace bough::analysis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Largest pull, push and shear of a row; what is derived (von Mises) is none of them.
std::array<double, 3> find_stresses(const records::ElementStresses& block, Index row) {
  std::array<double, 3> worst{};
  for (std::size_t c = 0; c < block.components.size(); ++c) {
    const auto name = block.components[c].substr(0, block.components[c].find('@'));
    const double stress = block.stress(row, static_cast<Index>(c));
    if (name == "xx") worst = {std::max(worst[0], stress), std::min(worst[1], stress), worst[2]};
    if (name == "torsion") worst[2] = std::max(worst[2], std::abs(stress));
  }
  return worst;
}

/// A kind of result of one subcase, a row per grid or element.
struct Block {
  std::string path, dims;
  std::vector<std::string> components;
  std::vector<int> id;
  MatrixXd values;
};

/// Block of a quantity on grids with six dofs.
Block make_grid_block(const std::string& name, const std::string& dims, const Eigen::MatrixXi& dof_map,
                      const Eigen::VectorXd& values) {
  Block block{name, dims, {"x", "y", "z", "rx", "ry", "rz"}, {}, {}};
  std::vector<Index> first;
  for (Index i = 0; i < dof_map.rows(); ++i)
    if (dof_map(i, 1) == 1) first.push_back(i);
  block.values.resize(static_cast<Index>(first.size()), 6);
  for (std::size_t k = 0; k < first.size(); ++k) {
    block.id.push_back(dof_map(first[k], 0));
    block.values.row(static_cast<Index>(k)) = values.segment(first[k], 6).transpose();
  }
  return block;
}

std::vector<Block> list_blocks(const Eigen::MatrixXi& dof_map, const records::StaticSubcase& s) {
  std::vector<Block> blocks{make_grid_block("displacement", "L, 1", dof_map, s.displacement),
                            make_grid_block("reaction", "F, F L", dof_map, s.reaction)};
  for (const auto& b : s.elements) blocks.push_back({"elements/" + b.card, "F, F L", b.components, b.id, b.force});
  for (const auto& b : s.stresses) blocks.push_back({"stresses/" + b.card, "F/L^2, 1", b.components, b.id, b.stress});
  for (const auto& b : s.strains) blocks.push_back({"strains/" + b.card, "1, 1/L", b.components, b.id, b.stress});
  return blocks;
}

}  // namespace

std::vector<records::StressMargins> calc_margins(const records::Deck& deck, const records::StaticSubcase& subcase) {
  std::vector<records::StressMargins> result;
  const auto limits = list_stress_limits(deck);
  if (limits.empty()) return result;
  for (const auto& block : subcase.stresses) {
    records::StressMargins margins{block.card, {}, {}};
    std::vector<Index> rows;
    for (std::size_t r = 0; r < block.id.size(); ++r) {
      if (!limits.contains(block.id[r])) continue;
      margins.id.push_back(block.id[r]);
      rows.push_back(static_cast<Index>(r));
    }
    if (rows.empty()) continue;
    margins.margin.resize(static_cast<Index>(rows.size()), 3);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const auto& limit = limits.at(margins.id[r]);
      const auto worst = find_stresses(block, rows[r]);
      margins.margin.row(static_cast<Index>(r)) << calc_margin(worst[0], limit.tension),
          calc_margin(worst[1], limit.compression), calc_margin(worst[2], limit.shear);
    }
    result.push_back(std::move(margins));
  }
  return result;
}

void add_to_extremes(const Eigen::MatrixXi& dof_map, const records::StaticSubcase& subcase,
                     std::vector<records::CaseExtremes>& extremes) {
  for (const auto& block : list_blocks(dof_map, subcase)) {
    const auto at = std::find_if(extremes.begin(), extremes.end(), [&](const auto& e) { return e.path == block.path; });
    if (at == extremes.end()) {
      const Eigen::MatrixXi own = Eigen::MatrixXi::Constant(block.values.rows(), block.values.cols(), subcase.id);
      if (block.values.size() > 0)
        extremes.push_back({block.path, block.dims, block.components, block.id, block.values, block.values, own, own});
      continue;
    }
    BOUGH_DEMAND(at->id == block.id && at->components == block.components);
    for (Index i = 0; i < block.values.size(); ++i) {
      const double value = block.values(i);
      if (value < at->low(i)) at->low(i) = value, at->low_case(i) = subcase.id;
      if (value > at->high(i)) at->high(i) = value, at->high_case(i) = subcase.id;
    }
  }
}

}  // namespace bough::analysis
