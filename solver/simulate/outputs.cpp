#include "solver/simulate/outputs.hpp"

#include <algorithm>

#include "solver/system/system.hpp"
#include "solver/text/names.hpp"
#include "solver/tree/coordinates.hpp"

namespace bough::solver {

Outputs::Outputs(const System& system) : system_(&system) {
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
      add_channel(path + "strain_energy", 1, "strain energy of its modes", "F L");
    }
    add_recovery(path, b);
  }
  for (int b = 0; b < system.num_bodies(); ++b) {
    const std::string path = "/hinges/" + system.hinge_name(b) + "/";
    if (const int nq = system.num_hinge_q(b), nu = system.num_hinge_rates(b); nq > 0) {
      const TreeBody& tb = system.tree[b];
      add_channel(path + "q", nq, "hinge coordinates, child relative to parent; quaternion as w, x, y, z",
                  list_hinge_dims(tb, HingeQuantity::Position, 0, nq));
      add_channel(path + "qdot", nu,
                  "hinge rates; spherical and free: angular velocity of the child's hinge frame in the parent's",
                  list_hinge_dims(tb, HingeQuantity::Rate, 0, nu));
      add_channel(
          path + "force", nu,
          "generalized hinge force: spring and damper; all that crosses the hinge where it is locked or prescribed",
          list_hinge_dims(tb, HingeQuantity::Force, 0, nu));
    }
    add_channel(path + "reaction_force", 3,
                "force of the parent on the child at the child's hinge frame, in the hinge axes of the parent", "F");
    add_channel(path + "reaction_moment", 3,
                "moment of the parent on the child about the child's hinge frame, in the hinge axes of the parent",
                "F L");
  }
  for (int c = 0; c < system.num_constraints(); ++c) {
    const std::string path = "/constraints/" + system.constraint_name(c) + "/";
    if (system.is_coupler(c)) {
      add_channel(path + "force", 1, "generalized force per unit of ratio on the coupled coordinates", "F L or F");
      continue;
    }
    add_channel(path + "reaction_force", 3,
                "force of the parent on the child at the child's frame, in the axes of the parent's", "F");
    add_channel(path + "reaction_moment", 3,
                "moment of the parent on the child about the child's frame, in the axes of the parent's", "F L");
  }
  for (const auto& element : system.elements) {
    for (const ForceChannel& c : element->channels())
      add_channel("/forces/" + element->name() + "/" + c.name, c.size, c.description, c.dims);
  }
  for (const auto& p : system.signals.places)
    add_channel(p.block->path, p.block->sizes.outputs, p.block->description, p.block->dims);
  for (const Tank& tank : system.tree.tanks) {
    add_channel("/tanks/" + tank.name + "/mass", 1, "mass of the propellant", "M");
    add_channel("/tanks/" + tank.name + "/flow", 1, "mass that leaves it per unit of time", "M/T");
  }
  add_channel("/energy/kinetic", 1, "kinetic energy", "F L");
  add_channel("/energy/strain", 1, "strain energy of the modes, of springs and of contacts", "F L");
  add_channel("/energy/potential", 1, "potential energy of gravity", "F L");
  add_channel("/energy/work", 1, "work done since the start by applied forces, dampers and prescribed motions", "F L");
  add_channel("/energy/dissipated", 1, "what dampers took since the start; part of work with its minus", "F L");
  add_channel("/momentum/linear", 3, "linear momentum, in the inertial frame", "M L/T");
  add_channel("/momentum/angular", 3, "angular momentum about the inertial origin, in the inertial frame", "M L^2/T");
  if (system.num_momentum_out() > 0) {
    add_channel("/momentum/out_linear", 3, "linear momentum that left with propellant, in the inertial frame", "M L/T");
    add_channel("/momentum/out_angular", 3,
                "angular momentum about the inertial origin that left with propellant, in the inertial frame",
                "M L^2/T");
  }
  add_channel("/system_mass/mass", 1, "mass of the system", "M");
  add_channel("/system_mass/cg", 3, "centre of mass of the system, in the inertial frame", "L");
  add_channel("/system_mass/inertia", 9,
              "inertia of the system about its centre of mass, in the inertial frame: three rows", "M L^2");
  int size = 0;
  for (const auto& channel : channels_) size += channel.size;
  sample_.setZero(size);
  quaternions = VectorXd::Zero(4 * system.num_bodies());
  quaternion_at_.resize(static_cast<size_t>(system.num_bodies()));
  divide();
  chosen_ = channels_;
  ranges_ = {{0, size}};
  kept_ = sample_;
}

int Outputs::find(const std::string& path, int component) const {
  int first = 0;
  for (const auto& channel : channels_) {
    if (channel.path == path) return component >= 0 && component < channel.size ? first + component : -1;
    first += channel.size;
  }
  return -1;
}

void Outputs::choose(const std::vector<std::string>& groups, const SourceLocation& where, Diagnostics& diagnostics) {
  if (groups.empty()) return;
  const auto lies_in = [](const std::string& path, const std::string& group) {
    const std::string whole = (group.starts_with('/') ? "" : "/") + group;
    return path == whole || path.starts_with(whole + "/");
  };
  std::vector<std::string> known;
  for (const auto& channel : channels_) {
    for (auto end = channel.path.find('/', 1); end != std::string::npos; end = channel.path.find('/', end + 1))
      known.push_back(channel.path.substr(1, end - 1));
    known.push_back(channel.path.substr(1));
  }
  for (const auto& group : groups) {
    const auto is_in = [&](const auto& channel) { return lies_in(channel.path, group); };
    if (std::any_of(channels_.begin(), channels_.end(), is_in)) continue;
    diagnostics.error(
        "run.unknown-group", where, "record names '" + group + "', which the results do not hold",
        suggest_name(group, known,
                     "name bodies, hinges, constraints, sensors, energy, momentum or a part of them, as bodies/NAME"));
  }
  chosen_.clear();
  ranges_.clear();
  int first = 0, size = 0;
  for (const auto& channel : channels_) {
    const auto holds = [&](const std::string& group) { return lies_in(channel.path, group); };
    if (channel.path == "/time" || std::any_of(groups.begin(), groups.end(), holds)) {
      chosen_.push_back(channel);
      ranges_.emplace_back(first, channel.size);
      size += channel.size;
    }
    first += channel.size;
  }
  kept_ = VectorXd::Zero(size);
}

const VectorXd& Outputs::keep_sample() {
  int at = 0;
  for (const auto& [first, size] : ranges_) {
    kept_.segment(at, size) = sample_.segment(first, size);
    at += size;
  }
  for (int b = 0; b < system_->num_bodies(); ++b)
    quaternions.segment<4>(4 * b) = sample_.segment<4>(quaternion_at_[static_cast<size_t>(b)]);
  return kept_;
}

void Outputs::add_recovery(const std::string& path, int body) {
  const auto& recovery = system_->recoveries[static_cast<size_t>(body)];
  if (!recovery) return;
  for (const auto& element : recovery->elements()) {
    if (!element.is_recorded) continue;
    std::string names;
    for (const auto& name : element.components) names += (names.empty() ? "" : ", ") + name;
    add_channel(path + "recovery/" + element.path, element.size(), names, "F, F L, F/L, F/L^2");
  }
}

void Outputs::add_channel(std::string path, int size, std::string description, std::string dims) {
  channels_.push_back({std::move(path), size, std::move(description), std::move(dims)});
}

void Outputs::add_part(Group group, int index, int size, int num_of_motion) {
  parts_.push_back({group, index, parts_.empty() ? 0 : parts_.back().first + parts_.back().size, size, num_of_motion});
  part_of_row_.insert(part_of_row_.end(), static_cast<size_t>(size), static_cast<int>(parts_.size()) - 1);
}

void Outputs::divide() {
  add_part(Group::Time, 0, 1, 1);
  for (int b = 0; b < system_->num_bodies(); ++b) {
    const int n = system_->num_modes(b);
    add_part(Group::Body, b, 13 + 2 * n + (n > 0 ? 1 : 0), 13 + 2 * n + (n > 0 ? 1 : 0));
    const auto& recovery = system_->recoveries[static_cast<size_t>(b)];
    int size = 0;
    for (size_t e = 0; recovery && e < recovery->elements().size(); ++e)
      if (recovery->elements()[e].is_recorded) size += recovery->elements()[e].size();
    if (size > 0) add_part(Group::Recovery, b, size, 0);
  }
  for (int b = 0; b < system_->num_bodies(); ++b) {
    const int nq = system_->num_hinge_q(b), nu = system_->num_hinge_rates(b);
    if (nq > 0) add_part(Group::Hinge, b, nq + 2 * nu, nq + nu);
    add_part(Group::Reaction, b, 6, 0);
  }
  for (int c = 0; c < system_->num_constraints(); ++c)
    add_part(Group::Constraint, c, system_->is_coupler(c) ? 1 : 6, 0);
  for (size_t i = 0; i < system_->elements.size(); ++i) {
    int size = 0;
    for (const ForceChannel& c : system_->elements[i]->channels()) size += c.size;
    if (size > 0) add_part(Group::Element, static_cast<int>(i), size, 0);
  }
  const auto& places = system_->signals.places;
  for (size_t i = 0; i < places.size(); ++i) {
    const int size = places[i].block->sizes.outputs;
    if (size > 0) add_part(Group::Signal, static_cast<int>(i), size, places[i].needs_acceleration ? 0 : size);
  }
  for (size_t i = 0; i < system_->tree.tanks.size(); ++i) add_part(Group::Tank, static_cast<int>(i), 2, 0);
  add_part(Group::Energy, 0, 5, 0);
  add_part(Group::Momentum, 0, 6 + system_->num_momentum_out(), 0);
  add_part(Group::Mass, 0, 13, 13);
  BOUGH_DEMAND(part_of_row_.size() == static_cast<size_t>(sample_.size()));
}

bool Outputs::is_of_motion(int row) const {
  const Part& part = parts_[static_cast<size_t>(part_of_row_[static_cast<size_t>(row)])];
  return row - part.first < part.num_of_motion;
}

int Outputs::get_place(int row) const {
  const Part& part = parts_[static_cast<size_t>(part_of_row_[static_cast<size_t>(row)])];
  return part.group == Group::Signal ? part.index : -1;
}

const VectorXd& Outputs::calc_sample(const SampleState& at) {
  for (const Part& part : parts_) calc_part(part, at);
  return sample_;
}

const VectorXd& Outputs::calc_rows(std::span<const int> rows, const SampleState& at) {
  int last = -1;
  for (const int row : rows) {
    const int part = part_of_row_[static_cast<size_t>(row)];
    if (part != last) calc_part(parts_[static_cast<size_t>(part)], at);
    last = part;
  }
  return sample_;
}

void Outputs::calc_body(int b, int at, const SampleState& state) {
  const auto put = [&](const auto& value) {
    sample_.segment(at, value.size()) = value;
    at += static_cast<int>(value.size());
  };
  const BodyState& s = get_body_state(state.data, b);
  Eigen::Quaterniond q_WB(s.R_WB);
  q_WB.normalize();
  put(s.p_WBo);
  Eigen::Vector4d wxyz(q_WB.w(), q_WB.x(), q_WB.y(), q_WB.z());
  if (wxyz.dot(quaternions.segment<4>(4 * b)) < 0) wxyz = -wxyz;
  quaternion_at_[static_cast<size_t>(b)] = at;
  put(wxyz);
  put(Vector3d(s.R_WB * s.v_B));
  put(s.w_B);
  put(state.q.segment(system_->eta_offset(b), system_->num_modes(b)));
  put(state.u.segment(system_->eta_dot_offset(b), system_->num_modes(b)));
  if (system_->num_modes(b) > 0) sample_[at++] = calc_strain_energy(*system_, state.data, b);
}

void Outputs::calc_part(const Part& part, const SampleState& state) {
  const SystemData& data = state.data;
  int at = part.first;
  const auto put = [&](const auto& value) {
    sample_.segment(at, value.size()) = value;
    at += static_cast<int>(value.size());
  };
  const auto index = static_cast<size_t>(part.index);
  switch (part.group) {
    case Group::Time:
      sample_[at] = state.t;
      break;
    case Group::Body:
      calc_body(part.index, at, state);
      break;
    case Group::Recovery: {
      const auto& recovery = system_->recoveries[index];
      for (const auto& element : recovery->elements()) {
        if (!element.is_recorded) continue;
        recovery->calc(get_motion(*system_, data), element.first, element.size(), sample_.data() + at);
        at += element.size();
      }
      break;
    }
    case Group::Hinge: {
      const int nq = system_->num_hinge_q(part.index), nu = system_->num_hinge_rates(part.index);
      get_hinge(get_motion(*system_, data), part.index, sample_.segment(at, nq), sample_.segment(at + nq, nu),
                sample_.segment(at + nq + nu, nu));
      break;
    }
    case Group::Reaction: {
      const HingeReaction reaction = get_hinge_reaction(*system_, data, part.index);
      put(reaction.force);
      put(reaction.moment);
      break;
    }
    case Group::Constraint: {
      const ConstraintReaction reaction = get_constraint_reaction(*system_, data, part.index);
      if (system_->is_coupler(part.index)) {
        sample_[at] = reaction.multiplier;
        break;
      }
      put(reaction.force);
      put(reaction.moment);
      break;
    }
    case Group::Element:
      for (int k = 0; k < part.size; ++k) sample_[at++] = data.elements[index].values[static_cast<size_t>(k)];
      break;
    case Group::Signal:
      sample_.segment(at, part.size) = data.signals.values.segment(system_->signals.places[index].out, part.size);
      break;
    case Group::Tank:
      sample_[at++] = data.tree.tanks[index].mass;
      sample_[at++] = data.tree.tanks[index].flow;
      break;
    case Group::Energy:
      energies_ = calc_energies(*system_, data);
      put(Eigen::Vector4d(energies_.kinetic, energies_.strain, energies_.potential, state.work));
      sample_[at++] = state.dissipated;
      break;
    case Group::Momentum: {
      Vector3d linear, angular;
      calc_momentum(*system_, data, linear, angular);
      put(linear);
      put(angular);
      if (system_->num_momentum_out() > 0) put(data.momentum_out);
      break;
    }
    case Group::Mass: {
      const SystemMass mass = calc_system_mass(*system_, data);
      sample_[at++] = mass.mass;
      put(mass.cg_W);
      put(Eigen::Map<const Eigen::Matrix<double, 9, 1>>(mass.inertia_W.data()));  // symmetric
      break;
    }
  }
}

}  // namespace bough::solver
