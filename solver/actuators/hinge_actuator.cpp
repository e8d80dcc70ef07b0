// Actuators along a hinge coordinate: an ideal force or torque, an electric motor, a brake.
#include <cmath>

#include "solver/actuators/makers.hpp"

namespace bough::solver {
namespace {

class HingeActuator : public Actuator {
 public:
  int row = -1;

  void calc_outputs(const BlockInput& in, double* y) const override { y[0] = calc_command(in); }
  void add_load(const BlockInput&, const double* y, TreeData& data) const override { data.hinge_force[row] += y[0]; }
  /// For a prescribed coordinate the prescribed motion has the power of the total force.
  double calc_power(const BlockInput& in, const double* y) const override {
    const TreeData& tree = in.motion->data;
    return tree.mode[static_cast<size_t>(row)] == HingeMode::Free ? y[0] * tree.u[row] : 0;
  }

 protected:
  double get_rate(const BlockInput& in) const { return in.motion->data.u[row]; }
};

/// i = (V - k_b N q̇) / R;  Q = N k_t i - c q̇ - Q_c tanh(q̇ / w)
class Motor final : public HingeActuator {
 public:
  double torque_constant = 0, back_emf = 0, resistance = 1, ratio = 1, viscous = 0, coulomb = 0, width = 1;
  void calc_outputs(const BlockInput& in, double* y) const override {
    const double rate = get_rate(in);
    y[1] = (calc_command(in) - back_emf * ratio * rate) / resistance;
    y[0] = ratio * torque_constant * y[1] - viscous * rate - calc_coulomb(in, rate);
  }

 private:
  double calc_coulomb(const BlockInput& in, double rate) const {
    return evaluate_scalar_law(in.tangents, as_owner(), law_slot(), rate, [this](auto v) {
      using std::tanh;
      return coulomb * tanh(v / width);
    });
  }
};

/// The command is the largest torque: Q = -|command| tanh(q̇ / w)
class Brake final : public HingeActuator {
 public:
  double width = 1;
  void calc_outputs(const BlockInput& in, double* y) const override {
    y[0] = evaluate_law<1, 2>(in.tangents, as_owner(), law_slot(), {calc_command(in), get_rate(in)},
                              [this](const auto& at) {
                                using std::abs, std::tanh;
                                return std::array{-abs(at[0]) * tanh(at[1] / width)};
                              })[0];
  }
};

}  // namespace

std::unique_ptr<Actuator> make_hinge_actuator(const records::ActuatorRecord& r, SettingsReader& keys,
                                              const ActuatorPlace& place) {
  std::unique_ptr<HingeActuator> made;
  if (r.type == "motor") {
    auto motor = std::make_unique<Motor>();
    motor->torque_constant = keys.get("torque_constant");
    motor->back_emf = keys.get("back_emf", motor->torque_constant);
    motor->resistance = keys.get_positive("resistance");
    motor->ratio = keys.get("ratio", 1);
    motor->viscous = keys.get_size("viscous", 0);
    motor->coulomb = keys.get_size("coulomb", 0);
    if (motor->coulomb > 0) motor->width = keys.get_positive("stick_rate");
    made = std::move(motor);
  } else if (r.type == "brake") {
    auto brake = std::make_unique<Brake>();
    brake->width = keys.get_positive("stick_rate");
    made = std::move(brake);
  } else {
    made = std::make_unique<HingeActuator>();
  }
  made->row = place.row;
  made->read_shaping(keys);
  made->description = r.type == "motor" ? "generalized force on the hinge coordinate, current"
                                        : "generalized force on the hinge coordinate";
  made->dims = place.effort + (r.type == "motor" ? ", current" : "");
  return made;
}

}  // namespace bough::solver
