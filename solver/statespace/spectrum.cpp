#include "solver/statespace/spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "base/diagnostic.hpp"
#include "solver/statespace/frequency_response.hpp"

namespace bough::statespace {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Abramowitz & Stegun, Handbook of Mathematical Functions, table 25.4, n = 8.
constexpr std::array<double, 4> kPoints{0.183434642495649805, 0.525532409916328986, 0.796666477413626740,
                                        0.960289856497536232};
constexpr std::array<double, 4> kWeights{0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                         0.101228536290376259};

/// Ends of the intervals, ascending.
std::vector<double> choose_intervals(const StablePart& part, const Spectrum& spectrum) {
  const double low = spectrum.frequency_hz[0], high = spectrum.frequency_hz[spectrum.frequency_hz.size() - 1];
  std::set<double> ends(spectrum.frequency_hz.begin(), spectrum.frequency_hz.end());
  const auto add = [&](double f) {
    if (f > low && f < high) ends.insert(f);
  };
  for (Index i = 0; i < part.T.rows(); ++i) {
    const double at = std::abs(part.T(i, i).imag()) / (2 * std::numbers::pi);
    const double width = std::abs(part.T(i, i).real()) / (2 * std::numbers::pi);
    add(at);
    for (double far = 0.5 * width; far < high + at; far *= 2) {
      add(at - far);
      add(at + far);
    }
  }
  return {ends.begin(), ends.end()};
}

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
  const auto ends = choose_intervals(part, spectrum);
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const double middle = 0.5 * (ends[k] + ends[k + 1]), half = 0.5 * (ends[k + 1] - ends[k]);
    for (std::size_t p = 0; p < 2 * kPoints.size(); ++p) {
      const double f = middle + (p % 2 == 0 ? half : -half) * kPoints[p / 2];
      const MatrixXcd x = transfer.calc_states({0, 2 * std::numbers::pi * f});
      const MatrixXcd y = seen * x;
      const VectorXd density = calc_density(spectrum, f, s.B.cols());
      const MatrixXcd back = (seen.transpose() * y).conjugate();
      cost.state += half * kWeights[p / 2] * (x.cwiseProduct(back).real() * density);
    }
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
