#include "solver/simulate/energy_monitor.hpp"

#include <cmath>
#include <limits>

namespace bough::solver {

void EnergyMonitor::add(double t, const Energies& e, double work, double resolution) {
  for (const double part : {e.kinetic, e.strain, e.potential - potential_, work})
    scale_ = std::max(scale_, std::abs(part));
  latest_ = e.kinetic + e.strain + e.potential - work - start_;
  // Round-off of the sum itself is no error of the motion.
  const double rounding = 8 * std::numeric_limits<double>::epsilon() *
                          (std::abs(e.kinetic) + std::abs(e.strain) + std::abs(e.potential) + std::abs(work) +
                           std::abs(potential_) + resolution);
  if (std::abs(latest_) - rounding <= worst_) return;
  worst_ = std::abs(latest_) - rounding;
  time_ = t;
}

void EnergyMonitor::add_energy_input(const Energies& e, double work, double dissipated) {
  // Strain energy below zero is that of a buckled body, whose fall feeds its motion.
  energy_input_ = std::max({energy_input_, std::abs(start_ - potential_), std::abs(e.potential - potential_), -e.strain,
                            std::abs(work + dissipated)});
}

void EnergyMonitor::get_memory(Eigen::Ref<Eigen::VectorXd> memory) const {
  memory << start_, potential_, noise_, scale_, latest_, worst_, time_, energy_input_;
}

void EnergyMonitor::set_memory(const Eigen::VectorXd& m) {
  start_ = m[0];
  potential_ = m[1];
  noise_ = m[2];
  scale_ = m[3];
  latest_ = m[4];
  worst_ = m[5];
  time_ = m[6];
  energy_input_ = m[7];
}

}  // namespace bough::solver
