#include "solver/linear/sampled.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <unsupported/Eigen/MatrixFunctions>

#include "solver/statespace/poles.hpp"

namespace bough::solver {

records::Multipliers calc_multipliers(Plant& plant, const OperatingPoint& point, const MatrixXd& A,
                                      const SourceLocation& at, Diagnostics& diagnostics, Uncertainty& uncertainty) {
  records::Multipliers out;
  if (plant.sampled_rows().empty()) return out;
  if (const std::string opaque = plant.find_opaque(); !opaque.empty()) {
    diagnostics.warning("linear.fmu-held", at, opaque + " is an FMU: there are no multipliers of the closed loops",
                        "put a linear controller in its place");
    return out;
  }
  std::vector<double> cycles;
  for (const auto& [period, queue] : plant.list_cycles()) cycles.push_back(period * queue);
  const double period = find_common_period(cycles);
  if (period == 0) {
    diagnostics.warning("linear.no-common-period", at,
                        "the sample times have no period in common: there are no multipliers of the closed loops",
                        "choose sample times that are simple multiples of each other");
    return out;
  }
  SampledSystem departures(plant, point);
  const int nx = departures.num_x(), nm = departures.num_m();
  BOUGH_DEMAND(A.rows() == nx);
  MatrixXd flow = MatrixXd::Zero(nx + nm, nx + nm);
  flow.topLeftCorner(nx, nx) = A;
  flow.topRightCorner(nx, nm) = departures.calc_held();
  // Numbers of samples count from the start, and the queues are full a whole number of periods later.
  const double start = plant.get_initial_state().t;
  const auto samples = plant.collect_samples();
  double latest = 0;
  for (const auto& s : samples) latest = std::max(latest, s.first - start);
  const double base = start + period * (std::floor(latest / period) + 1);
  const auto instants = list_instants(samples, start, period);
  MatrixXd map = MatrixXd::Identity(nx + nm, nx + nm);
  for (size_t k = 0; k < instants.size(); ++k) {
    departures.set_time(base + instants[k]);
    MatrixXd sample = MatrixXd::Identity(nx + nm, nx + nm);
    sample.bottomRows(nm) = departures.calc_sample();
    const double to = k + 1 < instants.size() ? instants[k + 1] : period;
    map = MatrixXd(flow * (to - instants[k])).exp() * sample * map;
  }
  uncertainty.add(departures.uncertainty());
  const auto values = statespace::calc_poles(map, departures.list_names());
  out.period = period;
  out.num_samples = static_cast<int>(instants.size());
  const Eigen::Index count = values.size();
  for (auto* v : {&out.real, &out.imag, &out.decay, &out.frequency_hz}) v->setZero(count);
  for (Eigen::Index i = 0; i < count; ++i) {  // the slowest first
    const Eigen::Index from = count - 1 - i;
    const std::complex<double> z(values.real[from], values.imag[from]);
    out.real[i] = z.real();
    out.imag[i] = z.imag();
    out.decay[i] = z == 0.0 ? -std::numeric_limits<double>::infinity() : std::log(std::abs(z)) / period;
    out.frequency_hz[i] = std::abs(std::arg(z)) / (2 * std::numbers::pi * period);
    out.mode.push_back(values.mode[static_cast<size_t>(from)]);
  }
  return out;
}

}  // namespace bough::solver
