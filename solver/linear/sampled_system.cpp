#include "solver/linear/sampled_system.hpp"

#include <algorithm>
#include <cmath>

#include "solver/system/law_difference.hpp"

namespace bough::solver {
namespace {

constexpr int kMaxSamples = 1000;

void add_kinks(const std::vector<LawKink>& some, std::vector<LawKink>& all) {
  for (const LawKink& kink : some) {
    const auto is_same = [&](const LawKink& k) { return k.label == kink.label && k.at == kink.at; };
    if (std::none_of(all.begin(), all.end(), is_same)) all.push_back(kink);
  }
}

}  // namespace

double find_common_period(const std::vector<double>& cycles) {
  const double longest = *std::max_element(cycles.begin(), cycles.end());
  for (int k = 1; k <= kMaxSamples; ++k) {
    const double period = k * longest;
    if (std::all_of(cycles.begin(), cycles.end(), [&](double cycle) {
          const double times = period / cycle;
          return times < kMaxSamples && std::abs(times - std::round(times)) < 1e-9 * times;
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
  const auto is_same = [&](double a, double b) { return std::abs(a - b) < 1e-9 * period / kMaxSamples; };
  instants.erase(std::unique(instants.begin(), instants.end(), is_same), instants.end());
  return instants;
}

SampledSystem::SampledSystem(Plant& plant, const OperatingPoint& point)
    : plant_(plant), point_(point), n_(plant.num_dofs()), nz_(plant.num_states()) {
  if (plant.sampled_rows().empty()) return;
  // Samples that the start leaves on their way have arrived in all periods that follow.
  const OperatingPoint start = plant.make_initial_point();
  if (point.t != start.t || point.memory != start.memory) return;
  point_.memory(plant.sampled_rows()) = plant.get_initial_state().memory(plant.sampled_rows());
  point_.memory = plant.sample_all(point_);
  plant.fill_queues(point_.memory);
}

std::vector<std::string> SampledSystem::list_names() const {
  std::vector<std::string> names;
  for (const char* suffix : {"", "_dot"})
    for (int i = 0; i < n_; ++i) names.push_back(plant_.dof_name(i) + suffix);
  for (int i = 0; i < nz_; ++i) names.push_back(plant_.state_name(i));
  for (int i = 0; i < num_m(); ++i) names.push_back(plant_.sampled_name(i));
  return names;
}

void Uncertainty::add(const Jacobian& jacobian, const VectorXd& scale) {
  for (Eigen::Index i = 0; i < scale.size() && jacobian.value.cols() > 0; ++i) {
    if (!(scale[i] > 0)) continue;
    for (const MatrixXd* m : {&jacobian.error, &jacobian.kink})
      relative = std::max(relative, m->row(i).cwiseAbs().maxCoeff() / scale[i]);
  }
  add_kinks(jacobian.kinks, kinks);
}

void Uncertainty::add(const Uncertainty& other) {
  relative = std::max(relative, other.relative);
  add_kinks(other.kinks, kinks);
}

VectorXd calc_row_scales(const MatrixXd& value) {
  if (value.cols() == 0) return VectorXd::Zero(value.rows());
  return value.rowwise().lpNorm<Eigen::Infinity>();
}

OperatingPoint displace_by_column(const Plant& plant, const OperatingPoint& point, int j, double h) {
  const int n = plant.num_dofs(), nx = 2 * n + plant.num_states();
  OperatingPoint moved = point;
  if (j < n)
    moved.q = plant.displace(point.q, h * VectorXd::Unit(n, j));
  else if (j < 2 * n)
    moved.u[j - n] += h;
  else if (j < nx)
    plant.move_state(moved, j - 2 * n, h);
  else
    moved.memory[plant.sampled_rows()[static_cast<size_t>(j - nx)]] += h;
  return moved;
}

double choose_displacement(const Plant& plant, int i) {
  return plant.dof_dims(i) == "L" ? std::max(plant.step(i), calc_far_step(plant.data().tree)) : plant.step(i);
}

double choose_step(const Plant& plant, const OperatingPoint& point, int j) {
  const int n = plant.num_dofs(), nx = 2 * n + plant.num_states();
  if (j < n) return choose_displacement(plant, j);
  // The equations are quadratic in u: any step that is not lost in roundoff gives the same.
  if (j < 2 * n) return plant.step(j - n) * std::max(1.0, point.u.cwiseAbs().maxCoeff());
  if (j < nx) return plant.state_step(point, j - 2 * n);
  return 0.1 * std::max(1.0, std::abs(point.memory[plant.sampled_rows()[static_cast<size_t>(j - nx)]]));
}

Jacobian differentiate_column(Plant& plant, const std::function<VectorXd(double)>& f, double step) {
  Jacobian column;
  const Difference d = plant.differentiate(f, step, &column.kinks);
  column.value = d.calc_clean();
  column.error = d.error;
  column.kink = d.kink;
  return column;
}

Jacobian differentiate_columns(Plant& plant, const OperatingPoint& point,
                               const std::function<VectorXd(const OperatingPoint&)>& f, int first, int last,
                               double factor) {
  Jacobian all;
  for (int j = first; j < last; ++j) {
    const Jacobian column = differentiate_column(
        plant, [&](double h) { return f(displace_by_column(plant, point, j, h)); },
        factor * choose_step(plant, point, j));
    if (j == first)
      for (MatrixXd* m : {&all.value, &all.error, &all.kink}) m->setZero(column.value.rows(), last - first);
    all.value.col(j - first) = column.value;
    all.error.col(j - first) = column.error;
    all.kink.col(j - first) = column.kink;
    add_kinks(column.kinks, all.kinks);
  }
  return all;
}

MatrixXd SampledSystem::differentiate_all(const std::function<VectorXd(const OperatingPoint&)>& f, int first,
                                          int last) {
  const Jacobian jacobian = differentiate_columns(plant_, point_, f, first, last);
  uncertainty_.add(jacobian, calc_row_scales(jacobian.value));
  return jacobian.value;
}

VectorXd SampledSystem::differentiate_one(const std::function<VectorXd(double)>& f, double step) {
  const Jacobian column = differentiate_column(plant_, f, step);
  uncertainty_.add(column, calc_row_scales(column.value));
  return column.value;
}

MatrixXd SampledSystem::calc_held() {
  MatrixXd E = MatrixXd::Zero(num_x(), num_m());
  const auto f = [&](const OperatingPoint& p) -> VectorXd { return plant_.evaluate(p).head(n_ + nz_); };
  E.bottomRows(n_ + nz_) = differentiate_all(f, num_x(), num_x() + num_m());
  return E;
}

MatrixXd SampledSystem::calc_sample() {
  const auto f = [&](const OperatingPoint& p) -> VectorXd { return plant_.sample(p)(plant_.sampled_rows()); };
  return differentiate_all(f, 0, num_x() + num_m());
}

}  // namespace bough::solver
