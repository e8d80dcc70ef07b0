#include "fe/linear/row_kinds.hpp"

#include <algorithm>
#include <array>

#include "base/diagnostic.hpp"

namespace bough::linear {

namespace {

using Eigen::VectorXd;

constexpr std::size_t num_kinds = 3;

std::size_t get_kind(const RowKinds& kinds, Eigen::Index row) {
  return kinds.empty() ? 0 : static_cast<std::size_t>(kinds[static_cast<std::size_t>(row)]);
}

/// The largest entry of each kind, zero if there is none.
std::array<double, num_kinds> find_largest(const VectorXd& D, const RowKinds& kinds) {
  BOUGH_DEMAND(kinds.empty() || static_cast<Eigen::Index>(kinds.size()) == D.size());
  std::array<double, num_kinds> largest{};
  for (Eigen::Index i = 0; i < D.size(); ++i) {
    double& maximum = largest[get_kind(kinds, i)];
    maximum = std::max(maximum, D(i));
  }
  return largest;
}

}  // namespace

VectorXd fill_diagonal(VectorXd D, const RowKinds& kinds) {
  D = D.cwiseAbs().eval();
  const auto largest = find_largest(D, kinds);
  const double any = *std::max_element(largest.begin(), largest.end());
  for (Eigen::Index i = 0; i < D.size(); ++i) {
    const double maximum = largest[get_kind(kinds, i)];
    if (D(i) <= 1e-14 * maximum) D(i) = maximum > 0 ? maximum : any > 0 ? any : 1;
  }
  return D;
}

VectorXd raise_diagonal(VectorXd D, const RowKinds& kinds, double share) {
  const auto largest = find_largest(D, kinds);
  for (Eigen::Index i = 0; i < D.size(); ++i) D(i) = std::max(D(i), share * largest[get_kind(kinds, i)]);
  return D;
}

}  // namespace bough::linear
