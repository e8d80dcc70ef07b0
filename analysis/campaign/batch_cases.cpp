#include "analysis/campaign/batch_cases.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace bough::analysis {

using toml_files::CampaignMethod;
using toml_files::CampaignParameter;
using toml_files::Setting;

namespace {

/// The value at a part `u` of 0 to 1 of the parameter's range or list.
Setting pick(const CampaignParameter& p, double u) {
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

}  // namespace

std::vector<BatchCase> make_cases(const toml_files::CampaignSpec& spec) {
  std::vector<BatchCase> cases;
  if (spec.method == CampaignMethod::LatinHypercube) {
    cases = make_hypercube(spec);
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
