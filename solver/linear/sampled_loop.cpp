#include "solver/linear/sampled_loop.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include <unsupported/Eigen/MatrixFunctions>

#include "solver/statespace/poles.hpp"

namespace bough::solver {
namespace {

constexpr double kInputStep = 1e-2;
/// Largest number of values at the cut in a period of all samples: the loop has as many inputs.
constexpr long kMaxLifted = 100;

/// Effect of an input added at the cut: a column of m⁺. The input acts `before` and after the change.
VectorXd calc_input_effect(Plant& plant, SampledSystem& departures, const PlantInput& cut, bool is_before,
                           bool is_after) {
  return departures.differentiate_one(
      [&](double h) -> VectorXd {
        return plant.sample(departures.point(), &cut, is_before ? h : 0, is_after ? h : 0)(plant.sampled_rows());
      },
      kInputStep);
}

/// Permutation that moves sample k + shift of each queue to position k.
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

/// Number N of values at the cut, held for `hold` each, until all samples repeat. Throws "linear.slower-samples".
long count_held_values(const Plant& plant, const PlantInput& cut, double hold, const SourceLocation& at) {
  std::vector<double> times{hold};
  for (const auto& [time, queue] : plant.list_cycles()) times.push_back(time);
  const double common = find_common_period(times);
  const long count = common > 0 ? std::lround(common / hold) : 0;
  if (count >= 1 && count <= kMaxLifted) return count;
  std::ostringstream what;
  what << "'" << cut.name << "' is held for " << hold << ", and all samples together repeat ";
  if (count > 0)
    what << "after " << count << " times that, more than " << kMaxLifted;
  else
    what << "never: the sample times have no period in common";
  throw InputError("linear.slower-samples", at, what.str(),
                   "choose sample times that are simple multiples of each other, or cut at a slower signal");
}

/// Whole number of the value at the cut that begins at this instant of the period; -1: none does.
int find_change(double instant, double hold) {
  const double k = std::round(instant / hold);
  return std::abs(instant - k * hold) <= 1e-9 * hold ? static_cast<int>(k) : -1;
}

}  // namespace

records::LinearModel calc_sampled_loop(Plant& plant, const OperatingPoint& point, const PlantInput& cut,
                                       const MatrixXd& A, const VectorXd& b, const SourceLocation& at,
                                       Uncertainty& uncertainty) {
  const SampleTimes hold = plant.find_hold(cut);
  const long num_values = count_held_values(plant, cut, hold.period, at);
  const double period = static_cast<double>(num_values) * hold.period;
  SampledSystem departures(plant, point);
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
  int num_begun = 0;  // values of the cut in this period
  records::LinearModel model;
  model.sample_time = period;
  model.C = MatrixXd::Zero(num_values, size);
  model.D = MatrixXd::Zero(num_values, num_values);
  MatrixXd map = MatrixXd::Identity(size, size), effects = MatrixXd::Zero(size, num_values);
  const auto advance_effects = [&](const MatrixXd& by) {
    for (int i = 0; i < num_begun; ++i) effects.col(i) = VectorXd(by * effects.col(i));
  };
  const auto back = [&](const OperatingPoint& p) -> VectorXd {
    return VectorXd::Constant(1, plant.calc_return(p, cut, 0));
  };
  for (size_t k = 0; k < instants.size(); ++k) {
    departures.set_time(base + instants[k]);
    const int change = find_change(instants[k], hold.period);
    MatrixXd sample = MatrixXd::Identity(size, size);
    sample.block(nx, 0, nm, nx + nm) = departures.calc_sample();
    sample.col(last).segment(nx, nm) = calc_input_effect(plant, departures, cut, true, /*is_after=*/change < 0);
    if (change >= 0) sample(last, last) = 0;  // d is another one from here on
    advance_effects(sample);
    if (change >= 0) {
      BOUGH_DEMAND(change == num_begun && change < num_values);
      effects.col(change).segment(nx, nm) = calc_input_effect(plant, departures, cut, false, true);
      effects(last, change) = 1;
      num_begun = change + 1;
      VectorXd row = VectorXd::Zero(size);
      row.segment(nx, nm) = departures.differentiate_all(back, nx, nx + nm).transpose();
      model.C.row(change) = row.transpose() * sample * map;
      for (int i = 0; i < num_begun; ++i) model.D(change, i) = row.dot(effects.col(i));
    }
    const double to = k + 1 < instants.size() ? instants[k + 1] : period;
    const MatrixXd step = MatrixXd(flow * (to - instants[k])).exp();
    map = step * sample * map;
    advance_effects(step);
  }
  BOUGH_DEMAND(num_begun == num_values);
  uncertainty.add(departures.uncertainty());
  const MatrixXd R = calc_renumbering(plant, nx, size, period);
  model.A = R * map;
  model.B = R * effects;
  model.states.name = departures.list_names();
  model.states.name.push_back(cut.name + " (held)");
  for (int i = 0; i < size; ++i) {
    const bool is_dof = i < 2 * plant.num_dofs();
    const std::string dims = is_dof ? plant.dof_dims(i % plant.num_dofs()) : "by the controller";
    model.states.dims.push_back(dims + (is_dof && i >= plant.num_dofs() ? "/T" : ""));
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
