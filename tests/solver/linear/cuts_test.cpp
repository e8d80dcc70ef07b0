// Loops cut at a signal, and multipliers of sampled loops, against hand equations.
#include "solver/linear/linearize.hpp"
#include "solver/statespace/frequency_response.hpp"
#include "tests/solver/control/support.hpp"

namespace bough::solver::testing {
namespace {

records::LinearModel linearize_initial(const records::SystemSpec& spec, const LinearizeOptions& options = {}) {
  const System system = build(spec);
  Plant plant(system);
  Diagnostics diagnostics;
  return linearize(plant, plant.make_initial_point(), options, {}, diagnostics);
}

std::complex<double> calc(const records::LinearModel& m, std::complex<double> s) {
  return statespace::TransferMatrix(m.A, m.B, m.C, m.D).calc(s)(0, 0);
}

/// J θ̈ = u, u = -kp θ - kd θ̇ through a lag of the law: cut anywhere on the one way round it is the same loop.
TEST(Cut, TheLoopIsTheSameAtTheActuatorAndAtTheController) {
  auto spec = make_axis();
  const double kp = 6, kd = 4, tau = 0.1, J = 2;
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {kp}}, {"kd", {kd}}, {"filter", {tau}}})};
  for (const std::string cut : {"drive", "law", "angle"}) {
    const auto m = linearize_initial(spec, {{}, {}, true, cut});
    EXPECT_EQ(m.inputs.name, std::vector<std::string>{cut});
    EXPECT_EQ(m.outputs.name, std::vector<std::string>{cut + ":return"});
    for (const std::complex<double> s : {std::complex<double>(0, 0.7), {0, 12.0}, {0.3, 2.0}}) {
      const auto L = (kp + kd * s / (1.0 + tau * s)) / (J * s * s);
      EXPECT_LT(std::abs(calc(m, s) - L), 1e-9 * std::abs(L)) << cut;
    }
  }
}

TEST(Cut, OfTwoLoopsTheOtherStaysClosed) {
  auto spec = make_axis();
  const double kp = 8, kd = 1.6, J = 2;
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {kp}}, {"kd", {kd}}})};
  spec.controllers[0].rate = "rate";
  const auto m = linearize_initial(spec, {{}, {}, true, "rate"});
  for (const std::complex<double> s : {std::complex<double>(0, 0.7), {0, 12.0}}) {
    const auto L = kd * s / (J * s * s + kp);
    EXPECT_LT(std::abs(calc(m, s) - L), 1e-9 * std::abs(L));
  }
}

TEST(Cut, NamesAreChecked) {
  auto spec = make_axis();
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {8}}})};
  try {
    linearize_initial(spec, {{}, {}, true, "drives"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.items()[0].id, "linear.unknown-signal");
    EXPECT_NE(error.items()[0].advice.find("drive"), std::string::npos);
  }
}

/// y follows -1 times itself at once: the law's output is subtracted from what a force needs.
TEST(Cut, SignalsAreInputsAndOutputs) {
  auto spec = make_axis();
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {8}}, {"kd", {1.6}}})};
  spec.controllers[0].rate = "rate";
  const auto m = linearize_initial(spec, {{"angle", "rate"}, {"law", "drive", "drive:command", "angle"}});
  // An addition to the measured angle acts by kp, to the rate by kd; the angle itself is the true one.
  MatrixXd B(2, 2), D(4, 2), C(4, 2);
  B << 0, 0, -4, -0.8;
  D << -8, -1.6, -8, -1.6, -8, -1.6, 0, 0;
  C << -8, -1.6, -8, -1.6, -8, -1.6, 1, 0;
  EXPECT_LT((m.B - B).norm(), 1e-9) << m.B;
  EXPECT_LT((m.D - D).norm(), 1e-9) << m.D;
  EXPECT_LT((m.C - C).norm(), 1e-9) << m.C;
  EXPECT_EQ(m.outputs.name, (std::vector<std::string>{"law", "drive", "drive:command", "angle"}));
}

std::vector<double> sort_sizes(const Eigen::VectorXcd& values, int power) {
  std::vector<double> sizes;
  for (const auto& v : values)
    if (std::abs(v) > 1e-4) sizes.push_back(std::pow(std::abs(v), power));
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

/// θ, ω and the outputs on their way: eigenvalues of the recursion by hand.
TEST(Multipliers, OfASampledLawWithDelayAreThoseOfItsRecursion) {
  const double T = 0.1, kp = 4, kd = 3, J = 2;
  for (const double delay : {0.0, 0.06, 0.1, 0.23}) {
    auto spec = make_axis();
    spec.controllers = {make_law("law", "gain", {"angle", "rate"}, {{"sample_time", {T}}, {"delay", {delay}}})};
    spec.controllers[0].settings.matrices["gain"] = (MatrixXd(1, 2) << -kp, -kd).finished();
    const auto m = linearize_initial(spec);
    // In [kT, kT + part) acts u_(k-whole-1), then u_(k-whole).
    const int whole = static_cast<int>(std::floor(delay / T + 1e-9));
    const double part = delay - whole * T;
    const auto flow = [&](double h) { return (MatrixXd(2, 2) << 1, h, 0, 1).finished(); };
    const auto push = [&](double h) { return VectorXd((VectorXd(2) << h * h / 2 / J, h / J).finished()); };
    const int n = 2 + whole + 1;
    const Eigen::RowVector2d gain(-kp, -kd);
    MatrixXd map = MatrixXd::Zero(n, n);  // θ, ω, u_(k-1), u_(k-2), ...
    map.topLeftCorner(2, 2) = flow(T);
    const auto add = [&](int age, const VectorXd& by) {
      if (age == 0)
        map.topLeftCorner(2, 2) += by * gain;
      else
        map.col(1 + age).head(2) += by;
    };
    add(whole, push(T - part));
    if (part > 1e-12) add(whole + 1, flow(T - part) * push(part));
    map.block(2, 0, 1, 2) = gain;
    for (int i = 3; i < n; ++i) map(i, i - 1) = 1;
    const int power = static_cast<int>(std::lround(m.multipliers.period / T));
    ASSERT_GE(power, 1);
    EXPECT_NEAR(m.multipliers.period, power * T, 1e-12);
    Eigen::VectorXcd found(m.multipliers.real.size());
    found.real() = m.multipliers.real;
    found.imag() = m.multipliers.imag;
    const auto expected = sort_sizes(map.eigenvalues(), power);
    std::vector<double> sizes;
    for (const double size : sort_sizes(found, 1)) sizes.push_back(size);
    std::vector<double> wanted;
    for (const double size : expected)
      if (size > 1e-4) wanted.push_back(size);
    ASSERT_EQ(sizes.size(), wanted.size()) << delay << " period " << m.multipliers.period;
    for (size_t i = 0; i < sizes.size(); ++i) EXPECT_NEAR(sizes[i], wanted[i], 1e-8) << delay;
    EXPECT_NEAR(m.multipliers.decay[0], std::log(sizes.back()) / m.multipliers.period, 1e-7);
  }
}

TEST(Multipliers, TwoRatesHaveTheirCommonPeriod) {
  // ω̇ = (a + b) / J with a = -ka ω every 0.1, b = -kb ω every 0.15: over 0.3 three and two samples.
  auto spec = make_axis();
  const double ka = 3, kb = 2, J = 2;
  spec.controllers = {make_law("a", "gain", {"rate"}, {{"sample_time", {0.1}}, {"gain", {-ka}}}),
                      make_law("b", "gain", {"rate"}, {{"sample_time", {0.15}}, {"gain", {-kb}}})};
  spec.actuators = {make_drive("da", "axis", "a"), make_drive("db", "axis", "b")};
  const auto m = linearize_initial(spec);
  EXPECT_NEAR(m.multipliers.period, 0.3, 1e-12);
  EXPECT_EQ(m.multipliers.num_samples, 4);
  double w = 1, held_a = 0, held_b = 0;
  for (const auto& [to, a, b] :
       {std::tuple(0.1, true, true), {0.15, true, false}, {0.2, false, true}, {0.3, true, false}}) {
    const double from = to == 0.1 ? 0 : to == 0.15 ? 0.1 : to == 0.2 ? 0.15 : 0.2;
    if (a) held_a = -ka * w;
    if (b) held_b = -kb * w;
    w += (to - from) * (held_a + held_b) / J;
  }
  // The angle drifts (1); the rate has the one multiplier that is neither 1 nor 0.
  std::vector<double> sizes;
  for (Eigen::Index i = 0; i < m.multipliers.real.size(); ++i)
    if (std::abs(m.multipliers.real[i]) > 1e-9 && std::abs(m.multipliers.real[i] - 1) > 1e-6)
      sizes.push_back(m.multipliers.real[i]);
  ASSERT_EQ(sizes.size(), 1u);
  EXPECT_NEAR(sizes[0], w, 1e-9);
}

TEST(Multipliers, ThereAreNoneWithoutSamplesAndWithoutACommonPeriod) {
  auto spec = make_axis();
  spec.controllers = {make_law("law", "pid", {"angle"}, {{"kp", {8}}})};
  EXPECT_EQ(linearize_initial(spec).multipliers.period, 0);
  spec.controllers = {make_law("a", "gain", {"rate"}, {{"sample_time", {0.1}}, {"gain", {-1}}}),
                      make_law("b", "gain", {"rate"}, {{"sample_time", {0.1 * std::sqrt(2)}}, {"gain", {-1}}})};
  spec.actuators = {make_drive("da", "axis", "a"), make_drive("db", "axis", "b")};
  const System system = build(spec);
  Plant plant(system);
  Diagnostics diagnostics;
  EXPECT_EQ(linearize(plant, plant.make_initial_point(), {}, {}, diagnostics).multipliers.period, 0);
  EXPECT_TRUE(diagnostics.has("linear.no-common-period"));
}

}  // namespace
}  // namespace bough::solver::testing
