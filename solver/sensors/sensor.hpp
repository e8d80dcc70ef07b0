#pragma once
/// \file Sensors: [[sensor]] of a system file, resolved once and evaluated without allocation.
///
/// K is the node, B its body, A the body of relative_to or one of its nodes (W without), F the frame of components (W
/// for "inertial", B for "body", else the named body or node). p, v, a, ω, α are of K in W, minus those of Ao if marked
/// Δ; all components in F.
///
///   type                   observer = "turning": as A sees it           observer = "fixed"
///   position               Δp                                           Δp
///   velocity               v' = Δv - ω_A × Δp                           Δv
///   acceleration           Δa - α_A × Δp - ω_A × (ω_A × Δp) - 2 ω_A × v'   Δa
///   angular_velocity       Δω (with the rate of the deformation)        Δω
///   angular_acceleration   Δα - ω_A × Δω                                Δα
///   deflection, rotation   φη + ½[ηᵀg_aη]_a, ψη + ...: from the undeformed place, in B
///   quaternion, euler, dcm   of R_AS: the axes S of the sensor in A; w >= 0; R_AS = R_i(a) R_j(b) R_k(c)
///   gyro, accelerometer, direction   ω, a - g(p) of all gravity, the target's direction in S
///   horizon                  roll, pitch of S against the direction to the target, its z at zero
///   element                  forces and stresses of an element (solver/motion/recovery.hpp)
///   line_of_sight            Σ (L_k u_k + Q_k θ_k) over its terms: u = p_AK - p_AK0, exp(θ) = R_AK R_AK0ᵀ, in A
///   hinge_angle, hinge_rate   coordinates as the user knows them (quaternion w, x, y, z) and rates; one, or all for 0
///
/// With `orbit`, A is the LVLH frame of the body about the centre of gravity: origin Ao, z towards the centre, y
/// against r × v, x along the path; its rate is r × v / r², without the share about z that forces across the plane give
/// it.
///
/// With frame = A and relative_to = A, "turning" is what an observer who rides on A writes down. An empty frame means
/// "body" for deflection and rotation and "inertial" for the others.
#include <array>
#include <string>
#include <vector>

#include "formats/records/system_spec.hpp"
#include "solver/motion/motion.hpp"

namespace bough::solver {

class Recovery;

/// One optical node K of a line of sight. Rows of the weights above the number of outputs are zero.
struct SightTerm {
  int body = -1, node = 0;
  Matrix3d displacement = Matrix3d::Zero(), rotation = Matrix3d::Zero();  ///< 1/L, 1; columns in A
  Vector3d p_AK = Vector3d::Zero();                                       ///< [L] reference position
  Matrix3d R_AK = Matrix3d::Identity();                                   ///< reference attitude
};

struct Sensor {
  std::string name;
  std::string description;  ///< what it is, with its frame
  std::string dims;
  int size = 3;
  records::SensorType type = records::SensorType::Position;
  int body = -1, node = 0;  ///< body: index; node: index within the body. Hinge sensors: body of the hinge
  int frame = -1;           ///< body index, -1: W
  int relative_to = -1;     ///< body index, -1: W
  int frame_node = 0, relative_node = 0;  ///< index within those bodies; 0: the body itself
  bool from_turning = true;
  const CentralGravity* orbit = nullptr;  ///< relative_to: its LVLH frame about this centre, not its own frame
  bool in_orbital_frame = false;          ///< components in that frame
  int coordinate = 0;                     ///< 1-based, 0: all
  std::vector<bool> wraps;                ///< resolver: the component is an angle, brought into [-π, π]
  const Recovery* recovery = nullptr;     ///< element: of the body
  int row = 0;                            ///< element: its first row in the recovery
  Matrix3d mount = Matrix3d::Identity();  ///< R_KS
  Vector3d target = Vector3d::Zero();     ///< in W: a direction, a centre, the other end on ground
  std::array<int, 3> axes{2, 1, 0};       ///< euler: from 0
  int to_body = -1, to_node = 0;          ///< distance; -1: target
  std::vector<SightTerm> terms;           ///< line_of_sight
};

/// One sensor's measurement without its imperfections; out: its size. No allocation.
void measure(const Motion& motion, const Sensor& sensor, double* out);
/// Sets the reference positions and attitudes of the terms of a line of sight to those of the motion.
void set_reference(const Motion& motion, Sensor& sensor);
/// Marks the rows of q and u that the measurement is a function of, besides accelerations and time: of hinges and modes
/// on the way from ground to its bodies.
void mark_motion(const Tree& tree, const Sensor& sensor, std::vector<bool>& q, std::vector<bool>& u);
/// The turns of R = R_i(a) R_j(b) R_k(c) about axes (from 0); the third may be the first. b in [-π/2, π/2] where the
/// three differ, else in [0, π].
Vector3d calc_euler_angles(const Matrix3d& R, const std::array<int, 3>& axes);

}  // namespace bough::solver
