#include "analysis/campaign/batch_cases.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <Eigen/Dense>

#include "analysis/campaign/normal_distribution.hpp"
#include "base/diagnostic.hpp"

namespace bough::analysis {

using toml_files::CampaignMethod;
using toml_files::CampaignParameter;
using toml_files::Setting;

namespace {

/// Correlations with smaller eigenvalues have no factor to ten digits.
constexpr double kMinEigenvalue = 1e-10;

/// Quantile u of the normal distribution, truncated to the range if there is one. A range above the mean is reflected:
/// probabilities near 1 have no digits.
double pick_normal(const CampaignParameter& p, double u) {
  if (!p.low) return *p.mean + p.deviation * calc_normal_quantile(u);
  const double sign = *p.low > *p.mean ? -1 : 1;
  const double low = calc_normal_probability(sign * (*p.low - *p.mean) / p.deviation);
  const double high = calc_normal_probability(sign * (*p.high - *p.mean) / p.deviation);
  const double value = *p.mean + sign * p.deviation * calc_normal_quantile(low + u * (high - low));
  return std::clamp(value, *p.low, *p.high);
}

/// Quantile u of the distribution of the parameter, 0 <= u < 1.
Setting pick(const CampaignParameter& p, double u) {
  if (p.mean) {
    double value = pick_normal(p, u);
    if (p.is_integer) value = std::round(value);
    if (p.is_integer && p.low) value = std::clamp(value, std::ceil(*p.low), std::floor(*p.high));
    return toml_files::make_setting(value, p.is_integer);
  }
  if (!p.probabilities.empty()) {
    double sum = 0, before = 0;
    for (const double share : p.probabilities) sum += share;
    std::size_t last = 0;
    for (std::size_t i = 0; i < p.values.size(); ++i) {
      if (p.probabilities[i] > 0) last = i;
      before += p.probabilities[i];
      if (u * sum < before) return p.values[last];
    }
    return p.values[last];
  }
  if (!p.low) {
    const auto n = p.values.size();
    return p.values[std::min(n - 1, static_cast<std::size_t>(u * static_cast<double>(n)))];
  }
  if (p.is_integer) {  // every whole number has an equal share
    const double first = std::ceil(*p.low), last = std::floor(*p.high);
    return toml_files::make_setting(std::min(last, first + std::floor(u * (last - first + 1))), true);
  }
  const double value = p.is_log ? *p.low * std::pow(*p.high / *p.low, u) : *p.low + u * (*p.high - *p.low);
  return toml_files::make_setting(std::clamp(value, *p.low, *p.high), false);
}

std::vector<Setting> list_values(const CampaignParameter& p) {
  if (!p.low) return p.values;
  std::vector<Setting> values;
  for (int k = 0; k < p.number; ++k) {
    const double u = p.number == 1 ? 0 : static_cast<double>(k) / (p.number - 1);
    double value = k == 0              ? *p.low
                   : k == p.number - 1 ? *p.high
                   : p.is_log          ? *p.low * std::pow(*p.high / *p.low, u)
                                       : *p.low + u * (*p.high - *p.low);
    values.push_back(toml_files::make_setting(p.is_integer ? std::round(value) : value, p.is_integer));
  }
  return values;
}

/// The library's distributions differ between compilers; the generator itself does not.
class Dice {
 public:
  explicit Dice(unsigned long seed) : generator_(seed) {}
  /// 0 <= u < 1
  double roll() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }
  std::size_t roll(std::size_t sides) {
    return std::min(sides - 1, static_cast<std::size_t>(roll() * static_cast<double>(sides)));
  }

 private:
  std::mt19937_64 generator_;
};

std::vector<BatchCase> make_hypercube(const toml_files::CampaignSpec& spec) {
  const auto n = static_cast<std::size_t>(spec.samples);
  std::vector<BatchCase> cases(n);
  Dice dice(spec.seed);
  std::vector<std::size_t> bins(n);
  for (const auto& p : spec.parameters) {
    std::iota(bins.begin(), bins.end(), 0u);
    for (std::size_t i = n - 1; i > 0; --i) std::swap(bins[i], bins[dice.roll(i + 1)]);
    for (std::size_t i = 0; i < n; ++i)
      cases[i].values.push_back(pick(p, (static_cast<double>(bins[i]) + dice.roll()) / static_cast<double>(n)));
  }
  return cases;
}

/// Lower factor L of the correlation of the normal scores, C = L Lᵀ.
Eigen::MatrixXd factor_correlation(const toml_files::CampaignSpec& spec) {
  const auto size = std::ssize(spec.parameters);
  Eigen::MatrixXd C = Eigen::MatrixXd::Identity(size, size);
  for (const auto& one : spec.correlations) {
    const auto a = static_cast<Eigen::Index>(one.a), b = static_cast<Eigen::Index>(one.b);
    C(a, b) = C(b, a) = one.value;
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(C);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(C, Eigen::EigenvaluesOnly);
  if (factor.info() != Eigen::Success || eigen.eigenvalues()[0] < kMinEigenvalue)
    throw InputError("batch.bad-parameter", spec.correlations.front().at,
                     "the matrix of correlations is not positive definite: its smallest eigenvalue is " +
                         std::to_string(eigen.eigenvalues()[0]),
                     "bring the values nearer to 0");
  return factor.matrixL();
}

/// Cases of normal scores L z. Monte Carlo: shares Φ(L z). Latin hypercube: bins by the ranks of each score.
std::vector<BatchCase> make_scored(const toml_files::CampaignSpec& spec, bool is_hypercube) {
  const auto n = static_cast<std::size_t>(spec.samples), m = spec.parameters.size();
  const Eigen::MatrixXd L = factor_correlation(spec);
  Dice dice(spec.seed);
  Eigen::MatrixXd scores(std::ssize(spec.parameters), spec.samples);
  for (Eigen::Index k = 0; k < scores.size(); ++k)
    scores.data()[k] = calc_normal_quantile(std::max(dice.roll(), 0x1p-54));
  scores = (L * scores).eval();
  std::vector<BatchCase> cases(n);
  std::vector<std::size_t> order(n);
  for (std::size_t j = 0; j < m; ++j) {
    const Eigen::RowVectorXd row = scores.row(static_cast<Eigen::Index>(j));
    std::vector<double> share(n);
    for (std::size_t i = 0; i < n; ++i) share[i] = calc_normal_probability(row[static_cast<Eigen::Index>(i)]);
    if (is_hypercube) {
      std::iota(order.begin(), order.end(), 0u);
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return share[a] < share[b]; });
      for (std::size_t bin = 0; bin < n; ++bin)
        share[order[bin]] = (static_cast<double>(bin) + dice.roll()) / static_cast<double>(n);
    }
    for (std::size_t i = 0; i < n; ++i) cases[i].values.push_back(pick(spec.parameters[j], share[i]));
  }
  return cases;
}

}  // namespace

std::vector<BatchCase> make_cases(const toml_files::CampaignSpec& spec) {
  std::vector<BatchCase> cases;
  if (spec.method == CampaignMethod::MonteCarlo) {
    cases = make_scored(spec, false);
  } else if (spec.method == CampaignMethod::LatinHypercube) {
    cases = spec.correlations.empty() ? make_hypercube(spec) : make_scored(spec, true);
  } else if (spec.method == CampaignMethod::List) {
    cases.resize(spec.parameters.front().values.size());
    for (std::size_t i = 0; i < cases.size(); ++i)
      for (const auto& p : spec.parameters) cases[i].values.push_back(p.values[i]);
  } else {
    cases.resize(1);
    for (const auto& p : spec.parameters) {
      const auto values = list_values(p);
      std::vector<BatchCase> longer;
      for (const auto& one : cases)
        for (const auto& value : values) {
          longer.push_back(one);
          longer.back().values.push_back(value);
        }
      cases = std::move(longer);
    }
  }
  for (std::size_t i = 0; i < cases.size(); ++i) cases[i].number = static_cast<int>(i) + 1;
  return cases;
}

std::string get_case_folder(int number, int num_cases) {
  const auto width = std::max<std::size_t>(4, std::to_string(num_cases).size());
  const auto digits = std::to_string(number);
  return "case-" + std::string(width - std::min(width, digits.size()), '0') + digits;
}

}  // namespace bough::analysis
