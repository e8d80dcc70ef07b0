#include "solver/statespace/track.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/diagnostic.hpp"
#include "solver/statespace/blocks.hpp"

namespace bough::statespace {

using Eigen::Index;
using Eigen::MatrixXd;

EigenSystem calc_eigen_system(const MatrixXd& A) {
  if (A.rows() == 0) return {};
  MatrixXd a = A;
  const Eigen::VectorXd scale = balance(a);
  const Eigen::EigenSolver<MatrixXd> solver(a);
  if (!a.allFinite() || solver.info() != Eigen::Success)
    throw ComputationError("linear.no-poles", {}, "the eigenvalues of A were not found", "look at A for huge entries");
  EigenSystem s;
  s.value = solver.eigenvalues();
  const Eigen::MatrixXcd right = solver.eigenvectors();
  // Least norm where several eigenvectors are one.
  s.left = right.completeOrthogonalDecomposition().pseudoInverse() * scale.cwiseInverse().asDiagonal();
  s.right = scale.asDiagonal() * right;
  return s;
}

std::vector<int> follow(const EigenSystem& before, const EigenSystem& next, Eigen::VectorXd& correlation) {
  const Index n = before.value.size(), m = next.value.size();
  Eigen::MatrixXd both = (before.left * next.right).cwiseProduct((next.left * before.right).transpose()).cwiseAbs();
  correlation.setZero(n);
  if (n == 0 || m == 0) return std::vector<int>(static_cast<std::size_t>(n), -1);
  const double size = std::max(1e-300, std::max(before.value.cwiseAbs().maxCoeff(), next.value.cwiseAbs().maxCoeff()));
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < m; ++j) {
      // A vector of displacements and rates is another one at another frequency: the shape is what counts.
      const double a = std::abs(before.value[i]), b = std::abs(next.value[j]);
      if (std::max(a, b) > 1e-9 * size) both(i, j) *= 4 * a * b / ((a + b) * (a + b));
    }
  }
  both = both.cwiseMin(1.0);
  struct Pair {
    double score;
    int from, to;
  };
  std::vector<Pair> pairs;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j)
      pairs.push_back({both(i, j) - 1e-2 * std::abs(before.value[i] - next.value[j]) / size, i, j});
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.score > b.score; });
  std::vector<int> order(static_cast<std::size_t>(n), -1);
  std::vector<bool> is_taken(static_cast<std::size_t>(m), false);
  for (const auto& pair : pairs) {
    if (order[static_cast<std::size_t>(pair.from)] >= 0 || is_taken[static_cast<std::size_t>(pair.to)]) continue;
    order[static_cast<std::size_t>(pair.from)] = pair.to;
    is_taken[static_cast<std::size_t>(pair.to)] = true;
    correlation[pair.from] = both(pair.from, pair.to);
  }
  return order;
}

namespace {

/// First rows of C of outputs with components x, y, z that are lengths.
std::vector<Index> list_positions(const records::LinearModel& model) {
  std::vector<Index> rows;
  const auto& names = model.outputs.name;
  for (std::size_t i = 0; i + 2 < names.size(); ++i) {
    const auto colon = names[i].rfind(':');
    const std::string name = names[i].substr(0, colon);
    if (colon == std::string::npos || names[i] != name + ":x" || names[i + 1] != name + ":y" ||
        names[i + 2] != name + ":z" || model.outputs.dims[i] != "L")
      continue;
    rows.push_back(static_cast<Index>(i));
  }
  return rows;
}

/// Square of an orbit that is round-off, over that of the largest displacement that the coordinates of a shape can
/// give.
constexpr double kNoOrbit = 1e-12;

/// Largest square of a coordinate of the shape, times that of a displacement by a unit of a coordinate. Rates are left
/// out.
double calc_scale(const records::LinearModel& model, const std::vector<Index>& rows, const Eigen::VectorXcd& shape) {
  double coordinate = 0, displacement = 0;
  for (Index k = 0; k < shape.size(); ++k) {
    if (const auto i = static_cast<std::size_t>(k);
        i < model.states.dims.size() && model.states.dims[i].ends_with("/T"))
      continue;
    coordinate = std::max(coordinate, std::norm(shape[k]));
    for (const Index row : rows) displacement = std::max(displacement, model.C.col(k).segment<3>(row).squaredNorm());
  }
  return coordinate * displacement;
}

/// Twice the area of the orbit, positive in the direction of the spin, over the sum of the squares of its half axes; 0
/// if every orbit is round-off: axial motion and torsion.
double calc_whirl(const records::LinearModel& model, const std::vector<Index>& rows, const Eigen::Vector3d& axis,
                  const Eigen::VectorXcd& shape) {
  const Eigen::Vector3d x = axis.unitOrthogonal(), y = axis.cross(x);
  double largest = 0, whirl = 0;
  for (const Index row : rows) {
    const Eigen::Vector3cd u = model.C.middleRows(row, 3) * shape;
    const std::complex<double> u_x = x.dot(u.real()) + std::complex<double>(0, x.dot(u.imag())),
                               u_y = y.dot(u.real()) + std::complex<double>(0, y.dot(u.imag()));
    const double size = std::norm(u_x) + std::norm(u_y);
    if (!(size > largest)) continue;
    largest = size;
    whirl = -2 * (std::conj(u_x) * u_y).imag() / size;
  }
  return largest > kNoOrbit * calc_scale(model, rows, shape) ? whirl : 0;
}

}  // namespace

void track_poles(records::LinearSweep& sweep, const Eigen::Vector3d& spin_axis) {
  const auto np = static_cast<Index>(sweep.models.size());
  if (np == 0) return;
  const Index nx = sweep.models.front().A.rows();
  for (auto* m : {&sweep.real, &sweep.imag, &sweep.frequency_hz, &sweep.damping}) m->setZero(np, nx);
  sweep.correlation.setOnes(np, nx);
  std::vector<Index> positions;
  if (!spin_axis.isZero(0)) {
    positions = list_positions(sweep.models.front());
    if (positions.empty())
      throw InputError("linear.no-orbit", {}, "no output of the model is a position with components x, y, z",
                       "add a sensor of the position of a node of the rotor, or leave the axis of the spin out");
    sweep.whirl.setZero(np, nx);
  }
  sweep.mode.assign(static_cast<std::size_t>(np), std::vector<std::string>(static_cast<std::size_t>(nx)));
  EigenSystem before;
  std::vector<int> order(static_cast<std::size_t>(nx));
  for (Index k = 0; k < np; ++k) {
    const auto& model = sweep.models[static_cast<std::size_t>(k)];
    BOUGH_DEMAND(model.A.rows() == nx);
    EigenSystem here = calc_eigen_system(model.A);
    if (k == 0) {
      for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
      // Eigenvalues in the order of the table of poles: by distance from zero, pairs together.
      std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        const auto key = [&](int i) {
          const std::complex<double> v = here.value[i];
          return std::tuple(std::abs(v), v.real(), std::abs(v.imag()), -v.imag());
        };
        return key(a) < key(b);
      });
    } else {
      Eigen::VectorXd correlation;
      order = follow(before, here, correlation);
      sweep.correlation.row(k) = correlation.transpose();
    }
    EigenSystem sorted{here.value(order), here.right(Eigen::all, order), here.left(order, Eigen::all)};
    before = std::move(sorted);
    for (Index b = 0; b < nx && !positions.empty(); ++b)
      if (std::abs(before.value[b].imag()) > 0)
        sweep.whirl(k, b) =
            (before.value[b].imag() > 0 ? 1 : -1) * calc_whirl(model, positions, spin_axis, before.right.col(b));
    std::vector<bool> is_used(static_cast<std::size_t>(nx), false);
    for (Index b = 0; b < nx; ++b) {
      // The poles of the model come block by block: exact zeros; the nearest is the one meant.
      const std::complex<double> rough = before.value[b];
      Index best = -1;
      double min_distance = 0;
      for (Index i = 0; i < nx; ++i) {
        const auto pole = model.sample_time > 0 ? records::calc_z(model, i)
                                                : std::complex<double>(model.poles.real[i], model.poles.imag[i]);
        const double far = std::abs(rough - pole);
        if (is_used[static_cast<std::size_t>(i)] || (best >= 0 && far >= min_distance)) continue;
        best = i, min_distance = far;
      }
      is_used[static_cast<std::size_t>(best)] = true;
      sweep.real(k, b) = model.poles.real[best];
      sweep.imag(k, b) = model.poles.imag[best];
      sweep.frequency_hz(k, b) = model.poles.frequency_hz[best];
      sweep.damping(k, b) = model.poles.damping[best];
      sweep.mode[static_cast<std::size_t>(k)][static_cast<std::size_t>(b)] =
          model.poles.mode[static_cast<std::size_t>(best)];
    }
  }
}

}  // namespace bough::statespace
