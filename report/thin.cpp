#include "report/thin.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bough::report {

std::vector<Eigen::Index> split_samples(const Eigen::VectorXd& x, Eigen::Index parts) {
  const Eigen::Index n = x.size();
  std::vector<Eigen::Index> ends{0};
  const double span = n > 0 ? x[n - 1] - x[0] : 0;
  const bool is_ascending = n > 1 && x.allFinite() && std::isfinite(span) && span > 0 &&
                            (x.tail(n - 1).array() >= x.head(n - 1).array()).all();
  const auto find_part = [&](Eigen::Index i) {
    const double share = is_ascending ? (x[i] - x[0]) / span : static_cast<double>(i) / static_cast<double>(n);
    return std::min(parts - 1, static_cast<Eigen::Index>(share * static_cast<double>(parts)));
  };
  for (Eigen::Index i = 1; i < n; ++i)
    if (find_part(i) != find_part(i - 1)) ends.push_back(i);
  if (n > 0) ends.push_back(n);
  return ends;
}

std::vector<Eigen::Index> choose_extremes(const Eigen::Ref<const Eigen::VectorXd>& values, Eigen::Index length) {
  const Eigen::Index n = values.size();
  std::vector<Eigen::Index> chosen;
  const auto add = [&](Eigen::Index i) {
    if (i >= 0 && (chosen.empty() || chosen.back() < i)) chosen.push_back(i);
  };
  if (n > 0) add(0);
  for (Eigen::Index from = 0; from < n; from += length) {
    Eigen::Index low = -1, high = -1, gap = -1;
    for (Eigen::Index i = from; i < std::min(n, from + length); ++i) {
      if (!std::isfinite(values[i])) {
        if (gap < 0) gap = i;
        continue;
      }
      if (low < 0 || values[i] < values[low]) low = i;
      if (high < 0 || values[i] > values[high]) high = i;
    }
    std::array<Eigen::Index, 3> found{low, high, gap};
    std::sort(found.begin(), found.end());
    for (const auto i : found) add(i);
  }
  add(n - 1);
  return chosen;
}

}  // namespace bough::report
