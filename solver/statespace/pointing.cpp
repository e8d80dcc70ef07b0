#include "solver/statespace/pointing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/diagnostic.hpp"
#include "solver/statespace/quadrature.hpp"

namespace bough::statespace {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTwoPi = 2 * std::numbers::pi;
/// Lobes of the weights that are integrated one by one.
constexpr int kMaxLobes = 256;

/// Multiples of 1/T within the band.
void add_lobes(double time, double min_hz, double max_hz, std::vector<double>& corners) {
  if (!(time > 0)) return;
  for (int k = 1; k <= kMaxLobes; ++k)
    if (const double f = k / time; f > min_hz && f < max_hz) corners.push_back(f);
}

Complex calc_suspension(double omega_0, double damping, double omega, double shift) {
  const Complex spring(omega_0 * omega_0, 2 * damping * omega_0 * omega);
  return spring / (spring - omega * omega + shift);
}

}  // namespace

double ExposureWeight::calc(double hz, double length) const {
  const double longest = std::max(exposure, interval);
  return calc_exposure_weight(part, hz, exposure, interval, length * longest > 1.5 && hz * exposure > kMaxLobes / 2.0);
}

std::vector<MatrixXd> integrate_exposures(const records::LinearModel& model, const std::vector<InputSpectrum>& inputs,
                                          const records::FrequencyResponse& response,
                                          const std::vector<ExposureWeight>& weights) {
  const Index ny = model.C.rows(), nf = response.frequency_hz.size();
  BOUGH_DEMAND(nf >= 2);
  const double min_hz = response.frequency_hz[0], max_hz = response.frequency_hz[nf - 1];
  std::vector<double> corners{min_hz, max_hz};
  bool has_powers = false;
  for (const auto& input : inputs) {
    for (const double f : input.list_corners())
      if (f > min_hz && f < max_hz) corners.push_back(f);
    has_powers = has_powers || input.has_powers();
  }
  for (const auto& weight : weights)
    for (const double time : {weight.exposure, weight.interval}) add_lobes(time, min_hz, max_hz, corners);
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());

  const auto rule = make_quadrature(list_poles(model), corners, has_powers);
  const TransferMatrix transfer(model.A, model.B, model.C, model.D);
  std::vector<MatrixXd> found(weights.size(), MatrixXd::Zero(std::ssize(inputs), ny));
  double length = 0;
  for (Index k = 0; k < rule.weight.size(); ++k) {
    if (k % kQuadraturePoints == 0) length = rule.weight.segment(k, kQuadraturePoints).sum();
    const double f = rule.frequency_hz[k];
    const MatrixXcd G = transfer.calc(calc_argument(model, kTwoPi * f));
    for (Index s = 0; s < std::ssize(inputs); ++s) {
      const MatrixXcd S = inputs[static_cast<std::size_t>(s)].calc(f);
      if (S.isZero(0)) continue;
      const VectorXd density = rule.weight[k] * (G * S).cwiseProduct(G.conjugate()).rowwise().sum().real().cwiseMax(0);
      for (std::size_t w = 0; w < weights.size(); ++w)
        found[w].row(s) += weights[w].calc(f, length) * density.transpose();
    }
  }
  return found;
}

MatrixXd calc_running_rms(const InputSpectrum& input, const records::FrequencyResponse& response) {
  const Index nf = response.frequency_hz.size(), ny = response.outputs.size();
  MatrixXd square = MatrixXd::Zero(nf, ny);
  Eigen::RowVectorXd before(ny);
  for (Index k = 0; k < nf; ++k) {
    const MatrixXcd& G = response.value[static_cast<std::size_t>(k)];
    const MatrixXcd S = input.calc(response.frequency_hz[k]);
    const Eigen::RowVectorXd density =
        (G * S).cwiseProduct(G.conjugate()).rowwise().sum().real().cwiseMax(0).transpose();
    if (k > 0)
      square.row(k) =
          square.row(k - 1) + 0.5 * (response.frequency_hz[k] - response.frequency_hz[k - 1]) * (density + before);
    before = density;
  }
  return square.cwiseSqrt();
}

Complex calc_wheel_transfer(const records::WheelMode& mode, double omega) {
  return calc_suspension(kTwoPi * mode.frequency_hz, mode.damping, omega, 0);
}

Complex calc_rocking_transfer(const records::WheelMode& mode, double inertia_ratio, double omega, double spin) {
  return calc_suspension(kTwoPi * mode.frequency_hz, mode.damping, omega, inertia_ratio * spin * omega);
}

std::vector<VectorXd> calc_tones(const records::LinearModel& model, const TransferMatrix& transfer,
                                 const std::vector<Tone>& tones, const std::vector<ExposureWeight>& weights) {
  std::vector<VectorXd> found(weights.size(), VectorXd::Zero(model.C.rows()));
  for (const Tone& tone : tones) {
    const Eigen::VectorXcd y = transfer.calc(calc_argument(model, tone.omega)) * tone.amplitude;
    for (std::size_t w = 0; w < weights.size(); ++w)
      found[w] += 0.5 * weights[w].calc(tone.omega / kTwoPi) * y.cwiseAbs2();
  }
  return found;
}

}  // namespace bough::statespace
