#pragma once
/// \file Recorded results of a run: the channels of the results file (docs/formats) and one sample of them.
#include <span>

#include "formats/records/results.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

/// State of which a sample is taken.
struct SampleState {
  double t;
  const SystemData& data;           ///< evaluated at the state
  Eigen::Ref<const VectorXd> q, u;  ///< as given to calc_kinematics
  double work, dissipated;
};

class Outputs {
 public:
  /// Channels, their order fixed here once: /time; per body position, quaternion, velocity, angular_velocity, and eta,
  /// eta_dot when it has modes, recovery; per hinge q, qdot, force when it has coordinates, reaction_force,
  /// reaction_moment; per constraint its reactions; elements of force; sensors, controllers, actuators, functions that
  /// are signals; energy; momentum; system_mass.
  explicit Outputs(const System& system);
  /// Samples a variant of the system (System::variants) from now on; its channels are equal.
  void set_system(const System& system) { system_ = &system; }

  /// Channels of calc_sample.
  const std::vector<records::Channel>& channels() const { return channels_; }
  /// Index in the sample of component `component` (from 0) of the channel, -1 when there is none such.
  int find(const std::string& path, int component) const;
  /// The sample of a state, after calc_signals. A quaternion has the sign that is nearer to the one kept last. No
  /// allocation.
  const VectorXd& calc_sample(const SampleState& at);
  /// Sample of which these rows alone are up to date. No allocation.
  const VectorXd& calc_rows(std::span<const int> rows, const SampleState& at);
  /// Returns true if a row is known after calc_kinematics and, of a signal, of the block at get_place().
  bool is_of_motion(int row) const;
  /// Index in SignalGraph::places of the block whose output a row is; -1: it is none.
  int get_place(int row) const;
  /// The last sample of calc_sample.
  const VectorXd& sample() const { return sample_; }
  /// Energies of the last sample.
  const Energies& energies() const { return energies_; }

  /// Leaves of calc_sample what `groups` name ("bodies", "hinges/root", ...; empty: all), and /time, for the file.
  /// Reports "run.unknown-group".
  void choose(const std::vector<std::string>& groups, const SourceLocation& where, Diagnostics& diagnostics);
  /// Channels of the file, time first.
  const std::vector<records::Channel>& chosen_channels() const { return chosen_; }
  /// The chosen channels of the last sample, whose quaternions are kept. No allocation.
  const VectorXd& keep_sample();

  /// The quaternions kept, for a checkpoint: 4 per body, zero before the first.
  VectorXd quaternions;

 private:
  void add_recovery(const std::string& path, int body);
  void add_channel(std::string path, int size, std::string description, std::string dims);

  /// Rows of the sample that are computed together.
  enum class Group { Time, Body, Recovery, Hinge, Reaction, Constraint, Element, Signal, Tank, Energy, Momentum, Mass };
  struct Part {
    Group group;
    int index, first, size;
    int num_of_motion;  ///< the first of them, known without accelerations
  };
  void add_part(Group group, int index, int size, int num_of_motion);
  void divide();
  void calc_part(const Part& part, const SampleState& state);
  void calc_body(int body, int at, const SampleState& state);

  const System* system_;
  std::vector<records::Channel> channels_, chosen_;
  std::vector<std::pair<int, int>> ranges_;  ///< first and size in sample_ of what is chosen
  std::vector<int> quaternion_at_;
  std::vector<Part> parts_;  ///< in the order of the sample
  std::vector<int> part_of_row_;
  VectorXd sample_, kept_;
  Energies energies_;
};

}  // namespace bough::solver
