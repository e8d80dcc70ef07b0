// u = kp e + ki ∫e + kd ė, component by component; e = reference - input (docs/theory/control.md, "PID").
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/control/makers.hpp"

namespace bough::solver {
namespace {

/// States (memory where sampled): the integral part I, where there is a ki, then the filter of the derivative F.
class Pid final : public Block {
 public:
  int n = 1;
  bool has_reference = false, has_rate = false;
  double T = 0;  ///< sample time, 0: continuous
  VectorXd kp, ki, kd, low, high, filter, windup;
  double setpoint = 0;

  void calc_outputs(const BlockInput& in, double* y) const override {
    for (int i = 0; i < n; ++i) y[i] = limit(in, i, calc(in, i));
  }
  void calc_rates(const BlockInput& in, double* z_dot) const override {
    for (int i = 0; i < n; ++i) {
      if (has_integral()) z_dot[i] = calc_windup(in, i);
      if (has_filter()) z_dot[F() + i] = filter[i] > 0 ? (error(in, i) - in.z[F() + i]) / filter[i] : 0;
    }
  }
  void update(const BlockInput& in, double* d) const override {
    // I by Euler's rule, F = kd (e - e₋) / (τ + T) + τ / (τ + T) F₋ by the backward difference.
    for (int i = 0; i < n; ++i) {
      if (has_integral()) d[i] = in.d[i] + T * calc_windup(in, i);
      if (!has_filter()) continue;
      d[F() + i] = calc_difference(in, i);
      d[F() + n + i] = error(in, i);
    }
    if (has_filter()) d[F() + 2 * n] = 1;
  }

  /// The derivative comes of the error, not of a signal.
  bool has_filter() const { return !has_rate && !kd.isZero(0); }
  bool has_integral() const { return !ki.isZero(0); }
  /// Where F begins.
  int F() const { return has_integral() ? n : 0; }

 private:
  double error(const BlockInput& in, int i) const { return (has_reference ? in.u[n + i] : setpoint) - in.u[i]; }
  double get_integral(const BlockInput& in, int i) const { return !has_integral() ? 0 : T > 0 ? in.d[i] : in.z[i]; }
  double limit(const BlockInput& in, int i, double u) const {
    return evaluate_scalar_law(in.tangents, as_owner(), i, u,
                               [&]<class T>(T x) { return std::clamp(x, T(low[i]), T(high[i])); });
  }
  double calc_windup(const BlockInput& in, int i) const {
    if (ki[i] == 0) return 0;
    const double u = calc(in, i), held = limit(in, i, u);
    return ki[i] * error(in, i) + (held - u) / windup[i];
  }
  double calc_difference(const BlockInput& in, int i) const {
    const double e = error(in, i), before = in.d[F() + 2 * n] > 0 ? in.d[F() + n + i] : e;
    return (kd[i] * (e - before) + filter[i] * in.d[F() + i]) / (filter[i] + T);
  }
  double calc(const BlockInput& in, int i) const {
    double u = kp[i] * error(in, i) + get_integral(in, i);
    if (has_rate)
      u -= kd[i] * in.u[(has_reference ? 2 : 1) * n + i];
    else if (has_filter())
      u += T > 0 ? calc_difference(in, i) : filter[i] > 0 ? kd[i] * (error(in, i) - in.z[F() + i]) / filter[i] : 0;
    return u;
  }
};

}  // namespace

std::unique_ptr<Block> make_pid(SettingsReader& keys, const ControllerWiring& wiring, double sample_time) {
  auto made = std::make_unique<Pid>();
  Pid& p = *made;
  int n = 0;
  for (const int size : wiring.inputs) n += size;
  p.n = n;
  p.T = sample_time;
  p.has_reference = wiring.reference > 0;
  p.has_rate = wiring.rate > 0;
  if ((p.has_reference && wiring.reference != n) || (p.has_rate && wiring.rate != n))
    keys.error("control.bad-size", "has a reference or a rate of another size than its input",
               "name single components, as tip:x");
  p.setpoint = keys.get("setpoint", 0);
  keys.demand(!(p.has_reference && keys.has("setpoint")), "has a reference and a setpoint", "keep one of them");
  keys.demand(keys.has("kp") || keys.has("ki") || keys.has("kd"), "has neither kp nor ki nor kd: its output is zero",
              "give a gain");
  p.kp = keys.get_vector("kp", n, 0);
  p.ki = keys.get_vector("ki", n, 0);
  p.kd = keys.get_vector("kd", n, 0);
  p.filter = keys.get_vector("filter", n, 0);
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  p.low = keys.get_vector("lower", n, -kInfinite);
  p.high = keys.get_vector("upper", n, kInfinite);
  keys.demand((p.low.array() < p.high.array()).all(), "has lower limits that are not below the upper ones",
              "give lower < upper");
  keys.demand((p.filter.array() >= 0).all(), "has a negative filter", "give a time");
  for (int i = 0; i < n && sample_time <= 0; ++i)
    keys.demand(p.kd[i] == 0 || p.has_rate || p.filter[i] > 0, "has kd and nothing to take the derivative from",
                "give filter = TIME (the derivative becomes kd s / (1 + filter s)), or rate = SIGNAL");
  // Back-calculation: the integral follows the limited output within this time.
  VectorXd usual(n);
  for (int i = 0; i < n; ++i) {
    const double integral = p.ki[i] != 0 ? std::abs(p.kp[i] / p.ki[i]) : 0;
    const double derivative = p.kp[i] != 0 ? std::abs(p.kd[i] / p.kp[i]) : 0;
    usual[i] = derivative > 0 && integral > 0 ? std::sqrt(integral * derivative) : integral > 0 ? integral : 1;
    if (sample_time > 0) usual[i] = std::max(usual[i], sample_time);
  }
  keys.demand(!keys.has("windup_time") || !p.ki.isZero(0), "has a windup_time and no ki", "give ki, or leave it out");
  p.windup = keys.has("windup_time") ? keys.get_vector("windup_time", n) : usual;
  keys.demand((p.windup.array() > 0).all(), "has a windup_time that is not positive", "give a time");
  p.sizes.inputs = wiring.size();
  p.sizes.outputs = n;
  if (sample_time > 0)
    p.sizes.memory = p.F() + (p.has_filter() ? 2 * n + 1 : 0);
  else
    p.sizes.states = p.F() + (p.has_filter() ? n : 0);
  return made;
}

}  // namespace bough::solver
