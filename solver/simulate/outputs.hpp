#pragma once
/// \file Recorded results of a run: the channels of the results file (docs/formats) and one sample of them.
#include "formats/records/results.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

class Outputs {
 public:
  /// Channels, their order fixed here once: /time; per body position, quaternion, velocity, angular_velocity, and eta,
  /// eta_dot when it has modes, recovery; per hinge q, qdot, force when it has coordinates, reaction_force,
  /// reaction_moment; per constraint its reactions; elements of force; sensors, controllers, actuators, functions that
  /// are signals; energy; momentum; system_mass.
  explicit Outputs(const System& system);

  /// Channels of calc_sample.
  const std::vector<records::Channel>& channels() const { return channels_; }
  /// Index in the sample of component `component` (from 0) of the channel, -1 when there is none such.
  int find(const std::string& path, int component) const;
  /// The sample at t from `data` after calc_signals; q, u as given to calc_kinematics. A quaternion has the sign
  /// that is nearer to the one kept last. No allocation.
  const VectorXd& calc_sample(double t, const SystemData& data, const Eigen::Ref<const VectorXd>& q,
                              const Eigen::Ref<const VectorXd>& u, double work, double dissipated);
  /// The last sample of calc_sample.
  const VectorXd& sample() const { return sample_; }
  /// Energies of the last sample.
  const Energies& energies() const { return energies_; }

  /// Leaves of calc_sample what `groups` name ("bodies", "hinges/root", ...; empty: all), and /time, for the file.
  /// Reports "run.unknown-group".
  void choose(const std::vector<std::string>& groups, const SourceLocation& where, Diagnostics& diagnostics);
  const std::vector<records::Channel>& chosen_channels() const { return chosen_; }
  /// The chosen channels of the last sample, whose quaternions are kept. No allocation.
  const VectorXd& keep_sample();

  /// The quaternions kept, for a checkpoint: 4 per body, zero before the first.
  VectorXd quaternions;

 private:
  void add_recovery(const std::string& path, int body);
  void add_channel(std::string path, int size, std::string description, std::string dims);

  const System& system_;
  std::vector<records::Channel> channels_, chosen_;
  std::vector<std::pair<int, int>> ranges_;  ///< first and size in sample_ of what is chosen
  std::vector<int> quaternion_at_;
  std::vector<std::vector<int>> element_sizes_;  ///< of the channels of each element of force
  VectorXd sample_, kept_;
  Energies energies_;
};

}  // namespace bough::solver
