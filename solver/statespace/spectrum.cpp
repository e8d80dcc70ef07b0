#include "solver/statespace/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/diagnostic.hpp"
#include "solver/statespace/frequency_response.hpp"
#include "solver/statespace/quadrature.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd calc_density(const Spectrum& spectrum, double f, Index num_inputs) {
  const auto& all = spectrum.frequency_hz;
  const Index after = std::clamp<Index>(std::upper_bound(all.begin(), all.end(), f) - all.begin(), 1, all.size() - 1);
  const double span = all[after] - all[after - 1], part = span > 0 ? (f - all[after - 1]) / span : 0;
  const VectorXd row = ((1 - part) * spectrum.density.row(after - 1) + part * spectrum.density.row(after)).transpose();
  return row.size() == num_inputs ? row : VectorXd(VectorXd::Constant(num_inputs, row[0]));
}

}  // namespace

ComponentCost calc_component_cost(const StateSpace& s, const Spectrum& spectrum) {
  BOUGH_DEMAND(spectrum.frequency_hz.size() >= 2 && spectrum.density.rows() == spectrum.frequency_hz.size() &&
               (spectrum.density.cols() == 1 || spectrum.density.cols() == s.B.cols()));
  ComponentCost cost;
  cost.state = VectorXd::Zero(s.A.rows());
  const StablePart part = split_stable(s.A);
  // Unstable parts raise the error that white noise raises.
  if (!part.is_stable()) return calc_component_cost(s.A, s.B, s.C);
  cost.num_rigid = part.num_rigid;
  const MatrixXd decays = (part.U * part.L).real();
  const MatrixXd seen = s.C * decays, driven = decays * s.B;
  const TransferMatrix transfer(s.A, driven, seen, MatrixXd::Zero(s.C.rows(), s.B.cols()));
  const auto rule = make_quadrature(part.T.diagonal(), {spectrum.frequency_hz.begin(), spectrum.frequency_hz.end()});
  for (Index k = 0; k < rule.weight.size(); ++k) {
    const double f = rule.frequency_hz[k];
    const MatrixXcd x = transfer.calc_states({0, 2 * std::numbers::pi * f});
    const MatrixXcd y = seen * x;
    const VectorXd density = calc_density(spectrum, f, s.B.cols());
    const MatrixXcd back = (seen.transpose() * y).conjugate();
    cost.state += rule.weight[k] * (x.cwiseProduct(back).real() * density);
  }
  cost.total = cost.state.sum();
  return cost;
}

StateSpace subtract(const StateSpace& full, const StateSpace& reduced) {
  const Index n = full.A.rows(), m = reduced.A.rows();
  StateSpace both{MatrixXd::Zero(n + m, n + m), MatrixXd(n + m, full.B.cols()), MatrixXd(full.C.rows(), n + m)};
  both.A.topLeftCorner(n, n) = full.A;
  both.A.bottomRightCorner(m, m) = reduced.A;
  both.B << full.B, reduced.B;
  both.C << full.C, -reduced.C;
  return both;
}

double calc_mean_square_difference(const StateSpace& full, const StateSpace& reduced, const Spectrum& spectrum) {
  return std::max(0.0, calc_component_cost(subtract(full, reduced), spectrum).total);
}

}  // namespace bough::statespace
