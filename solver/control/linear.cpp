#include "solver/control/linear.hpp"

#include "solver/control/makers.hpp"

namespace bough::solver {
namespace {

using Eigen::Map;

/// ẋ = A x + B u, or x' = A x + B u at samples; y = C x + D u.
class LinearBlock final : public Block {
 public:
  LinearBlock(StateSpace s, bool is_sampled) : s_(std::move(s)), is_sampled_(is_sampled) {
    const int n = static_cast<int>(s_.A.rows());
    sizes.inputs = static_cast<int>(s_.D.cols());
    sizes.outputs = static_cast<int>(s_.D.rows());
    (is_sampled ? sizes.memory : sizes.states) = n;
    sizes.has_feedthrough = !s_.D.isZero(0);
    initial = VectorXd::Zero(n);
  }

  VectorXd initial;

  void start(double* z, double* d) const override { Map<VectorXd>(is_sampled_ ? d : z, initial.size()) = initial; }
  void calc_outputs(const BlockInput& in, double* y) const override {
    Map<VectorXd> out(y, sizes.outputs);
    out.noalias() = s_.D * get_input(in);
    if (s_.A.rows() > 0) out.noalias() += s_.C * get_state(in);
  }
  void calc_rates(const BlockInput& in, double* z_dot) const override { advance(in, z_dot); }
  void update(const BlockInput& in, double* d) const override { advance(in, d); }

 private:
  Map<const VectorXd> get_input(const BlockInput& in) const { return {in.u, sizes.inputs}; }
  Map<const VectorXd> get_state(const BlockInput& in) const { return {is_sampled_ ? in.d : in.z, s_.A.rows()}; }
  void advance(const BlockInput& in, double* to) const {
    if (s_.A.rows() == 0) return;
    Map<VectorXd> out(to, s_.A.rows());
    out.noalias() = s_.A * get_state(in);
    out.noalias() += s_.B * get_input(in);
  }

  StateSpace s_;
  bool is_sampled_;
};

std::unique_ptr<Block> make_rational(SettingsReader& keys, const ControllerWiring& wiring, const VectorXd& num,
                                     const VectorXd& den, double discretized_at, bool is_sampled) {
  if (num.size() > den.size()) {
    keys.error("control.bad-value", "has a numerator of higher degree than the denominator",
               "give the denominator another pole");
  } else if (den.size() == 0 || den[0] == 0) {
    keys.error("control.bad-value", "has a denominator whose first number is zero", "leave the zero out");
  }
  if (keys.has_failed()) return nullptr;
  StateSpace s = make_canonical_form(num, den);
  if (discretized_at > 0) s = discretize_bilinear(s, discretized_at);
  return std::make_unique<LinearBlock>(repeat(s, wiring.size()), is_sampled);
}

VectorXd to_vector(const std::vector<double>& list) {
  return Map<const VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
}

}  // namespace

StateSpace make_canonical_form(const VectorXd& num, const VectorXd& den) {
  const Eigen::Index n = den.size() - 1;
  const VectorXd a = den / den[0];
  VectorXd b = VectorXd::Zero(n + 1);
  b.tail(num.size()) = num / den[0];
  StateSpace s{MatrixXd::Zero(n, n), MatrixXd::Zero(n, 1), MatrixXd::Zero(1, n), MatrixXd::Constant(1, 1, b[0])};
  if (n == 0) return s;
  s.A.row(0) = -a.tail(n).transpose();
  s.A.bottomLeftCorner(n - 1, n - 1).setIdentity();
  s.B(0, 0) = 1;
  s.C = (b.tail(n) - b[0] * a.tail(n)).transpose();
  return s;
}

StateSpace discretize_bilinear(const StateSpace& c, double T) {
  const Eigen::Index n = c.A.rows();
  const MatrixXd I = MatrixXd::Identity(n, n);
  const MatrixXd left_side = I - 0.5 * T * c.A;
  const Eigen::PartialPivLU<MatrixXd> left(left_side), right(MatrixXd(left_side.transpose()));
  StateSpace d;
  d.A = left.solve(I + 0.5 * T * c.A);
  d.B = left.solve(T * c.B);
  d.C = right.solve(MatrixXd(c.C.transpose())).transpose();
  d.D = c.D + 0.5 * d.C * (T * c.B);
  return d;
}

StateSpace repeat(const StateSpace& one, int n) {
  const auto spread = [n](const MatrixXd& m) {
    MatrixXd all = MatrixXd::Zero(n * m.rows(), n * m.cols());
    for (int i = 0; i < n; ++i) all.block(i * m.rows(), i * m.cols(), m.rows(), m.cols()) = m;
    return all;
  };
  return {spread(one.A), spread(one.B), spread(one.C), spread(one.D)};
}

std::unique_ptr<Block> make_transfer_function(SettingsReader& keys, const ControllerWiring& wiring, bool is_sampled) {
  const VectorXd num = to_vector(keys.get_list("numerator")), den = to_vector(keys.get_list("denominator"));
  return make_rational(keys, wiring, num, den, 0, is_sampled);
}

std::unique_ptr<Block> make_notch(SettingsReader& keys, const ControllerWiring& wiring, double sample_time) {
  // (s² + 2 ζ_n ω s + ω²) / (s² + 2 ζ_d ω s + ω²)
  const double w = 2 * EIGEN_PI * keys.get_positive("frequency_hz"), depth = keys.get_size("zero_damping", 0),
               width = keys.get_positive("pole_damping");
  return make_rational(keys, wiring, Vector3d(1, 2 * depth * w, w * w), Vector3d(1, 2 * width * w, w * w), sample_time,
                       sample_time > 0);
}

std::unique_ptr<Block> make_lead_lag(SettingsReader& keys, const ControllerWiring& wiring, double sample_time) {
  // K (1 + T₁ s) / (1 + T₂ s)
  const double gain = keys.get("gain", 1), lead = keys.get("lead"), lag = keys.get_positive("lag");
  return make_rational(keys, wiring, Eigen::Vector2d(gain * lead, gain), Eigen::Vector2d(lag, 1), sample_time,
                       sample_time > 0);
}

std::unique_ptr<Block> make_state_space(SettingsReader& keys, const ControllerWiring& wiring, bool is_sampled) {
  const int m = wiring.size();
  StateSpace s;
  s.A = keys.get_matrix("A", -1, -1);
  const int n = static_cast<int>(s.A.rows());
  if (s.A.rows() != s.A.cols()) keys.error("control.bad-size", "has an A that is not square", "give it row by row");
  s.B = keys.get_matrix("B", n, m);
  s.C = keys.get_matrix("C", -1, n);
  s.D = keys.get_matrix("D", keys.has("C") ? static_cast<int>(s.C.rows()) : -1, m);
  if (!keys.has("C") && !keys.has("D")) keys.error("control.missing-key", "has neither C nor D", "give the matrices");
  if (n > 0 && (!keys.has("B") || !keys.has("C")))
    keys.error("control.missing-key", "has an A without B or C", "give the matrices");
  const VectorXd initial = keys.get_vector("initial", n, 0);
  if (keys.has_failed()) return nullptr;
  if (!keys.has("C")) s.C = MatrixXd::Zero(s.D.rows(), n);
  if (!keys.has("D")) s.D = MatrixXd::Zero(s.C.rows(), m);
  if (!keys.has("B")) s.B = MatrixXd::Zero(n, m);
  auto made = std::make_unique<LinearBlock>(std::move(s), is_sampled);
  made->initial = initial;
  return made;
}

std::unique_ptr<Block> make_gain(SettingsReader& keys, const ControllerWiring& wiring) {
  const int m = wiring.size();
  MatrixXd D;
  if (keys.has_matrix("gain")) {
    D = keys.get_matrix("gain", -1, m);
  } else {
    D = keys.get_vector("gain", m).asDiagonal();
  }
  if (keys.has_failed()) return nullptr;
  return std::make_unique<LinearBlock>(StateSpace{MatrixXd(0, 0), MatrixXd(0, m), MatrixXd(D.rows(), 0), D}, false);
}

std::unique_ptr<Block> make_sum(SettingsReader& keys, const ControllerWiring& wiring) {
  const int groups = static_cast<int>(wiring.inputs.size());
  const VectorXd weights = keys.get_vector("weights", groups, 1);
  if (!wiring.are_alike())
    keys.error("control.bad-size", "adds inputs of different sizes", "name single components, as tip:x");
  if (keys.has_failed() || groups == 0) return nullptr;
  const int n = wiring.inputs.front();
  MatrixXd D = MatrixXd::Zero(n, n * groups);
  for (int g = 0; g < groups; ++g) D.middleCols(n * g, n) = weights[g] * MatrixXd::Identity(n, n);
  return std::make_unique<LinearBlock>(StateSpace{MatrixXd(0, 0), MatrixXd(0, D.cols()), MatrixXd(n, 0), D}, false);
}

}  // namespace bough::solver
