#include "solver/forces/hinge_law.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace bough::solver {

template <class T>
T HingeLaw::calc_friction(T rate, double slide) const {
  using std::exp, std::tanh;
  if (law_.coulomb == 0 && law_.static_friction == 0) return 0;
  const T s = rate / law_.stribeck_velocity;
  return (law_.coulomb + (law_.static_friction - law_.coulomb) * exp(-s * s)) *
         (law_.is_dry ? T(slide) : tanh(rate / law_.smoothing));
}

template <class T>
std::array<T, 2> HingeLaw::calc_forces(const std::array<T, 2>& at, double slide, double& strain) const {
  const T q = at[0], rate = at[1], deflection = q - law_.null_position;
  T elastic = law_.preload, damper = -calc_friction(rate, slide);
  constexpr bool kHasStrain = std::is_same_v<T, double>;
  if constexpr (kHasStrain) strain = -law_.preload * deflection;
  if (law_.spring) {
    const auto table = law_.spring->calc(deflection);
    elastic -= table.y;
    if constexpr (kHasStrain) strain += table.integral;
  }
  if (law_.damper) damper -= law_.damper->calc(rate).y;
  const T past = q > T(law_.upper) ? q - law_.upper : q < T(law_.lower) ? q - law_.lower : T(0);
  if (past != T(0)) {
    const T spring = -law_.stop_stiffness * past;
    const T inward = past > T(0) ? rate : -rate;
    elastic += spring;
    damper += spring * std::max(T(-1.0), law_.stop_damping * inward);
    if constexpr (kHasStrain) strain += 0.5 * law_.stop_stiffness * past * past;
  }
  return {elastic, damper};
}

ForceResult HingeLaw::calc(const Tree&, const TreeData& data, Loads* loads) const {
  ForceResult result;
  const double rate = data.u[u_row_], slide = data.slide[u_row_];
  if (is_prescribed(data)) {
    result.power = calc_forces<double>({data.q[q_row_], rate}, slide, result.strain)[0] * rate;
    return result;
  }
  const auto [elastic, damper] =
      evaluate_law<2, 2>(data.tangents, {this, "hinge coordinate", name()}, 0, {data.q[q_row_], rate},
                         [&](const auto& at) { return calc_forces(at, slide, result.strain); });
  if (loads != nullptr) loads->add_to_hinge(u_row_, elastic + damper);
  result.power = elastic * rate;
  result.dissipated = -damper * rate;
  return result;
}

void HingeLaw::add_tangent(const Tree&, const TreeData& data, Eigen::Ref<VectorXd> stiffness,
                           Eigen::Ref<VectorXd> damping) const {
  if (is_prescribed(data)) return;
  const double q = data.q[q_row_], rate = data.u[u_row_];
  double k = 0, c = 0;
  if (law_.spring) k += std::max(0.0, law_.spring->calc(q - law_.null_position).slope);
  if (law_.damper) c += std::max(0.0, law_.damper->calc(rate).slope);
  const double past = q > law_.upper ? q - law_.upper : q < law_.lower ? law_.lower - q : 0;
  if (past > 0) {
    k += law_.stop_stiffness;
    c += law_.stop_stiffness * past * law_.stop_damping;
  }
  // Friction adds its secant damping, F/v: smooth friction changes its sign within one step.
  if (!law_.is_dry && (law_.coulomb != 0 || law_.static_friction != 0)) {
    const double v = std::max(std::abs(rate), 1e-3 * law_.smoothing);
    c += std::max(0.0, calc_friction(v, 0) / v);
  }
  stiffness[u_row_] += k;
  damping[u_row_] += c;
}

}  // namespace bough::solver
