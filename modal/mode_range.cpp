#include "modal/mode_range.hpp"
#include "modal/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bough::modal::detail {

double calc_lambda(double hz) { return std::pow(2 * std::numbers::pi * hz, 2); }

double calc_lower(const EigenOptions& options) {
  return (1 - kRangeEnd) * calc_lambda(std::max(options.min_hz.value_or(0), 0.0));
}

double calc_upper(const EigenOptions& options) {
  if (!options.max_hz) return std::numeric_limits<double>::infinity();
  return (1 + kRangeEnd) * calc_lambda(std::max(*options.max_hz, 0.0));
}

bool ModeRange::fit(const EigenOptions& options, const VectorXd& lambda, int cut, int available) {
  if (!options.min_hz && !options.max_hz) return false;
  const auto count_below = [&](double bound) {
    const auto below = static_cast<int>((lambda.head(cut).array() < bound).count());
    // The root after the complete ones is below too: there may be more of them.
    const bool goes_on = below == cut && cut < std::min<Eigen::Index>(available, lambda.size()) && lambda(cut) < bound;
    return goes_on ? 2 * cut + 8 : below;
  };
  first = options.min_hz ? count_below(calc_lower(options)) : 0;
  last = options.num_modes > 0 ? first + options.num_modes : available;
  if (options.max_hz) last = std::min(last, count_below(calc_upper(options)));
  last = std::max(first, std::min(last, available));
  return last > cut;
}

}  // namespace bough::modal::detail
