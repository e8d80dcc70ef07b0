#include "formats/records/linear_sweep.hpp"

#include <algorithm>
#include <numbers>
#include <sstream>

namespace bough::records {

namespace {

std::complex<double> calc_z(double real, double imag, double sample_time) {
  const auto z = std::exp(std::complex<double>(real, imag) * sample_time);
  return std::abs(z) < kGone ? 0.0 : z;
}

}  // namespace

std::complex<double> calc_z(const LinearModel& model, Eigen::Index i) {
  return calc_z(model.poles.real[i], model.poles.imag[i], model.sample_time);
}

std::complex<double> calc_z(const LinearSweep& sweep, Eigen::Index k, Eigen::Index b) {
  return calc_z(sweep.real(k, b), sweep.imag(k, b), sweep.models[static_cast<std::size_t>(k)].sample_time);
}

double get_grid_value(const LinearSweep& sweep, Eigen::Index k, std::size_t axis) {
  for (std::size_t i = sweep.grid_value.size() - 1; i > axis; --i) k /= sweep.grid_value[i].size();
  return sweep.grid_value[axis][k % sweep.grid_value[axis].size()];
}

std::string describe_point(const LinearSweep& sweep, Eigen::Index k) {
  std::ostringstream text;
  if (sweep.grid_name.empty()) text << sweep.parameter << " = " << sweep.value[k];
  for (std::size_t i = 0; i < sweep.grid_name.size(); ++i)
    text << (i > 0 ? ", " : "") << sweep.grid_name[i] << " = " << get_grid_value(sweep, k, i);
  return text.str();
}

bool is_gone(const LinearSweep& sweep, Eigen::Index b) {
  if (sweep.models.empty()) return false;
  for (Eigen::Index k = 0; k < sweep.value.size(); ++k)
    if (sweep.models[static_cast<std::size_t>(k)].sample_time == 0 || calc_z(sweep, k, b) != 0.0) return false;
  return true;
}

bool is_gone(const LinearModel& model, Eigen::Index i) { return model.sample_time > 0 && calc_z(model, i) == 0.0; }

bool is_cut_loop(const LinearModel& model) {
  const auto& names = model.outputs.name;
  return !names.empty() && model.inputs.size() == model.outputs.size() &&
         std::all_of(names.begin(), names.end(), [](const std::string& name) { return name.ends_with(":return"); });
}

double calc_origin_radius(const Poles& poles, Eigen::Index i) {
  constexpr double kRounding = 1e-12 * 2 * std::numbers::pi;
  return std::max(poles.error.size() > 0 ? poles.error[i] : 0, kRounding * poles.frequency_hz.maxCoeff());
}

SecondOrder make_second_order(const LinearModel& model) {
  const Eigen::Index n = model.mass.rows();
  const Eigen::Index nz = model.A.rows() - 2 * n;
  if (n == 0 || model.sample_time > 0 || nz < 0) return {};
  // δ̇ = T δ + δu with constant T, and δu̇ = A_q δ + A_u δu + A_z z + B u: δu is eliminated.
  const Eigen::MatrixXd T = model.A.topLeftCorner(n, n), A_q = model.A.block(n, 0, n, n),
                        A_u = model.A.block(n, n, n, n);
  return {model.mass, -model.mass * (A_u + T), model.mass * (A_u * T - A_q), model.mass * model.B.middleRows(n, n),
          model.mass * model.A.block(n, 2 * n, n, nz)};
}

}  // namespace bough::records
