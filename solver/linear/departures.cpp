#include "solver/linear/departures.hpp"

#include <algorithm>
#include <cmath>

#include "solver/linear/difference.hpp"

namespace bough::solver {
namespace {

constexpr int kMostSamples = 1000;

}  // namespace

double find_common_period(const std::vector<double>& cycles) {
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

std::vector<double> list_instants(const std::vector<SampleTimes>& samples, double from, double period) {
  std::vector<double> instants;
  for (const auto& s : samples) {
    const double first = s.first - from;
    for (long k = -std::lround(std::floor(first / s.period)) - 1;; ++k) {
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

Departures::Departures(Plant& plant, const OperatingPoint& point)
    : plant_(plant), point_(point), n_(plant.num_freedoms()), nz_(plant.num_states()) {
  if (plant.sampled_rows().empty()) return;
  // A law that has seen no sample yet takes its first one otherwise than all that follow, as a difference does.
  const OperatingPoint start = plant.make_initial_point();
  if (point.t != start.t || point.memory != start.memory) return;
  point_.memory = plant.resample(point);
  plant.fill_queues(point_.memory);
}

std::vector<std::string> Departures::list_names() const {
  std::vector<std::string> names;
  for (const char* suffix : {"", "_dot"})
    for (int i = 0; i < n_; ++i) names.push_back(plant_.freedom_name(i) + suffix);
  for (int i = 0; i < nz_; ++i) names.push_back(plant_.state_name(i));
  for (int i = 0; i < num_m(); ++i) names.push_back(plant_.sampled_name(i));
  return names;
}

OperatingPoint Departures::move(int j, double h) const {
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

double Departures::step(int j) const {
  if (j < 2 * n_) return plant_.step(j % n_);
  if (j < num_x()) return 0.1 * std::max(1.0, std::abs(point_.z[plant_.state_row(j - 2 * n_)]));
  return 0.1 * std::max(1.0, std::abs(point_.memory[plant_.sampled_rows()[static_cast<size_t>(j - num_x())]]));
}

MatrixXd Departures::differentiate_all(const std::function<VectorXd(const OperatingPoint&)>& f, int first,
                                       int last) const {
  MatrixXd value;
  for (int j = first; j < last; ++j) {
    const Difference column = differentiate([&](double h) { return f(move(j, h)); }, step(j));
    if (j == first) value.resize(column.value.size(), last - first);
    value.col(j - first) = (column.value.array().abs() > column.error.array()).select(column.value, 0.0);
  }
  return value;
}

MatrixXd Departures::calc_held() const {
  MatrixXd E = MatrixXd::Zero(num_x(), num_m());
  const auto f = [&](const OperatingPoint& p) -> VectorXd { return plant_.evaluate(p).head(n_ + nz_); };
  E.bottomRows(n_ + nz_) = differentiate_all(f, num_x(), num_x() + num_m());
  return E;
}

MatrixXd Departures::calc_sample() const {
  const auto f = [&](const OperatingPoint& p) -> VectorXd { return plant_.sample(p)(plant_.sampled_rows()); };
  return differentiate_all(f, 0, num_x() + num_m());
}

}  // namespace bough::solver
