#pragma once
/// \file [[tank]] of a system file: propellant whose mass leaves a rigid body.
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "base/diagnostic.hpp"

namespace bough::records {

enum class TankType { Cylinder, Sphere, Grain, Table };

enum class SloshModel { Pendulum, Spring };

struct TankRecord {
  std::string name, body;
  TankType type = TankType::Cylinder;
  double mass = 0;                                     ///< at the start
  std::string function;                                ///< or: the mass, as a function of time; empty: actuators use it
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< centre of the bottom; sphere: its centre; in B
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();     ///< from the bottom to the free surface, in B
  double radius = 0, bore = 0, height = 0, density = 0;
  bool is_of_body = false;  ///< table: of body and propellant together
  std::vector<double> masses;
  std::vector<Eigen::Vector3d> cg;
  std::vector<Eigen::Matrix3d> inertia;  ///< about the centre of mass
  bool sloshes = false;
  SloshModel slosh_model = SloshModel::Pendulum;
  double slosh_damping = 0;           ///< ratio
  double slosh_viscosity = 0;         ///< kinematic, L²/T; 0: no damping by the wall
  double baffle_width = 0;            ///< of ring baffles at a cylinder's wall
  std::vector<double> baffle_depths;  ///< below the free surface
  double baffle_amplitude = 0;        ///< of the wave at the wall
  double slosh_acceleration = 0;      ///< axial, that the ratio belongs to; 0: gravity of the run
  double slosh_mass = 0;              ///< of the pendulum in the bodies, subtracted from the rigid part (add_slosh)
  Eigen::Vector3d slosh_position = Eigen::Vector3d::Zero();  ///< of its bob at rest, in B
  int exit_node = 0;                                         ///< function: where the mass leaves
  double exit_radius = 0;
  Eigen::Vector3d exit_axis = Eigen::Vector3d::UnitX();
  SourceLocation at;
};

}  // namespace bough::records
