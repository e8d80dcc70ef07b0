// Rotors: reaction wheel and control moment gyroscope (docs/theory/control.md, "Wheels"). A balanced rotor of axial
// momentum h about the unit vector a in its body puts -ḣ a - h (ω × a + ȧ) on it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/actuators/makers.hpp"

namespace bough::solver {
namespace {

class Rotor : public Actuator {
 public:
  int marker = -1;

 protected:
  const MarkerMotion& get_motion(const BlockInput& in) const {
    return in.motion->data.markers[static_cast<size_t>(marker)];
  }
  int get_body(const BlockInput& in) const { return in.motion->tree.markers[static_cast<size_t>(marker)].body; }
  /// Angular velocity of the node, in B.
  Vector3d calc_rate(const BlockInput& in) const { return in.motion->data[get_body(in)].state.w_B + get_motion(in).w; }
  void add_moment(const BlockInput& in, const Vector3d& moment_B, TreeData& data) const {
    add_marker_wrench(in.motion->tree, marker, Vector3d::Zero(), moment_B, data);
  }
};

/// State: h = J (Ω + a·ω), the momentum about the axis. Memory: at its limit (-1, 0, 1).
class Wheel final : public Rotor {
 public:
  Vector3d axis = Vector3d::UnitZ();
  double inertia = 1, limit = std::numeric_limits<double>::infinity(), initial = 0;
  double viscous = 0, coulomb = 0, width = 1;

  void start(double* z, double* d) const override {
    Rotor::start(z, d);
    z[num_lags()] = initial;
  }
  void calc_outputs(const BlockInput& in, double* y) const override {
    y[1] = get_momentum(in);
    y[2] = y[1] / inertia - (get_motion(in).R * axis).dot(calc_rate(in));
    y[0] = calc_torque(in, y[2]);
  }
  void calc_rates(const BlockInput& in, double* z_dot) const override {
    Rotor::calc_rates(in, z_dot);
    double y[3];
    calc_outputs(in, y);
    z_dot[num_lags()] = y[0];
  }
  void calc_event_functions(const BlockInput& in, double* g) const override {
    const double h = get_momentum(in), torque = calc_command(in);
    g[0] = in.d[0] == 0 ? std::min(h - limit, torque) : -1;
    g[1] = in.d[0] == 0 ? std::min(-h - limit, -torque) : -1;
    g[2] = in.d[0] != 0 ? -in.d[0] * torque : -1;
  }
  void switch_over(const BlockInput&, int function, double* d) const override {
    d[0] = function == 0 ? 1 : function == 1 ? -1 : 0;
  }
  void add_load(const BlockInput& in, const double* y, TreeData& data) const override {
    const Vector3d a = get_motion(in).R * axis;
    add_moment(in, -y[0] * a - y[1] * calc_rate(in).cross(a), data);
  }
  double calc_power(const BlockInput& in, const double* y) const override { return y[0] * get_momentum(in) / inertia; }
  double calc_energy(const BlockInput& in) const override {
    const double h = get_momentum(in);
    return 0.5 * h * h / inertia;
  }
  Vector3d calc_momentum(const BlockInput& in) const override {
    return in.motion->data[get_body(in)].state.R_WB * (get_motion(in).R * axis) * get_momentum(in);
  }

 private:
  double get_momentum(const BlockInput& in) const { return in.z[num_lags()]; }
  double calc_torque(const BlockInput& in, double speed) const {
    return evaluate_law<1, 2>(in.tangents, as_owner(), law_slot(), {calc_command(in), speed},
                              [&]<class T>(const std::array<T, 2>& at) {
                                using std::tanh;
                                if (in.d[0] * at[0] > T(0)) return std::array{T(0)};  // held at its limit
                                return std::array{at[0] - viscous * at[1] - coulomb * tanh(at[1] / width)};
                              })[0];
  }
};

/// The command is the rate of the gimbal; state: its angle. The spin's momentum is constant. The motor of the gimbal
/// puts the component of ḣ = (ω + γ̇ g) × h along g on it, which is g·(ω × h).
class SingleGimbal final : public Rotor {
 public:
  Vector3d gimbal = Vector3d::UnitZ(), spin = Vector3d::UnitX();
  double momentum = 0, initial = 0;

  void start(double* z, double* d) const override {
    Rotor::start(z, d);
    z[num_lags()] = initial;
  }
  void calc_outputs(const BlockInput& in, double* y) const override {
    y[0] = calc_command(in);
    y[1] = in.z[num_lags()];
    y[2] = (get_motion(in).R * gimbal).dot(calc_rate(in).cross(calc_spin(in)));
  }
  void calc_rates(const BlockInput& in, double* z_dot) const override {
    Rotor::calc_rates(in, z_dot);
    z_dot[num_lags()] = calc_command(in);
  }
  void add_load(const BlockInput& in, const double* y, TreeData& data) const override {
    const Matrix3d& R = get_motion(in).R;
    const Vector3d h = calc_spin(in);
    add_moment(in, -(calc_rate(in) + y[0] * (R * gimbal)).cross(h), data);
  }
  Vector3d calc_momentum(const BlockInput& in) const override {
    return in.motion->data[get_body(in)].state.R_WB * calc_spin(in);
  }

 private:
  Vector3d calc_spin(const BlockInput& in) const {
    const double angle = in.z[num_lags()];
    return momentum * (get_motion(in).R * (std::cos(angle) * spin + std::sin(angle) * gimbal.cross(spin)));
  }
};

/// Commands: the rates of the outer gimbal, about o in its body, and of the inner one, about i, which the outer
/// carries. States: their angles α and β; h = h₀ R_o(α) R_i(β) s, and the gimbals turn h at α̇ o + β̇ R_o(α) i. The
/// motors put the components of ḣ along o and R_o(α) i on them.
class DoubleGimbal final : public Rotor {
 public:
  Vector3d outer = Vector3d::UnitZ(), inner = Vector3d::UnitX(), spin = Vector3d::UnitY();
  double momentum = 0, initial[2] = {};

  void start(double* z, double* d) const override {
    Rotor::start(z, d);
    std::copy_n(initial, 2, z + num_lags());
  }
  void calc_outputs(const BlockInput& in, double* y) const override {
    for (int i = 0; i < 2; ++i) {
      y[i] = calc_command(in, i);
      y[2 + i] = in.z[num_lags() + i];
    }
    const Vector3d h_dot = calc_momentum_rate(in, y);
    const Matrix3d& R = get_motion(in).R;
    y[4] = (R * outer).dot(h_dot);
    y[5] = (R * (calc_outer(in) * inner)).dot(h_dot);
  }
  void calc_rates(const BlockInput& in, double* z_dot) const override {
    Rotor::calc_rates(in, z_dot);
    for (int i = 0; i < 2; ++i) z_dot[num_lags() + i] = calc_command(in, i);
  }
  void add_load(const BlockInput& in, const double* y, TreeData& data) const override {
    add_moment(in, -calc_momentum_rate(in, y), data);
  }
  Vector3d calc_momentum(const BlockInput& in) const override {
    return in.motion->data[get_body(in)].state.R_WB * calc_spin(in);
  }

 private:
  /// ḣ in B at the rates y[0] and y[1].
  Vector3d calc_momentum_rate(const BlockInput& in, const double* y) const {
    const Vector3d turn = get_motion(in).R * (y[0] * outer + y[1] * (calc_outer(in) * inner));
    return (calc_rate(in) + turn).cross(calc_spin(in));
  }
  Matrix3d calc_outer(const BlockInput& in) const {
    return Eigen::AngleAxisd(in.z[num_lags()], outer).toRotationMatrix();
  }
  Vector3d calc_spin(const BlockInput& in) const {
    const Vector3d in_outer = Eigen::AngleAxisd(in.z[num_lags() + 1], inner) * spin;
    return momentum * (get_motion(in).R * (calc_outer(in) * in_outer));
  }
};

std::unique_ptr<Rotor> make_double_gimbal(SettingsReader& keys) {
  auto cmg = std::make_unique<DoubleGimbal>();
  cmg->outer = read_axis(keys, "gimbal_axis");
  cmg->inner = read_axis(keys, "inner_axis");
  cmg->spin = read_axis(keys, "spin_axis");
  keys.demand(!(std::abs(cmg->outer.dot(cmg->inner)) >= 1e-9),
              "has an inner_axis that is not normal to its gimbal_axis", "give it at angle zero of the outer gimbal");
  keys.demand(!(std::abs(cmg->inner.dot(cmg->spin)) >= 1e-9), "has a spin_axis that is not normal to its inner_axis",
              "give it at gimbal angles zero");
  cmg->momentum = keys.get("momentum");
  const VectorXd angles = keys.get_vector("angle", 2, 0);
  cmg->initial[0] = angles[0];
  cmg->initial[1] = angles[1];
  cmg->dims = "1/T, 1/T, 1, 1, F L, F L";
  cmg->description = "rates of the outer and the inner gimbal, their angles, torques of their motors";
  cmg->read_shaping(keys, 2);
  cmg->sizes.states += 2;
  return cmg;
}

std::unique_ptr<Wheel> make_wheel(SettingsReader& keys) {
  auto wheel = std::make_unique<Wheel>();
  wheel->axis = read_axis(keys);
  wheel->inertia = keys.get_positive("inertia");
  if (keys.has("momentum_limit")) wheel->limit = keys.get_positive("momentum_limit");
  wheel->initial = keys.get("momentum", 0);
  wheel->viscous = keys.get_size("viscous", 0);
  wheel->coulomb = keys.get_size("coulomb", 0);
  if (wheel->coulomb > 0) wheel->width = keys.get_positive("stick_rate");
  keys.demand(std::abs(wheel->initial) <= wheel->limit, "starts beyond its momentum_limit", "give less momentum");
  wheel->sizes.memory = 1;
  wheel->sizes.event_functions = 3;
  wheel->dims = "F L, F L T, 1/T";
  return wheel;
}

}  // namespace

std::unique_ptr<Actuator> make_rotor(const records::ActuatorRecord& r, SettingsReader& keys,
                                     const ActuatorPlace& place) {
  std::unique_ptr<Rotor> made;
  if (r.type == "wheel") {
    made = make_wheel(keys);
  } else if (r.type == "double_gimbal_cmg") {
    made = make_double_gimbal(keys);
    made->marker = place.marker;
    return made;
  } else {
    auto cmg = std::make_unique<SingleGimbal>();
    cmg->gimbal = read_axis(keys, "gimbal_axis");
    cmg->spin = read_axis(keys, "spin_axis");
    keys.demand(!(std::abs(cmg->gimbal.dot(cmg->spin)) >= 1e-9),
                "has a spin_axis that is not normal to its gimbal_axis", "give it at gimbal angle zero");
    cmg->momentum = keys.get("momentum");
    cmg->initial = keys.get("angle", 0);
    cmg->dims = "1/T, 1, F L";
    made = std::move(cmg);
  }
  made->marker = place.marker;
  made->read_shaping(keys);
  ++made->sizes.states;
  made->description = r.type == "wheel" ? "torque on the wheel, its momentum about its axis, its speed against the body"
                                        : "rate and angle of the gimbal, torque of its motor";
  return made;
}

}  // namespace bough::solver
