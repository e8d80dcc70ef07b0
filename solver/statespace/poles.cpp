#include "solver/statespace/poles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "base/diagnostic.hpp"
#include "solver/statespace/blocks.hpp"

namespace bough::statespace {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Pole {
  std::complex<double> value;
  std::string mode, body_mode, hinge;
  double error = 0;
};

std::string get_coordinate(const std::string& state) {
  const auto end = state.rfind("_dot");
  return end != std::string::npos && end + 4 == state.size() ? state.substr(0, end) : state;
}

/// "boom:eta3".
bool is_body_mode(const std::string& coordinate) {
  const auto at = coordinate.rfind(":eta");
  return at != std::string::npos && at + 4 < coordinate.size() &&
         coordinate.find_first_not_of("0123456789", at + 4) == std::string::npos;
}

/// "controller 'pid' (state 1)".
bool is_state(const std::string& coordinate) { return coordinate.ends_with(')'); }

/// Shares of bodies that are alike differ by rounding: the first by name has the pole.
constexpr double kMore = 1 + 1e-6;

/// From the share of each coordinate.
Pole name_pole(std::complex<double> value, const std::map<std::string, double>& share) {
  Pole pole{value, "", "", "", 0};
  double max_share = -1, max_modal = 0, max_hinge = 0;
  for (const auto& [coordinate, part] : share) {
    if (part > max_share * kMore) max_share = part, pole.mode = coordinate;
    if (is_state(coordinate)) continue;
    double& best = is_body_mode(coordinate) ? max_modal : max_hinge;
    if (part > best * kMore) best = part, (is_body_mode(coordinate) ? pole.body_mode : pole.hinge) = coordinate;
  }
  // Participation that is only round-off does not count.
  if (max_modal < 1e-9 * max_share) pole.body_mode.clear();
  if (max_hinge < 1e-9 * max_share) pole.hinge.clear();
  return pole;
}

void add_poles(const MatrixXd& A, const std::vector<int>& block, const std::vector<std::string>& names,
               const MatrixXd& error, std::vector<Pole>& poles) {
  if (block.size() == 1) {
    poles.push_back(name_pole(A(block[0], block[0]), {{get_coordinate(names[static_cast<std::size_t>(block[0])]), 1}}));
    if (error.size() > 0) poles.back().error = error(block[0], block[0]);
    return;
  }
  const auto fail = [] {
    throw ComputationError("linear.no-poles", {}, "the eigenvalues of A were not found", "look at A for huge entries");
  };
  MatrixXd a = A(block, block);
  if (!a.allFinite()) fail();
  const VectorXd scale = balance(a);
  const Eigen::EigenSolver<MatrixXd> solver(a);
  if (solver.info() != Eigen::Success) fail();
  const Eigen::MatrixXcd right = solver.eigenvectors();
  // Least norm where several eigenvectors are one: the shares of the other poles stay right.
  const Eigen::MatrixXcd left = right.completeOrthogonalDecomposition().pseudoInverse();
  for (Eigen::Index p = 0; p < right.cols(); ++p) {
    std::map<std::string, double> share;
    for (std::size_t k = 0; k < block.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      share[get_coordinate(names[static_cast<std::size_t>(block[k])])] += std::abs(right(row, p) * left(p, row));
    }
    poles.push_back(name_pole(solver.eigenvalues()[p], share));
    if (error.size() == 0) continue;
    const VectorXd v = right.col(p).cwiseAbs(), w = left.row(p).transpose().cwiseAbs();
    poles.back().error = w.cwiseQuotient(scale).dot(error(block, block) * scale.cwiseProduct(v)) +
                         std::numeric_limits<double>::epsilon() * a.norm() * w.norm() * v.norm();
  }
}

}  // namespace

records::Poles calc_poles(const MatrixXd& A, const std::vector<std::string>& names, const MatrixXd& error) {
  BOUGH_DEMAND(A.rows() == A.cols() && static_cast<Eigen::Index>(names.size()) == A.rows());
  BOUGH_DEMAND(error.size() == 0 || (error.rows() == A.rows() && error.cols() == A.cols()));
  std::vector<Pole> poles;
  for (const auto& block : find_blocks(A)) add_poles(A, block, names, error, poles);
  // Pairs from one block are exact conjugates and stay together.
  std::stable_sort(poles.begin(), poles.end(), [](const Pole& a, const Pole& b) {
    const auto key = [](const Pole& p) {
      return std::tuple(std::abs(p.value), p.value.real(), std::abs(p.value.imag()), -p.value.imag());
    };
    return key(a) < key(b);
  });
  records::Poles out;
  const auto n = static_cast<Eigen::Index>(poles.size());
  for (auto* v : {&out.real, &out.imag, &out.frequency_hz, &out.damping}) v->setZero(n);
  if (error.size() > 0) out.error.setZero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Pole& pole = poles[static_cast<std::size_t>(i)];
    const double size = std::abs(pole.value);
    out.real[i] = pole.value.real();
    out.imag[i] = pole.value.imag();
    out.frequency_hz[i] = size / (2 * std::numbers::pi);
    if (error.size() > 0) out.error[i] = pole.error;
    out.mode.push_back(pole.mode);
    out.body_mode.push_back(pole.body_mode);
    out.hinge.push_back(pole.hinge);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const double size = std::abs(poles[static_cast<std::size_t>(i)].value);
    out.damping[i] = size > records::calc_origin_radius(out, i) ? -out.real[i] / size + 0.0 : 0;
  }
  return out;
}

Eigen::VectorXcd calc_eigenvector(const MatrixXd& A, std::complex<double> value) {
  BOUGH_DEMAND(A.rows() == A.cols() && A.rows() > 0);
  MatrixXd a = A;
  const VectorXd scale = balance(a);
  // Beside the eigenvalue, so that the matrix has an inverse; the vector is the same.
  const double size = std::max(a.norm(), std::numeric_limits<double>::min());
  Eigen::MatrixXcd shifted = a.cast<std::complex<double>>();
  shifted.diagonal().array() -= value + 1e-10 * size;
  const Eigen::PartialPivLU<Eigen::MatrixXcd> lu(shifted);
  // Start vector without a symmetry that an eigenvector could be orthogonal to.
  Eigen::VectorXcd y(a.rows());
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = 1 + 0.1 * std::sin(1.0 + 2.3 * static_cast<double>(i));
  for (int k = 0; k < 3; ++k) y = lu.solve(y).eval().normalized();
  return scale.cwiseProduct(y).normalized();
}

}  // namespace bough::statespace
