#include "report/deflection.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bough::report {

namespace {

constexpr Eigen::Index kBlock = 64;  // samples of one matrix product

}  // namespace

Deflection find_largest_deflection(const std::vector<Eigen::MatrixXd>& shapes, const Eigen::MatrixXd& eta) {
  Deflection largest;
  const Eigen::Index n = std::min<Eigen::Index>(eta.cols(), std::ssize(shapes));
  if (n == 0 || shapes.front().rows() == 0) return largest;
  const Eigen::Index num_points = shapes.front().rows();
  std::array<Eigen::MatrixXd, 3> phi;
  for (auto& component : phi) component.resize(num_points, n);
  Eigen::MatrixXd sizes(num_points, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto& shape = shapes[static_cast<std::size_t>(j)];
    for (int c = 0; c < 3; ++c) phi[static_cast<std::size_t>(c)].col(j) = shape.col(c);
    sizes.col(j) = shape.rowwise().norm();
  }
  const Eigen::VectorXd bounds = eta.leftCols(n).cwiseAbs() * sizes.colwise().maxCoeff().transpose();
  std::vector<Eigen::Index> order;
  Eigen::VectorXd ranges = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < eta.rows(); ++i) {
    if (!std::isfinite(bounds[i])) continue;
    order.push_back(i);
    ranges = ranges.cwiseMax(eta.row(i).head(n).cwiseAbs().transpose());
  }
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return bounds[a] > bounds[b]; });
  Eigen::VectorXd reaches = sizes * ranges;  // of each point that is left, at most

  // Points that cannot reach the largest value so far are dropped.
  const auto drop_points = [&] {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index k = 0; k < reaches.size(); ++k)
      if (reaches[k] > largest.size) kept.push_back(k);
    if (2 * std::ssize(kept) > reaches.size()) return;
    for (auto& component : phi) component = Eigen::MatrixXd(component(kept, Eigen::all));
    reaches = Eigen::VectorXd(reaches(kept));
  };
  const auto count = std::ssize(order);
  for (Eigen::Index from = 0; from < count; from += kBlock) {
    if (bounds[order[static_cast<std::size_t>(from)]] <= largest.size || reaches.size() == 0) break;
    const Eigen::Index size = std::min<Eigen::Index>(kBlock, count - from);
    Eigen::MatrixXd q(n, size);
    for (Eigen::Index k = 0; k < size; ++k)
      q.col(k) = eta.row(order[static_cast<std::size_t>(from + k)]).head(n).transpose();
    Eigen::ArrayXXd squares = Eigen::ArrayXXd::Zero(reaches.size(), size);
    for (const auto& component : phi) squares += (component * q).array().square();
    Eigen::Index point = 0, column = 0;
    if (const double value = std::sqrt(squares.maxCoeff(&point, &column)); value > largest.size) {
      largest = {value, order[static_cast<std::size_t>(from + column)]};
      drop_points();
    }
  }
  return largest;
}

}  // namespace bough::report
