#include "solver/actuators/actuator.hpp"

#include <algorithm>
#include <limits>

#include "solver/actuators/makers.hpp"

namespace bough::solver {

void Actuator::read_shaping(SettingsReader& keys, int commands) {
  sizes.inputs = commands;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  scale_ = keys.get("scale", 1);
  bias_ = keys.get("bias", 0);
  deadband_ = keys.get_size("deadband", 0);
  high_ = keys.get("upper", kInfinite);
  low_ = keys.get("lower", keys.has("upper") ? -high_ : -kInfinite);
  keys.demand(low_ < high_, "has a lower limit that is not below the upper one", "give lower < upper");
  lag_ = keys.get_size("lag", 0);
  rate_ = keys.has("rate_limit") ? keys.get_positive("rate_limit") : kInfinite;
  keys.demand(!keys.has("rate_limit") || lag_ > 0, "has a rate_limit and no lag",
              "give lag = TIME, how quickly it follows while the limit leaves it alone");
  is_steady_ = keys.get_word("initial", "") == "steady";
  keys.demand(is_steady_ || keys.get_word("initial", "").empty(), "has an initial that is neither a number nor steady",
              "give a number, or initial = \"steady\"");
  initial_ = keys.has_number("initial") ? keys.get("initial") : 0;
  keys.demand(!keys.has("initial") || lag_ > 0, "has an initial and no lag", "give lag = TIME, or leave it out");
  sizes.states += num_lags();
  sizes.has_feedthrough = lag_ <= 0;
}

double Actuator::shape(const BlockInput& in, int i) const {
  return evaluate_scalar_law(in.tangents, as_owner(), i, scale_ * in.u[i] + bias_, [this]<class T>(T c) {
    c = c > T(deadband_) ? c - deadband_ : c < T(-deadband_) ? c + deadband_ : T(0);
    return std::clamp(c, T(low_), T(high_));
  });
}

double Actuator::calc_command(const BlockInput& in, int i) const { return lag_ > 0 ? in.z[i] : shape(in, i); }

void Actuator::start(double* z, double*) const { std::fill_n(z, num_lags(), initial_); }

bool Actuator::settle(const BlockInput& in, double* z) const {
  for (int i = 0; is_steady_ && i < num_lags(); ++i) z[i] = shape(in, i);
  return is_steady_;
}

void Actuator::calc_rates(const BlockInput& in, double* z_dot) const {
  for (int i = 0; i < num_lags(); ++i)
    z_dot[i] = evaluate_scalar_law(in.tangents, as_owner(), sizes.inputs + i, (shape(in, i) - in.z[i]) / lag_,
                                   [this]<class T>(T rate) { return std::clamp(rate, T(-rate_), T(rate_)); });
}

Vector3d read_axis(SettingsReader& keys, const std::string& key) {
  const VectorXd axis = keys.get_vector(key, 3);
  if (axis.norm() > 0 && axis.allFinite()) return axis.normalized();
  if (keys.has(key)) keys.error("control.bad-value", "has no direction in " + key, "give three numbers, not all zero");
  return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());  // what is compared with it has failed already
}

}  // namespace bough::solver
