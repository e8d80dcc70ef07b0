#include "analysis/campaign/batch_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/campaign/normal_distribution.hpp"

namespace bough::analysis {

double calc_quantile(const std::vector<double>& sorted, double p) {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), sorted.size() - 1);
  const std::size_t next = std::min(i + 1, sorted.size() - 1);
  return sorted[i] + (place - static_cast<double>(i)) * (sorted[next] - sorted[i]);
}

std::vector<Statistics> calc_statistics(const hdf5::OutcomeTable& table, const std::vector<double>& percentiles,
                                        double confidence) {
  const std::string folder = "/outputs/";
  std::vector<Statistics> all;
  for (const auto& column : table.columns) {
    if (!column.path.starts_with(folder)) continue;
    for (Eigen::Index k = 0; k < column.numbers.cols(); ++k) {
      std::vector<double> values;
      for (const double x : column.numbers.col(k))
        if (std::isfinite(x)) values.push_back(x);
      if (values.empty()) continue;
      std::sort(values.begin(), values.end());
      Statistics s;
      s.name = column.path.substr(folder.size()) + (column.numbers.cols() > 1 ? "." + std::to_string(k + 1) : "");
      s.count = static_cast<int>(values.size());
      s.mean = std::accumulate(values.begin(), values.end(), 0.0) / s.count;
      double sum = 0;
      for (const double x : values) sum += (x - s.mean) * (x - s.mean);
      s.deviation = s.count > 1 ? std::sqrt(sum / (s.count - 1)) : std::numeric_limits<double>::quiet_NaN();
      s.min = values.front();
      s.p5 = calc_quantile(values, 0.05);
      s.median = calc_quantile(values, 0.5);
      s.p95 = calc_quantile(values, 0.95);
      s.max = values.back();
      for (const double percent : percentiles) {
        const auto bounds = calc_quantile_bounds(values, percent / 100, confidence / 100);
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        s.percentiles.push_back({percent, calc_quantile(values, percent / 100), bounds.lower.value_or(kNone),
                                 bounds.upper.value_or(kNone)});
      }
      all.push_back(s);
    }
  }
  return all;
}

}  // namespace bough::analysis
