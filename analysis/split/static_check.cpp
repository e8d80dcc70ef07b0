#include "analysis/split/static_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fe/loads/loads.hpp"
#include "fe/matrices/system.hpp"
#include "fe/statics/statics.hpp"

namespace bough::analysis::splitting {

namespace {

using Eigen::Index;

constexpr int kFree = 6;  ///< rigid-body modes of a structure that nothing holds

struct StaticLoads {
  std::vector<std::string> names;
  std::vector<bool> is_unit;  ///< unit loads share one size of deflection
  MatrixXd F;                 ///< num_gdofs x m
};

void add_load(const std::string& name, bool is_unit, const Eigen::VectorXd& F, StaticLoads& loads) {
  loads.names.push_back(name);
  loads.is_unit.push_back(is_unit);
  loads.F.conservativeResize(F.size(), loads.F.cols() + 1);
  loads.F.rightCols<1>() = F;
}

/// Grid of the first joint; 0 without one.
int find_cut_grid(const Assembly& assembly) {
  return assembly.joints.empty() ? 0 : assembly.joints.front().grids.front();
}

StaticLoads list_loads(const fe::Model& model, const Structure& structure, const Assembly& assembly, bool is_free,
                       Diagnostics& diagnostics) {
  StaticLoads loads;
  const int load = model.subcase().load;
  if (!is_free) {
    const MatrixXd Phi_R = model.calc_rigid_modes().leftCols<3>();
    const MatrixXd F = fe::calc_mass_times(model, model.mass_kind(), Phi_R);
    for (Index c = 0; c < 3; ++c) add_load(fmt::format("unit acceleration along {}", "xyz"[c]), true, F.col(c), loads);
  } else if (load == 0) {
    const int grid = find_cut_grid(assembly), index = model.find_node(grid);
    for (Index c = 0; c < 3 && index >= 0; ++c)
      add_load(fmt::format("unit force along {} at grid {}", "xyz"[c], grid), true,
               Eigen::VectorXd::Unit(model.num_gdofs(), model.node(index).first_gdof + c), loads);
  }
  if (load != 0) {
    const Eigen::VectorXd F = fe::calc_load(model, structure.deck, load, diagnostics);
    if (F.size() == model.num_gdofs()) add_load(fmt::format("LOAD {}", load), false, F, loads);
  }
  return loads;
}

/// Largest translation of a grid of an element, by load.
Eigen::VectorXd calc_largest(const fe::Model& model, const Structure& structure, const MatrixXd& u) {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(u.cols());
  for (const auto& node : model.nodes())
    if (node.num_dofs == 6 && structure.joined.count(node.id) > 0)
      largest = largest.cwiseMax(u.middleRows<3>(node.first_gdof).colwise().norm().transpose());
  return largest;
}

}  // namespace

std::vector<ComparedDeflection> compare_deflections(const fe::Model& model, const Structure& structure,
                                                    const Partition& partition, const Assembly& assembly,
                                                    const std::vector<const records::FlexBody*>& bodies,
                                                    const MatrixXd& rigid, double lambda, Diagnostics& diagnostics) {
  const bool is_free = rigid.cols() == kFree;
  if (rigid.cols() != 0 && !is_free) return {};
  auto loads = list_loads(model, structure, assembly, is_free, diagnostics);
  if (loads.names.empty()) return {};
  const MatrixXd M_rigid = is_free ? fe::calc_mass_times(model, model.mass_kind(), rigid) : MatrixXd(rigid);
  if (is_free) loads.F -= M_rigid * (rigid.transpose() * loads.F).eval();
  const auto held = is_free ? fe::choose_determinate_support(model, 0) : std::vector<int>{};
  MatrixXd u = fe::StaticSolver(model, fe::get_stiffness(model), held).solve(loads.F, &diagnostics);
  MatrixXd u_parts = calc_assembled_deflections(bodies, structure, assembly, lambda, model, partition, loads.F);
  if (is_free)
    for (auto* displacement : {&u, &u_parts}) *displacement -= rigid * (M_rigid.transpose() * *displacement).eval();
  const auto largest = calc_largest(model, structure, u);
  const auto difference = calc_largest(model, structure, u - u_parts);
  double largest_unit = 0;
  for (Index i = 0; i < largest.size(); ++i)
    if (loads.is_unit[static_cast<std::size_t>(i)]) largest_unit = std::max(largest_unit, largest(i));
  std::vector<ComparedDeflection> compared;
  for (Index i = 0; i < largest.size(); ++i) {
    const auto index = static_cast<std::size_t>(i);
    const double size = loads.is_unit[index] ? largest_unit : largest(i);
    if (size > 0) compared.push_back({loads.names[index], largest(i), difference(i) / size});
  }
  return compared;
}

}  // namespace bough::analysis::splitting
