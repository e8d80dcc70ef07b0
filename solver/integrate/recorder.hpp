#pragma once
/// \file What a run records: the channels of the results file (docs/formats) and one sample of them.
#include "formats/records/results.hpp"
#include "solver/sensors/sensor.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

class Recorder {
 public:
  /// Channels, their order fixed here once: /time; per body position, quaternion, velocity, angular_velocity, and eta,
  /// eta_dot when it has modes; per hinge q, qdot, force when it has coordinates, reaction_force, reaction_moment;
  /// sensors; energy; momentum; system_mass.
  Recorder(const System& system, Sensors sensors);

  const std::vector<records::Channel>& channels() const { return channels_; }
  /// The sample at t from `data` after calc_accelerations; q, u as given to calc_kinematics. No allocation.
  const VectorXd& calc_sample(double t, const SystemData& data, const Eigen::Ref<const VectorXd>& q,
                              const Eigen::Ref<const VectorXd>& u, double work);
  /// Of the last sample.
  const Energies& energies() const { return energies_; }

 private:
  void add_channel(std::string path, int size, std::string description, std::string dims);

  const System& system_;
  Sensors sensors_;
  std::vector<records::Channel> channels_;
  VectorXd sample_;
  Energies energies_;
};

}  // namespace bough::solver
