#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "cli/common/console.hpp"
#include "cli/modes/modes_tables.hpp"

namespace bough::cli {
namespace {

using Eigen::VectorXd;

constexpr std::size_t kMaxElements = 5;

std::string show_share(double part, double whole) {
  return fmt::format("{:.2f}", whole > 0 ? 100 * part / whole : 0.0);
}

/// A row a property: per mode its share of strain and kinetic energy.
std::string format_properties(const records::ModesResult& r) {
  const auto& e = r.energies;
  std::map<int, std::pair<VectorXd, VectorXd>> sums;
  for (std::size_t i = 0; i < e.id.size(); ++i) {
    auto& [strain, kinetic] =
        sums.try_emplace(e.property[i], VectorXd::Zero(e.strain.cols()), VectorXd::Zero(e.strain.cols())).first->second;
    strain += e.strain.row(static_cast<Eigen::Index>(i)).transpose();
    kinetic += e.kinetic.row(static_cast<Eigen::Index>(i)).transpose();
  }
  Table table{{"mode", "property", "strain energy", "%", "kinetic energy", "%"}, {}};
  for (Eigen::Index j = 0; j < e.strain.cols(); ++j) {
    const double omega2 = std::max(0.0, r.eigenvalue[j]);
    for (const auto& [property, sum] : sums)
      table.rows.push_back({std::to_string(j + 1), property > 0 ? std::to_string(property) : "-",
                            fmt::format("{:.6e}", sum.first[j]), show_share(sum.first[j], e.total_strain[j]),
                            fmt::format("{:.6e}", omega2 * sum.second[j]),
                            show_share(sum.second[j], e.total_kinetic[j])});
  }
  return table.to_text();
}

std::string format_elements(const records::ModesResult& r) {
  const auto& e = r.energies;
  Table table{{"mode", "element", "strain energy %", "", "element", "kinetic energy %"}, {}};
  const auto sort = [&](const Eigen::MatrixXd& values, Eigen::Index j) {
    std::vector<Eigen::Index> order(e.id.size());
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return values(a, j) > values(b, j); });
    return order;
  };
  const auto name = [&](Eigen::Index i) {
    return fmt::format("{} {}", e.card[static_cast<std::size_t>(i)], e.id[static_cast<std::size_t>(i)]);
  };
  for (Eigen::Index j = 0; j < e.strain.cols(); ++j) {
    const auto strain = sort(e.strain, j), kinetic = sort(e.kinetic, j);
    for (std::size_t k = 0; k < std::min(kMaxElements, e.id.size()); ++k)
      table.rows.push_back({std::to_string(j + 1), name(strain[k]),
                            show_share(e.strain(strain[k], j), e.total_strain[j]), "", name(kinetic[k]),
                            show_share(e.kinetic(kinetic[k], j), e.total_kinetic[j])});
  }
  return table.to_text();
}

}  // namespace

std::string format_energies(const records::ModesResult& r) {
  if (r.energies.empty()) return {};
  return "\nenergies of properties (kinetic: omega^2 / 2 phi M phi), %\n" + format_properties(r) +
         fmt::format("\nthe {} elements with most of each\n", std::min(kMaxElements, r.energies.id.size())) +
         format_elements(r);
}

std::string format_effective_mass_about(const records::ModesResult& r) {
  const auto& about = r.effective_mass_about;
  if (about.grid == 0) return {};
  Table table{{"mode", "x", "y", "z", "rx", "ry", "rz"}, {}};
  const auto add = [&](const std::string& name, const auto& values) {
    std::vector<std::string> row{name};
    for (int c = 0; c < 6; ++c) row.push_back(fmt::format("{:.6e}", values(c)));
    table.rows.push_back(std::move(row));
  };
  for (Eigen::Index j = 0; j < about.mass.rows(); ++j) add(std::to_string(j + 1), about.mass.row(j));
  add("sum", Eigen::RowVectorXd(about.mass.colwise().sum()));
  add("whole", Eigen::Matrix<double, 6, 1>(about.rigid.diagonal()));
  return fmt::format("\neffective mass about grid {}\n", about.grid) + table.to_text();
}

}  // namespace bough::cli
