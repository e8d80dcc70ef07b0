#pragma once
/// \file The energy balance of a run: kinetic + strain + potential - work is constant.
#include <algorithm>

#include "solver/system/system.hpp"

namespace bough::solver {

/// The error is relative to the largest of kinetic energy, strain energy, change of the potential energy and work so
/// far: where the inertial origin lies does not enter. A breach of the balance that is later made good stays on record.
class EnergyMonitor {
 public:
  /// `noise`: energy below which nothing is reported, that of motions as small as the absolute tolerance.
  void start(const Energies& e, double noise) {
    start_ = e.kinetic + e.strain + e.potential;
    potential_ = e.potential;
    noise_ = noise;
  }
  /// `flow`: what forces would do along the size of the system; motions are known to that times rounding.
  void add(double t, const Energies& e, double work, double resolution);

  /// The largest energy so far: what the balance is measured by, without the noise.
  double size() const { return std::max(scale_, std::abs(start_ - potential_)); }
  /// Error at the last moment added, with its sign; relative.
  double latest() const { return latest_ / scale(); }
  /// The largest of all moments added, without sign; relative.
  double worst() const { return worst_ / scale(); }
  /// Time [T] of the largest error.
  double time_of_worst() const { return time_; }
  /// Upper bound of the energy put into the motion: the largest so far of the initial kinetic and strain energy, of the
  /// change of the potential energy and of the work without dampers. Kinetic energy far above it is an error.
  double energy_input() const { return std::max(energy_input_, noise_); }
  /// Adds the energies of a moment; strain energy below zero, that of a buckled body, counts by its magnitude.
  void add_energy_input(const Energies& e, double work, double dissipated);
  /// Adds an energy, as that of an impact.
  void add_energy_input(double energy) { energy_input_ = std::max(energy_input_, energy); }

  /// Writes the numbers of a checkpoint; memory: kMemory.
  void get_memory(Eigen::Ref<Eigen::VectorXd> memory) const;
  /// Restores the numbers of get_memory().
  void set_memory(const Eigen::VectorXd& memory);
  static constexpr int kMemory = 8;

 private:
  double scale() const { return std::max(scale_, noise_) > 0 ? std::max(scale_, noise_) : 1; }

  double start_ = 0, potential_ = 0, noise_ = 0;
  double scale_ = 0, latest_ = 0, worst_ = 0, time_ = 0, energy_input_ = 0;
};

}  // namespace bough::solver
