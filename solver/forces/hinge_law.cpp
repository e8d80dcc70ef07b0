#include "solver/forces/hinge_law.hpp"

#include <algorithm>
#include <cmath>

namespace bough::solver {

double HingeLaw::calc_friction(double rate, double slide) const {
  if (law_.coulomb == 0 && law_.static_friction == 0) return 0;
  const double s = rate / law_.stribeck_velocity;
  return (law_.coulomb + (law_.static_friction - law_.coulomb) * std::exp(-s * s)) *
         (law_.is_dry ? slide : std::tanh(rate / law_.smoothing));
}

ForceResult HingeLaw::calc(const Tree&, const TreeData& data, Loads* loads) const {
  ForceResult result;
  if (data.mode[static_cast<size_t>(u_row_)] == HingeMode::Prescribed) return result;
  const double q = data.q[q_row_], rate = data.u[u_row_], deflection = q - law_.null_position;
  double elastic = law_.preload, damper = -calc_friction(rate, data.slide[u_row_]);
  result.strain = -law_.preload * deflection;
  if (law_.spring) {
    const auto table = law_.spring->calc(deflection);
    elastic -= table.y;
    result.strain += table.integral;
  }
  if (law_.damper) damper -= law_.damper->calc(rate).y;
  const double past = q > law_.upper ? q - law_.upper : q < law_.lower ? q - law_.lower : 0;
  if (past != 0) {
    const double spring = -law_.stop_stiffness * past;
    const double inward = past > 0 ? rate : -rate;
    elastic += spring;
    damper += spring * std::max(-1.0, law_.stop_damping * inward);
    result.strain += 0.5 * law_.stop_stiffness * past * past;
  }
  if (loads != nullptr) loads->add_to_hinge(u_row_, elastic + damper);
  result.power = elastic * rate;
  result.dissipated = -damper * rate;
  return result;
}

void HingeLaw::add_tangent(const Tree&, const TreeData& data, Eigen::Ref<VectorXd> stiffness,
                           Eigen::Ref<VectorXd> damping) const {
  if (data.mode[static_cast<size_t>(u_row_)] == HingeMode::Prescribed) return;
  const double q = data.q[q_row_], rate = data.u[u_row_];
  double k = 0, c = 0;
  if (law_.spring) k += std::max(0.0, law_.spring->calc(q - law_.null_position).slope);
  if (law_.damper) c += std::max(0.0, law_.damper->calc(rate).slope);
  const double past = q > law_.upper ? q - law_.upper : q < law_.lower ? law_.lower - q : 0;
  if (past > 0) {
    k += law_.stop_stiffness;
    c += law_.stop_stiffness * past * law_.stop_damping;
  }
  // Of the chord: smooth friction turns within one step.
  if (!law_.is_dry && (law_.coulomb != 0 || law_.static_friction != 0)) {
    const double v = std::max(std::abs(rate), 1e-3 * law_.smoothing);
    c += std::max(0.0, calc_friction(v, 0) / v);
  }
  stiffness[u_row_] += k;
  damping[u_row_] += c;
}

}  // namespace bough::solver
