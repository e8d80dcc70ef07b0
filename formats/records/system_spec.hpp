#pragma once
/// \file A multibody system as the user wrote it (TOML tables [[body]] [[hinge]] ...), before any numerics.
///
/// Names refer to names; "ground" is the inertial body. A node of a rigid body is declared under it; a node of a
/// flexible body is an output node id of its file; node 0 is the body origin Bo. Angles are in radians here.
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/constraint_spec.hpp"
#include "formats/records/control_spec.hpp"
#include "formats/records/flex_body.hpp"
#include "formats/records/force_spec.hpp"
#include "formats/records/function_spec.hpp"
#include "formats/records/orbit_spec.hpp"
#include "formats/records/sensor_kinds.hpp"
#include "formats/records/tank_spec.hpp"
#include "formats/records/unit_labels.hpp"

namespace bough::records {

struct RigidNode {
  int id = 0;
  Vector3d p = Vector3d::Zero();  ///< in B
};

struct BodyRecord {
  std::string name;
  std::string file;                 ///< flexible-body HDF5; empty = rigid
  std::vector<std::string> levels;  ///< flexible: files of its fill levels, `file` is that of the start; empty: one
  bool is_unreadable = false;       ///< file: could not be read, which has been said
  double mass = 0;
  Vector3d cg = Vector3d::Zero();       ///< in B
  Matrix3d inertia = Matrix3d::Zero();  ///< about the centre of mass (rigid bodies), in B
  std::vector<RigidNode> nodes;
  std::vector<Vector3d> hull;  ///< corners of the convex hull that shades others, from Bo in B; empty: the rigid nodes
  bool stiffening = true;
  std::vector<double> eta, eta_dot;    ///< initial; empty = zero
  std::vector<double> damping_ratios;  ///< overrides the file's modal damping when not empty (one = uniform)
  int num_modes = -1;                  ///< number of the first modes retained; -1 = all
  bool recover_all = false;            ///< every element of the file's /recovery is among the results
  std::vector<int> recover;            ///< or these
  SourceLocation at;
};

enum class HingeType { Fixed, Revolute, Prismatic, Universal, Cylindrical, Planar, Spherical, Free, Screw, General };

struct HingeRecord {
  std::string name;
  HingeType type = HingeType::Fixed;
  std::string parent = "ground", child;
  int parent_node = 0, child_node = 0;
  Vector3d parent_position = Vector3d::Zero();      ///< of Hp from the parent node, in parent B (ground: inertial)
  Matrix3d parent_rotation = Matrix3d::Identity();  ///< R_PHp (hinge axes in the parent body)
  Vector3d child_position = Vector3d::Zero();
  Matrix3d child_rotation = Matrix3d::Identity();  ///< R_CHc
  Vector3d axis = Vector3d::UnitZ();    ///< revolute, prismatic, cylindrical, screw; planar: the normal; in Hp
  Vector3d axis2 = Vector3d::UnitY();   ///< universal: second axis, in Hp at q = 0
  double pitch = 0;                     ///< screw: travel per radian
  std::string rotations, translations;  ///< general: axes in order, as "zxz" (gimbal), "xz"; "q": quaternion
  std::vector<double> stiffness, damping, null_position;  ///< per hinge coordinate; empty = 0
  std::vector<double> position, rate;  ///< initial; spherical/free orientation as quaternion w,x,y,z in position
  std::vector<std::string> motion;     ///< prescribed: function name per coordinate ("" = free)
  bool is_guess = false;               ///< position: may be moved to close loops as freely as if it were not given
  std::vector<bool> locked;            ///< at the start, per hinge rate; empty: none
  HingeLawRecord law;
  SourceLocation at;
};

enum class ForceKind { Force, Moment };
enum class VectorFrame { Inertial, Body, Node };  ///< node: follows the node's own rotation (follower load)

struct ForceRecord {
  std::string name;
  ForceKind kind = ForceKind::Force;
  std::string body;
  int node = 0;
  Vector3d direction = Vector3d::Zero();  ///< times the function's value
  VectorFrame frame = VectorFrame::Body;
  std::string function;  ///< empty = constant 1
  std::string signal;    ///< instead of a function: a signal of one component
  std::string locator;   ///< or: a load pattern of the body file, then node and direction are unused
  SourceLocation at;
};

/// One optical node of a line of sight: its rows of displacement and rotation weights.
struct OpticalTerm {
  std::string body;
  int node = 0;
  Eigen::MatrixXd displacement, rotation;  ///< [num_outputs x 3], 1/L and 1; empty: zero
  SourceLocation at;
};
struct SensorRecord {
  std::string name;
  SensorType type = SensorType::Position;
  std::string body;
  int node = 0;
  std::string frame = "inertial";  ///< "inertial", "body" (the node's own body) or another body's name: components
  std::string relative_to;         ///< relative to the motion of this body (not deflection, rotation); empty: none
  int relative_node = 0, frame_node = 0;  ///< node of that body; node of the body of `frame`, whose axes these are
  bool is_orbital = false;                ///< relative_to: to the LVLH frame of the body about its central gravity
  bool from_turning = true;               ///< relative_to: as an observer who turns with that body sees it
  std::string hinge;                      ///< hinge sensors
  int coordinate = 0;                     ///< hinge sensors: 1-based; 0 = all; modal sensors: the mode
  int element = 0;                        ///< element sensors: its id in the body's file
  std::string component;                  ///< element sensors: one of its rows; empty = all
  std::string to_body;                    ///< distance: the other end; empty = ground
  int to_node = 0;
  std::string sequence = "321";           ///< euler: axes of the three turns, in their order
  Matrix3d mount = Matrix3d::Identity();  ///< R_KS: the sensor's axes S in those of the node K
  Vector3d target = Vector3d::UnitX();    ///< direction: in the inertial frame; horizon: the centre's position
  std::vector<OpticalTerm> terms;         ///< line_of_sight
  Settings chain;                         ///< scale, bias, noise, ...: what becomes of the measurement
  SourceLocation at;
};

enum class EventDirection { Both, Rising, Falling };
enum class EventAction { Log, Stop, Lock, Release, Break, Close, Enable, Disable, Switch, Level };

/// [[event]]: at a time, or where a signal crosses a value.
struct UserEventRecord {
  std::string name;
  std::optional<double> time;
  std::string signal;  ///< "sensor:component" or "/channel:component"; empty with time
  double value = 0;
  EventDirection direction = EventDirection::Both;
  double tolerance = 0;  ///< of the time found; 0: 1e-12 of the duration
  EventAction action = EventAction::Log;
  std::string target;  ///< lock, release: hinge; break, close: constraint; enable, disable, switch: controller; level:
                       ///< body
  int choice = 0;      ///< switch: the input that the controller passes on; level: of the body's levels; 1-based
  std::vector<int> coordinates;  ///< lock, release: 1-based rates of the hinge; empty: all
  SourceLocation at;
};

struct SimulationRecord {
  double start = 0, duration = 0;
  double output_step = 0;                                         ///< 0: duration / 1000
  double output_from = -std::numeric_limits<double>::infinity();  ///< samples before it are not written
  double output_until = std::numeric_limits<double>::infinity();  ///< nor those after it
  int output_every = 1;                                           ///< interval of the samples written, in samples
  std::vector<std::string> record;   ///< groups of channels: "bodies", "hinges/root", ...; empty = all
  std::string integrator = "adams";  ///< adams, bdf (CVODE), rk, radau, rk4, implicit (fixed step), auto
  double step = 0;                   ///< rk4, implicit; also the largest step of the others when > 0
  int rk_order = 8;                  ///< rk: 5 or 8
  double relative_tolerance = 1e-8, absolute_tolerance = 1e-10;
  double absolute_tolerance_modes = 0;  ///< of η and η̇; 0: as the others
  Vector3d gravity = Vector3d::Zero();  ///< inertial
  double divergence_limit = 1e6;        ///< of a deflection to the body's size, of √(kinetic energy / energy put in)
  double energy_error_limit = 1e-2;     ///< relative; a run above it is reported as failed
  std::string stiffening = "consistent";  ///< or lagged: K_G1 A_I + K_G2 FCONI of the last step
  double stiffening_step = 0;             ///< lagged: how often they are measured; 0: `step`
  SourceLocation at;
};

struct SystemSpec {
  std::string file, text;  ///< the TOML file and its text, stored in the results
  std::string name;
  UnitLabels units;                                        ///< [units]
  std::vector<std::pair<std::string, double>> parameters;  ///< [parameters]; their numbers stand where they are named
  std::vector<BodyRecord> bodies;
  std::vector<TankRecord> tanks;
  std::vector<OrbitRecord> orbits;
  std::vector<HingeRecord> hinges;
  std::vector<ConstraintRecord> constraints;
  std::vector<FunctionRecord> functions;
  std::vector<ForceRecord> forces;
  std::vector<ForceElementRecord> force_elements;  ///< [[force]] with a type
  std::vector<SensorRecord> sensors;
  std::vector<UserEventRecord> events;
  std::vector<InputRecord> inputs;
  std::vector<ControllerRecord> controllers;
  std::vector<ActuatorRecord> actuators;
  std::vector<ConnectRecord> connects;
  SimulationRecord simulation;
};

}  // namespace bough::records
