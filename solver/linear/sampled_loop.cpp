#include "solver/linear/sampled_loop.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include <unsupported/Eigen/MatrixFunctions>

#include "solver/statespace/poles.hpp"

namespace bough::solver {
namespace {

constexpr double kInputStep = 1e-2;

/// Of what is added at the cut: a column of m⁺, `before` and after the change.
VectorXd calc_input_effect(Plant& plant, Departures& departures, const PlantInput& cut, bool is_before, bool is_after) {
  return departures.differentiate_one(
      [&](double h) -> VectorXd {
        return plant.sample(departures.point(), &cut, is_before ? h : 0, is_after ? h : 0)(plant.sampled_rows());
      },
      kInputStep);
}

/// The sample k + shift of each queue takes the place of k.
MatrixXd calc_renumbering(const Plant& plant, int nx, int size, double period) {
  MatrixXd R = MatrixXd::Identity(size, size);
  for (const auto& queue : plant.list_queues()) {
    const int shift = static_cast<int>(std::lround(period / queue.period)) % queue.length;
    for (int slot = 0; slot < queue.length; ++slot) {
      const int to = (slot + queue.length - shift) % queue.length;
      for (int i = 0; i < queue.size; ++i) {
        const int first = nx + queue.first + i;
        R.row(first + to * queue.size).setZero();
        R(first + to * queue.size, first + slot * queue.size) = 1;
      }
    }
  }
  return R;
}

}  // namespace

records::LinearModel calc_sampled_loop(Plant& plant, const OperatingPoint& point, const PlantInput& cut,
                                       const MatrixXd& A, const VectorXd& b, const SourceLocation& at,
                                       Uncertainty& uncertainty) {
  const SampleTimes hold = plant.find_hold(cut);
  const double period = hold.period;
  std::vector<double> times;
  for (const auto& [time, queue] : plant.list_cycles()) times.push_back(time);
  const double common = find_common_period(times);
  if (std::abs(common - period) > 1e-9 * period) {
    std::ostringstream what;
    what << "'" << cut.name << "' is held for " << period << ", and all samples together repeat ";
    common > 0 ? what << "after " << common << " only" : what << "never";
    throw InputError("linear.slower-samples", at, what.str() + ": its loop is another one at each of its samples",
                     "cut at a signal of the slowest sample time, of which the others are whole fractions");
  }
  Departures departures(plant, point);
  const int nx = departures.num_x(), nm = departures.num_m(), size = nx + nm + 1, last = nx + nm;
  MatrixXd flow = MatrixXd::Zero(size, size);
  flow.topLeftCorner(nx, nx) = A;
  flow.block(0, nx, nx, nm) = departures.calc_held();
  flow.col(last).head(nx) = b;

  const auto samples = plant.collect_samples();
  double latest = hold.first;
  for (const auto& s : samples) latest = std::max(latest, s.first);
  const double base = hold.first + period * (std::ceil((latest - hold.first) / period - 1e-9) + 1);
  const auto instants = list_instants(samples, base, period);
  BOUGH_DEMAND(!instants.empty() && instants.front() == 0);
  records::LinearModel model;
  model.sample_time = period;
  MatrixXd map = MatrixXd::Identity(size, size);
  VectorXd effect = VectorXd::Zero(size);
  for (size_t k = 0; k < instants.size(); ++k) {
    departures.set_time(base + instants[k]);
    MatrixXd sample = MatrixXd::Identity(size, size);
    sample.block(nx, 0, nm, nx + nm) = departures.calc_sample();
    sample.col(last).segment(nx, nm) = calc_input_effect(plant, departures, cut, true, /*is_after=*/k > 0);
    if (k == 0) {  // d is another one from here on
      sample(last, last) = 0;
      effect.segment(nx, nm) = calc_input_effect(plant, departures, cut, false, true);
      effect[last] = 1;
      VectorXd row = VectorXd::Zero(size);
      const auto back = [&](const OperatingPoint& p) -> VectorXd {
        return VectorXd::Constant(1, plant.calc_return(p, cut, 0));
      };
      row.segment(nx, nm) = departures.differentiate_all(back, nx, nx + nm).transpose();
      model.C = row.transpose() * sample;
      model.D = row.transpose() * effect;
    } else {
      effect = sample * effect;
    }
    const double to = k + 1 < instants.size() ? instants[k + 1] : period;
    const MatrixXd step = MatrixXd(flow * (to - instants[k])).exp();
    map = step * sample * map;
    effect = step * effect;
  }
  uncertainty.add(departures.uncertainty());
  const MatrixXd R = calc_renumbering(plant, nx, size, period);
  model.A = R * map;
  model.B = R * effect;
  model.states.name = departures.list_names();
  model.states.name.push_back(cut.name + " (held)");
  for (int i = 0; i < size; ++i) {
    const bool is_freedom = i < 2 * plant.num_freedoms();
    const std::string dims = is_freedom ? plant.freedom_dims(i % plant.num_freedoms()) : "by the controller";
    model.states.dims.push_back(dims + (is_freedom && i >= plant.num_freedoms() ? "/T" : ""));
  }
  return model;
}

std::vector<records::AliasedMode> find_aliased(const records::Poles& poles, double sample_time) {
  std::vector<records::AliasedMode> aliased;
  for (Eigen::Index i = 0; i < poles.imag.size(); ++i) {
    const double frequency = poles.imag[i] / (2 * std::numbers::pi);
    if (frequency * sample_time <= 0.5) continue;
    const double appears_at = std::abs(frequency - std::round(frequency * sample_time) / sample_time);
    aliased.push_back({poles.mode[static_cast<size_t>(i)], frequency, appears_at});
  }
  return aliased;
}

records::Poles calc_sampled_poles(const records::LinearModel& model) {
  constexpr double kGone = 1e-16;
  auto poles = statespace::calc_poles(model.A, model.states.name);
  for (Eigen::Index i = 0; i < poles.real.size(); ++i) {
    const std::complex<double> z(poles.real[i], poles.imag[i]);
    const double real = std::log(std::max(std::abs(z), kGone)) / model.sample_time;
    const double imag = std::abs(z) > kGone ? std::arg(z) / model.sample_time : 0, size = std::hypot(real, imag);
    poles.real[i] = real;
    poles.imag[i] = imag;
    poles.frequency_hz[i] = size / (2 * std::numbers::pi);
    poles.damping[i] = size > 0 ? -real / size : 0;
  }
  return poles;
}

}  // namespace bough::solver
