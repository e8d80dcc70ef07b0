#include "solver/linear/sampled.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <unsupported/Eigen/MatrixFunctions>

#include "solver/linear/difference.hpp"
#include "solver/signals/graph.hpp"
#include "solver/statespace/poles.hpp"

namespace bough::solver {
namespace {

constexpr int kMostSamples = 1000;

/// The shortest time that is a whole multiple of each, to 1e-9 of the cycle; 0: none of that many.
double find_common(const std::vector<double>& cycles) {
  const double longest = *std::max_element(cycles.begin(), cycles.end());
  for (int k = 1; k <= kMostSamples; ++k) {
    const double period = k * longest;
    if (std::all_of(cycles.begin(), cycles.end(), [&](double cycle) {
          const double times = period / cycle;
          return times < kMostSamples && std::abs(times - std::round(times)) < 1e-9 * times;
        }))
      return period;
  }
  return 0;
}

/// Instants in [0, period), each once.
std::vector<double> list_instants(const std::vector<SampleTimes>& samples, double start, double period) {
  std::vector<double> instants;
  for (const auto& s : samples) {
    const double first = s.first - start;
    for (long k = -std::lround(std::floor(first / s.period));; ++k) {
      double t = first + static_cast<double>(k) * s.period;
      if (std::abs(t) < 1e-9 * s.period) t = 0;
      if (t > period * (1 - 1e-12)) break;
      if (t >= 0) instants.push_back(t);
    }
  }
  std::sort(instants.begin(), instants.end());
  const auto is_same = [&](double a, double b) { return std::abs(a - b) < 1e-9 * period / kMostSamples; };
  instants.erase(std::unique(instants.begin(), instants.end(), is_same), instants.end());
  return instants;
}

class Departures {
 public:
  Departures(Plant& plant, const OperatingPoint& point)
      : plant_(plant), point_(point), n_(plant.num_freedoms()), nz_(plant.num_states()) {}
  int num_x() const { return 2 * n_ + nz_; }
  int num_m() const { return static_cast<int>(plant_.sampled_rows().size()); }
  void set_time(double t) { point_.t = t; }

  OperatingPoint move(int j, double h) const {
    OperatingPoint moved = point_;
    if (j < n_)
      moved.q = plant_.displace(point_.q, h * VectorXd::Unit(n_, j));
    else if (j < 2 * n_)
      moved.u[j - n_] += h;
    else if (j < num_x())
      moved.z[plant_.state_row(j - 2 * n_)] += h;
    else
      moved.memory[plant_.sampled_rows()[static_cast<size_t>(j - num_x())]] += h;
    return moved;
  }
  double step(int j) const {
    if (j < 2 * n_) return plant_.step(j % n_);
    if (j < num_x()) return 0.1 * std::max(1.0, std::abs(point_.z[plant_.state_row(j - 2 * n_)]));
    return 0.1 * std::max(1.0, std::abs(point_.memory[plant_.sampled_rows()[static_cast<size_t>(j - num_x())]]));
  }
  MatrixXd differentiate_all(const std::function<VectorXd(const OperatingPoint&)>& f, int first, int last) const {
    MatrixXd value;
    for (int j = first; j < last; ++j) {
      const Difference column = differentiate([&](double h) { return f(move(j, h)); }, step(j));
      if (j == first) value.resize(column.value.size(), last - first);
      value.col(j - first) = (column.value.array().abs() > column.error.array()).select(column.value, 0.0);
    }
    return value;
  }
  /// E: num_x x num_m.
  MatrixXd calc_held() const {
    MatrixXd E = MatrixXd::Zero(num_x(), num_m());
    const auto f = [&](const OperatingPoint& p) -> VectorXd { return plant_.evaluate(p).head(n_ + nz_); };
    E.bottomRows(n_ + nz_) = differentiate_all(f, num_x(), num_x() + num_m());
    return E;
  }
  /// [S_x S_m]: num_m x (num_x + num_m).
  MatrixXd calc_sample() const {
    const auto f = [&](const OperatingPoint& p) -> VectorXd { return plant_.sample(p)(plant_.sampled_rows()); };
    return differentiate_all(f, 0, num_x() + num_m());
  }

 private:
  Plant& plant_;
  OperatingPoint point_;
  int n_, nz_;
};

}  // namespace

records::Multipliers calc_multipliers(Plant& plant, const OperatingPoint& point, const MatrixXd& A,
                                      const SourceLocation& at, Diagnostics& diagnostics) {
  records::Multipliers out;
  if (plant.sampled_rows().empty()) return out;
  std::vector<double> cycles;
  for (const auto& [period, queue] : plant.list_cycles()) cycles.push_back(period * queue);
  const double period = find_common(cycles);
  if (period == 0) {
    diagnostics.warning("linear.no-common-period", at,
                        "the sample times have no period in common: there are no multipliers of the closed loops",
                        "choose sample times that are simple multiples of each other");
    return out;
  }
  Departures departures(plant, point);
  const int nx = departures.num_x(), nm = departures.num_m();
  BOUGH_DEMAND(A.rows() == nx);
  MatrixXd flow = MatrixXd::Zero(nx + nm, nx + nm);
  flow.topLeftCorner(nx, nx) = A;
  flow.topRightCorner(nx, nm) = departures.calc_held();
  // Numbers of samples count from the start, and the queues are full a whole number of periods later.
  const double start = plant.make_initial_point().t;
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
  std::vector<std::string> names;
  for (const char* suffix : {"", "_dot"})
    for (int i = 0; i < plant.num_freedoms(); ++i) names.push_back(plant.freedom_name(i) + suffix);
  for (int i = 0; i < plant.num_states(); ++i) names.push_back(plant.state_name(i));
  for (int i = 0; i < nm; ++i) names.push_back(plant.sampled_name(i));
  const auto values = statespace::calc_poles(map, names);
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
