#include "solver/integrate/radau_table.hpp"

#include <algorithm>
#include <cmath>

#include "base/diagnostic.hpp"

namespace bough::solver {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// P_s - P_{s-1} of Legendre at 2x - 1: its roots are the nodes.
Real calc_radau_polynomial(int s, Real x) {
  const Real z = 2 * x - 1;
  Real before = 1, now = z;
  for (int k = 1; k < s; ++k) {
    const Real next = ((2 * k + 1) * z * now - static_cast<Real>(k) * before) / (k + 1);
    before = now;
    now = next;
  }
  return now - before;
}

Vector find_nodes(int s) {
  Vector c(s);
  int count = 0;
  constexpr int kGrid = 1000;
  for (int i = 0; i + 1 < kGrid && count < s - 1; ++i) {  // the last root, 1, is known
    Real low = static_cast<Real>(i) / kGrid, high = static_cast<Real>(i + 1) / kGrid;
    const Real sign = calc_radau_polynomial(s, low);
    if (sign * calc_radau_polynomial(s, high) > 0) continue;
    for (int k = 0; k < 80; ++k) {
      const Real middle = (low + high) / 2;
      (sign * calc_radau_polynomial(s, middle) > 0 ? low : high) = middle;
    }
    c[count++] = (low + high) / 2;
  }
  BOUGH_DEMAND(count == s - 1);
  c[s - 1] = 1;
  return c;
}

}  // namespace

RadauTable make_radau_table(int stages) {
  BOUGH_DEMAND(stages >= 3 && stages % 2 == 1);
  const Eigen::Index s = stages;
  const Vector c = find_nodes(stages);
  Matrix powers(s, s), integrals(s, s);
  for (Eigen::Index i = 0; i < s; ++i) {
    for (Eigen::Index k = 0; k < s; ++k) {
      powers(i, k) = std::pow(c[i], static_cast<Real>(k));
      integrals(i, k) = powers(i, k) * c[i] / static_cast<Real>(k + 1);
    }
  }
  const Matrix to_weights = powers.inverse(), A = integrals * to_weights, A_inverse = A.inverse();

  RadauTable table;
  table.stages = stages;
  table.c = c.cast<double>();
  table.A = A.cast<double>();
  const Eigen::EigenSolver<Matrix> eigen(A_inverse);
  const auto right = eigen.eigenvectors();
  const auto left = right.inverse().eval();
  for (Eigen::Index k = 0; k < s; ++k) {
    const auto value = eigen.eigenvalues()[k];
    if (value.imag() > 0) {
      table.pairs.push_back({{static_cast<double>(value.real()), static_cast<double>(value.imag())},
                             left.row(k).cast<std::complex<double>>(),
                             right.col(k).cast<std::complex<double>>()});
    } else if (value.imag() == 0) {
      table.real_value = static_cast<double>(value.real());
      const Real scale = right.col(k).real().norm();  // eigenvectors of a real eigenvalue are real
      table.real_right = (right.col(k).real() / scale).template cast<double>();
      table.real_left = (left.row(k).real() * scale).template cast<double>();
    }
  }
  BOUGH_DEMAND(static_cast<Eigen::Index>(2 * table.pairs.size()) + 1 == s);

  // Quadrature of order s with the weight 1 / real_value at the start of the step, minus that of the method.
  Vector moments(s);
  for (Eigen::Index k = 0; k < s; ++k) moments[k] = 1 / static_cast<Real>(k + 1);
  const Vector b = to_weights.transpose() * moments;
  moments[0] -= 1 / static_cast<Real>(table.real_value);
  const Vector embedded = to_weights.transpose() * moments;
  table.error = (A_inverse.transpose() * (embedded - b)).cast<double>();

  table.barycentric.setOnes(s + 1);
  const auto node = [&](Eigen::Index i) { return i == 0 ? Real(0) : c[i - 1]; };
  for (Eigen::Index i = 0; i <= s; ++i) {
    Real product = 1;
    for (Eigen::Index j = 0; j <= s; ++j)
      if (j != i) product *= node(i) - node(j);
    table.barycentric[i] = static_cast<double>(1 / product);
  }
  return table;
}

}  // namespace bough::solver
