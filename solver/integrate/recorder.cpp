#include "solver/integrate/recorder.hpp"

namespace bough::solver {

Recorder::Recorder(const System& system, Sensors sensors) : system_(system), sensors_(std::move(sensors)) {
  add_channel("/time", 1, "time", "T");
  for (int b = 0; b < system.num_bodies(); ++b) {
    const std::string path = "/bodies/" + system.body_name(b) + "/";
    add_channel(path + "position", 3, "position of the body origin Bo, in the inertial frame", "L");
    add_channel(path + "quaternion", 4, "orientation of the body frame B in the inertial frame: w, x, y, z", "1");
    add_channel(path + "velocity", 3, "velocity of the body origin Bo, in the inertial frame", "L/T");
    add_channel(path + "angular_velocity", 3, "angular velocity of the body frame B, components in B", "1/T");
    if (const int n = system.num_modes(b); n > 0) {
      add_channel(path + "eta", n, "modal coordinates", "by normalisation");
      add_channel(path + "eta_dot", n, "rates of the modal coordinates", "by normalisation");
    }
  }
  for (int b = 0; b < system.num_bodies(); ++b) {
    const std::string path = "/hinges/" + system.hinge_name(b) + "/";
    if (system.num_hinge_q(b) > 0) {
      add_channel(path + "q", system.num_hinge_q(b),
                  "hinge coordinates, child relative to parent; quaternion as w, x, y, z", "1 or L");
      add_channel(path + "qdot", system.num_hinge_rates(b),
                  "hinge rates; spherical and free: angular velocity of the child's hinge frame in the parent's",
                  "1/T or L/T");
      add_channel(
          path + "force", system.num_hinge_rates(b),
          "generalized hinge force: spring and damper; all that crosses the hinge where it is locked or prescribed",
          "F L or F");
    }
    add_channel(path + "reaction_force", 3,
                "force of the parent on the child at the child's hinge frame, in the hinge axes of the parent", "F");
    add_channel(path + "reaction_moment", 3,
                "moment of the parent on the child about the child's hinge frame, in the hinge axes of the parent",
                "F L");
  }
  for (const auto& entry : sensors_.entries())
    add_channel("/sensors/" + entry.name, entry.size, entry.description, entry.dims);
  add_channel("/energy/kinetic", 1, "kinetic energy", "F L");
  add_channel("/energy/strain", 1, "strain energy of the modes and the hinge springs", "F L");
  add_channel("/energy/potential", 1, "potential energy of gravity", "F L");
  add_channel("/energy/work", 1, "work done since the start by applied forces, dampers and prescribed motions", "F L");
  add_channel("/momentum/linear", 3, "linear momentum, in the inertial frame", "M L/T");
  add_channel("/momentum/angular", 3, "angular momentum about the inertial origin, in the inertial frame", "M L^2/T");
  add_channel("/system_mass/mass", 1, "mass of the system", "M");
  add_channel("/system_mass/cg", 3, "centre of mass of the system, in the inertial frame", "L");
  add_channel("/system_mass/inertia", 9,
              "inertia of the system about its centre of mass, in the inertial frame: three rows", "M L^2");
  int size = 0;
  for (const auto& channel : channels_) size += channel.size;
  sample_.setZero(size);
}

void Recorder::add_channel(std::string path, int size, std::string description, std::string dims) {
  channels_.push_back({std::move(path), size, std::move(description), std::move(dims)});
}

const VectorXd& Recorder::calc_sample(double t, const SystemData& data, const Eigen::Ref<const VectorXd>& q,
                                      const Eigen::Ref<const VectorXd>& u, double work) {
  int at = 0;
  const auto put = [&](const auto& value) {
    sample_.segment(at, value.size()) = value;
    at += static_cast<int>(value.size());
  };
  sample_[at++] = t;
  for (int b = 0; b < system_.num_bodies(); ++b) {
    const BodyState& s = get_body_state(data, b);
    Eigen::Quaterniond q_WB(s.R_WB);
    q_WB.normalize();
    put(s.p_WBo);
    put(Eigen::Vector4d(q_WB.w(), q_WB.x(), q_WB.y(), q_WB.z()));
    put(Vector3d(s.R_WB * s.v_B));
    put(s.w_B);
    put(q.segment(system_.eta_offset(b), system_.num_modes(b)));
    put(u.segment(system_.eta_dot_offset(b), system_.num_modes(b)));
  }
  for (int b = 0; b < system_.num_bodies(); ++b) {
    const int nq = system_.num_hinge_q(b), nu = system_.num_hinge_rates(b);
    if (nq > 0) {
      get_hinge(system_, data, b, sample_.segment(at, nq), sample_.segment(at + nq, nu),
                sample_.segment(at + nq + nu, nu));
      at += nq + 2 * nu;
    }
    const HingeReaction reaction = get_hinge_reaction(system_, data, b);
    put(reaction.force);
    put(reaction.moment);
  }
  sensors_.calc(system_, data, sample_.segment(at, sensors_.size()));
  at += sensors_.size();
  energies_ = calc_energies(system_, data);
  put(Eigen::Vector4d(energies_.kinetic, energies_.strain, energies_.potential, work));
  Vector3d linear, angular;
  calc_momentum(system_, data, linear, angular);
  put(linear);
  put(angular);
  const SystemMass mass = calc_system_mass(system_, data);
  sample_[at++] = mass.mass;
  put(mass.cg_W);
  put(Eigen::Map<const Eigen::Matrix<double, 9, 1>>(mass.inertia_W.data()));  // symmetric
  BOUGH_DEMAND(at == sample_.size());
  return sample_;
}

}  // namespace bough::solver
