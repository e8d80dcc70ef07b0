#include "modal/roundoff.hpp"

#include <algorithm>
#include <cmath>

#include "base/diagnostic.hpp"

namespace bough::modal::detail {

double calc_cluster_tolerance(const Pencil& pencil, const VectorXd& x, double lambda) {
  return std::clamp(20 * 2.2e-16 / std::max(std::abs(pencil.calc_relative_energy(x, lambda)), 1e-300), 1e-8, 1e-4);
}

double calc_roundoff(double energy_share) { return 0.02 * 2.2e-16 / std::max(energy_share, 1e-300); }

double calc_roundoff(const Pencil& pencil, const VectorXd& x, double lambda) {
  return calc_roundoff(pencil.calc_relative_energy(x, lambda));
}

void warn_of_roundoff(const Pencil& pencil, const VectorXd& lambda, const MatrixXd& X, int num_rigid,
                      Diagnostics& diagnostics) {
  for (int j = num_rigid; j < lambda.size(); ++j) {
    const double error = calc_roundoff(pencil, X.col(j), lambda(j));
    if (error < 1e-4) return;
    diagnostics.warning("modal.roundoff", {},
                        "mode " + std::to_string(j + 1) + " is so soft on its mesh that roundoff may change its " +
                            "eigenvalue by a part in " + std::to_string(static_cast<long>(std::max(1.0, 1 / error))),
                        "use a coarser mesh: elements far shorter than the waves of the modes only add roundoff");
  }
}

int count_zeros(const Pencil& pencil, const Roots& found) {
  const auto energy = [&](int k) { return pencil.calc_relative_energy(found.X.col(k), found.value(k)); };
  int low = 0;
  while (low < found.size() && energy(low) < 1e-12) ++low;
  for (int k = low; k > 0; --k)
    if (k < found.size() ? std::abs(found.value(k - 1)) < 1e-3 * found.value(k) : energy(k - 1) < 1e-14) return k;
  return 0;
}

}  // namespace bough::modal::detail
