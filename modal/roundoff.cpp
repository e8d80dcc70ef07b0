#include "modal/roundoff.hpp"
#include "modal/tolerances.hpp"

#include <algorithm>
#include <cmath>

#include "base/diagnostic.hpp"

namespace bough::modal::detail {

double calc_cluster_tolerance(const Pencil& pencil, const VectorXd& x, double lambda) {
  return std::clamp(kRoundoffBound * kEpsilon / std::max(std::abs(pencil.calc_relative_energy(x, lambda)), kTiny),
                    kCloseness, kMaxCloseness);
}

double calc_roundoff(double energy_share) { return kRoundoffSeen * kEpsilon / std::max(energy_share, kTiny); }

double calc_roundoff(const Pencil& pencil, const VectorXd& x, double lambda) {
  return calc_roundoff(pencil.calc_relative_energy(x, lambda));
}

void warn_of_roundoff(const Pencil& pencil, const VectorXd& lambda, const MatrixXd& X, int num_rigid,
                      Diagnostics& diagnostics) {
  for (int j = num_rigid; j < lambda.size(); ++j) {
    const double error = calc_roundoff(pencil, X.col(j), lambda(j));
    if (error < kRoundoffWarning) return;
    diagnostics.warning("modal.roundoff", {},
                        "mode " + std::to_string(j + 1) + " is so soft on its mesh that roundoff may change its " +
                            "eigenvalue by a part in " + std::to_string(static_cast<long>(std::max(1.0, 1 / error))),
                        "use a coarser mesh: elements far shorter than the waves of the modes only add roundoff");
  }
}

int count_zeros(const Pencil& pencil, const Roots& found) {
  const auto energy = [&](int k) { return pencil.calc_relative_energy(found.X.col(k), found.value(k)); };
  int low = 0;
  while (low < found.size() && energy(low) < kStrainedEnergy) ++low;
  for (int k = low; k > 0; --k)
    if (k < found.size() ? std::abs(found.value(k - 1)) < kZeroRatio * found.value(k) : energy(k - 1) < kZeroEnergy)
      return k;
  return 0;
}

}  // namespace bough::modal::detail
