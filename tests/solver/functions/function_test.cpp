// Functions of time against closed forms and finite differences; every fault of a record is reported.
#include "solver/functions/function.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bough::solver {
namespace {

using records::FunctionRecord;

FunctionRecord make_record(const std::string& type, std::map<std::string, double> values = {}) {
  FunctionRecord r;
  r.name = "f";
  r.type = type;
  r.values = std::move(values);
  r.at = {"system.toml", 7, 1};
  return r;
}

FunctionRecord make_table(std::vector<double> x, std::vector<double> y, const std::string& interpolation) {
  FunctionRecord r = make_record("table");
  r.x = std::move(x);
  r.y = std::move(y);
  r.interpolation = interpolation;
  return r;
}

std::unique_ptr<const TimeFunction> make(const FunctionRecord& r) {
  Diagnostics diagnostics;
  auto f = make_time_function(r, diagnostics);
  EXPECT_EQ(diagnostics.num_errors(), 0) << format(diagnostics.items().empty() ? Diagnostic{} : diagnostics.items()[0]);
  return f;
}

/// The derivatives agree with central differences of f at t.
void check_derivatives(const TimeFunction& f, double t) {
  const double h = 1e-3;
  const auto at = [&](double dt) { return f.calc(t + dt).f; };
  const auto v = f.calc(t);
  // Fourth-order formulas: error h⁴ f⁽⁵⁾/30 and h⁴ f⁽⁶⁾/90, rounding 1e-16/h².
  EXPECT_NEAR(v.f_dot, (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h), 1e-9);
  EXPECT_NEAR(v.f_ddot, (16 * (at(h) + at(-h)) - (at(2 * h) + at(-2 * h)) - 30 * at(0)) / (12 * h * h), 2e-8);
}

TEST(TimeFunction, Values) {
  EXPECT_EQ(make(make_record("constant", {{"value", 3}}))->calc(8).f, 3);

  const auto step = make(make_record("step", {{"value", 2}, {"at", 1}, {"before", -1}}));
  EXPECT_EQ(step->calc(std::nextafter(1, 0)).f, -1);
  EXPECT_EQ(step->calc(1).f, 2);
  EXPECT_THAT(step->jump_times(), ::testing::ElementsAre(1));

  const auto ramp = make(make_record("ramp", {{"value", 6}, {"from", 1}, {"to", 3}}));
  EXPECT_EQ(ramp->calc(0.5).f, 0);
  EXPECT_EQ(ramp->calc(2).f, 3);
  EXPECT_EQ(ramp->calc(2).f_dot, 3);
  EXPECT_EQ(ramp->calc(9).f, 6);
  EXPECT_EQ(ramp->calc(9).f_dot, 0);
  EXPECT_THAT(ramp->jump_times(), ::testing::ElementsAre(1, 3));

  const auto pulse = make(make_record("pulse", {{"value", 5}, {"at", 2}, {"width", 0.5}}));
  EXPECT_EQ(pulse->calc(1.99).f, 0);
  EXPECT_EQ(pulse->calc(2).f, 5);
  EXPECT_EQ(pulse->calc(2.5).f, 0);
  EXPECT_THAT(pulse->jump_times(), ::testing::ElementsAre(2, 2.5));
}

TEST(TimeFunction, SineAndItsDerivatives) {
  const auto omega = make(make_record("sine", {{"amplitude", 2}, {"omega", 3}, {"phase", 0.4}, {"offset", 1}}));
  EXPECT_DOUBLE_EQ(omega->calc(0.7).f, 1 + 2 * std::sin(2.5));
  for (double t : {-1.0, 0.0, 2.3}) check_derivatives(*omega, t);
  const auto hertz = make(make_record("sine", {{"amplitude", 1}, {"frequency_hz", 0.25}}));
  EXPECT_NEAR(hertz->calc(1).f, 1, 1e-15);
}

TEST(TimeFunction, SpinupFollowsTheReport) {
  const double w = 4, T = 15, pi = std::acos(-1.0);
  const auto f = make(make_record("spinup", {{"rate", w}, {"duration", T}}));
  for (double t : {0.5, 3.0, 7.5, 14.0}) {
    const double a = T / (2 * pi);
    EXPECT_NEAR(f->calc(t).f, w / T * (t * t / 2 + a * a * (std::cos(t / a) - 1)), 1e-12);
    check_derivatives(*f, t);
  }
  // Everything but the third derivative is continuous at T.
  const auto before = f->calc(std::nextafter(T, 0)), after = f->calc(T);
  EXPECT_NEAR(before.f, after.f, 1e-12);
  EXPECT_NEAR(before.f_dot, after.f_dot, 1e-13);
  EXPECT_NEAR(before.f_ddot, after.f_ddot, 1e-13);
  EXPECT_EQ(f->calc(20).f, w * (20 - T / 2));
  EXPECT_EQ(f->calc(20).f_dot, w);
  EXPECT_THAT(f->jump_times(), ::testing::ElementsAre(0, T));
}

TEST(TimeFunction, LinearTable) {
  const auto f = make(make_table({0, 1, 3}, {2, 4, 0}, "linear"));
  EXPECT_EQ(f->calc(0.5).f, 3);
  EXPECT_EQ(f->calc(2).f, 2);
  EXPECT_EQ(f->calc(2).f_dot, -2);
  EXPECT_EQ(f->calc(1).f_dot, -2);  // the slope after the point
  EXPECT_EQ(f->calc(-5).f, 2);      // the end values hold outside
  EXPECT_EQ(f->calc(5).f, 0);
  EXPECT_EQ(f->calc(5).f_dot, 0);
  EXPECT_THAT(f->jump_times(), ::testing::ElementsAre(0, 1, 3));
}

// A force restarts the integrator at the kinks of a table, not at every point of a sampled curve; and no step passes
// over a short event in a long rest.
TEST(TimeFunction, CornersAndLandmarksOfTables) {
  std::vector<double> x, y;
  for (int i = 0; i <= 5000; ++i) {
    x.push_back(1e-3 * i);
    y.push_back(std::sin(2 * x.back()));
  }
  const auto sampled = make(make_table(x, y, "linear"));
  EXPECT_EQ(sampled->jump_times().size(), 5001u);
  EXPECT_THAT(sampled->force_jump_times(), ::testing::ElementsAre(0, 5));
  EXPECT_GT(sampled->mesh_times().size(), 8u);
  EXPECT_LT(sampled->mesh_times().size(), 40u);
  const auto triangle = make(make_table({0, 50, 50.01, 50.02, 100}, {0, 0, 1, 0, 0}, "linear"));
  EXPECT_THAT(triangle->force_jump_times(), ::testing::ElementsAre(0, 50, 50.01, 50.02, 100));
  // A smooth bump of a hundredth of a second in a hundred seconds.
  x = {0};
  y = {0};
  for (int i = -100; i <= 100; ++i) {
    x.push_back(50 + 1e-4 * i);
    y.push_back(std::exp(-std::pow(i / 25.0, 2)));
  }
  x.push_back(100);
  y.push_back(0);
  for (const char* interpolation : {"linear", "cubic"}) {
    const auto mesh_times = make(make_table(x, y, interpolation))->mesh_times();
    ASSERT_GE(mesh_times.size(), 4u);
    EXPECT_GT(mesh_times.front(), 49.99);
    EXPECT_LT(mesh_times.front(), 50);
  }
}

TEST(TimeFunction, CubicTableReproducesCubics) {
  const auto p = [](double x) { return 2 - x + 3 * x * x - 0.5 * x * x * x; };
  for (const std::vector<double>& x : {std::vector<double>{0, 1, 2.5, 3}, {0, 0.3, 1.1, 2, 4, 4.5}}) {
    std::vector<double> y;
    for (double xi : x) y.push_back(p(xi));
    const auto f = make(make_table(x, y, "cubic"));
    for (double t = x.front(); t < x.back(); t += 0.237) {
      EXPECT_NEAR(f->calc(t).f, p(t), 1e-12);
      EXPECT_NEAR(f->calc(t).f_dot, -1 + 6 * t - 1.5 * t * t, 1e-11);
      EXPECT_NEAR(f->calc(t).f_ddot, 6 - 3 * t, 1e-10);
    }
  }
  const auto parabola = make(make_table({0, 1, 3}, {0, 1, 9}, "cubic"));
  EXPECT_NEAR(parabola->calc(2).f, 4, 1e-14);
  const auto line = make(make_table({0, 2}, {0, 3}, "cubic"));
  EXPECT_NEAR(line->calc(1).f, 1.5, 1e-14);
}

TEST(TimeFunction, CubicTableConvergesWithOrderFour) {
  const auto error = [](int n) {
    std::vector<double> x, y;
    for (int i = 0; i <= n; ++i) {
      x.push_back(3.0 * i / n);
      y.push_back(std::sin(x.back()));
    }
    const auto f = make(make_table(x, y, "cubic"));
    double worst = 0;
    for (double t = 0; t < 3; t += 0.00037) worst = std::max(worst, std::abs(f->calc(t).f - std::sin(t)));
    return worst;
  };
  EXPECT_NEAR(std::log2(error(80) / error(160)), 4, 0.2);
}

TEST(TimeFunction, DoubletHasNoMean) {
  const auto f = make(make_record("doublet", {{"value", 2}, {"at", 1}, {"width", 0.5}}));
  EXPECT_EQ(f->calc(std::nextafter(1, 0)).f, 0);
  EXPECT_EQ(f->calc(1).f, 2);
  EXPECT_EQ(f->calc(1.5).f, -2);
  EXPECT_EQ(f->calc(2).f, 0);
  EXPECT_THAT(f->jump_times(), ::testing::ElementsAre(1, 1.5, 2));
}

std::unique_ptr<const TimeFunction> make_in(const FunctionRecord& r, double start, double end,
                                            const FunctionMap& others = {}) {
  Diagnostics diagnostics;
  auto f = make_time_function(r, diagnostics, {start, end}, others);
  EXPECT_EQ(diagnostics.num_errors(), 0) << format(diagnostics.items().empty() ? Diagnostic{} : diagnostics.items()[0]);
  return f;
}

TEST(TimeFunction, SawtoothFallsAtItsBreakpoints) {
  const auto f =
      make_in(make_record("sawtooth", {{"amplitude", 3}, {"frequency_hz", 10}, {"at", 0.02}, {"offset", 1}}), -0.3, 1);
  for (const double t : f->jump_times()) {
    EXPECT_EQ(f->calc(t).f, 1 - 3) << t;  // to the last bit at each jump, whatever t / period rounds to
    EXPECT_NEAR(f->calc(std::nextafter(t, -1)).f, 1 + 3, 1e-12) << t;
  }
  EXPECT_EQ(f->jump_times().size(), 14u);  // -0.38, -0.28, ... 0.92
  EXPECT_NEAR(f->calc(0.07).f, 1, 1e-12);
  EXPECT_NEAR(f->calc(0.07).f_dot, 60, 1e-9);
}

TEST(TimeFunction, TriangleIsContinuous) {
  const auto f = make_in(make_record("sawtooth", {{"amplitude", 2}, {"frequency_hz", 0.5}, {"rise", 0.25}}), 0, 6);
  EXPECT_NEAR(f->calc(0.25).f, 0, 1e-15);
  EXPECT_EQ(f->calc(0.25).f_dot, 8);
  EXPECT_NEAR(f->calc(0.5).f, 2, 1e-15);
  EXPECT_NEAR(f->calc(1.25).f, 0, 1e-15);
  for (const double t : f->jump_times()) EXPECT_NEAR(f->calc(t).f, f->calc(std::nextafter(t, -1)).f, 1e-12) << t;
  EXPECT_THAT(f->jump_times(), ::testing::ElementsAre(0, 0.5, 2, 2.5, 4, 4.5, 6, 6.5));
}

TEST(TimeFunction, SweepsFromOneFrequencyToTheOther) {
  const std::map<std::string, double> values = {{"amplitude", 0.5}, {"from_hz", 0.2}, {"to_hz", 1.6}, {"at", 1},
                                                {"duration", 6},    {"phase", 0.3},   {"offset", 2}};
  const double pi = std::acos(-1.0);
  auto linear = make_record("sweep", values);
  linear.law = "linear";
  for (const auto& r : {make_record("chirp", values), make_record("sweep", values), linear}) {
    const auto f = make(r);
    for (const double t : {1.5, 3.0, 6.2}) check_derivatives(*f, t);
    EXPECT_NEAR(f->calc(1).f_dot, 0.5 * 2 * pi * 0.2 * std::cos(0.3), 1e-12);
    EXPECT_EQ(f->calc(0.9).f, 2);
    EXPECT_EQ(f->calc(7).f, 2);
    EXPECT_THAT(f->jump_times(), ::testing::ElementsAre(1, 7));
    // Cycles by closed form: T (f0 + f1) / 2, and T (f1 - f0) / ln(f1 / f0) by octaves.
    const bool is_log = r.type == "sweep" && r.law == "logarithmic";
    const double cycles = is_log ? 6 * 1.4 / std::log(8) : 6 * 0.9;
    EXPECT_NEAR(f->calc(std::nextafter(7, 0)).f, 2 + 0.5 * std::sin(2 * pi * cycles + 0.3), 1e-11);
  }
}

FunctionRecord make_formula(const std::string& f, const std::string& first = "", const std::string& second = "") {
  FunctionRecord r = make_record("expression");
  r.expression = f;
  r.first = first;
  r.second = second;
  return r;
}

TEST(TimeFunction, ExpressionIsAFormula) {
  const auto f = make(make_formula("2*sin(3*t) + t^2", "6*cos(3*t) + 2*t", "2 - 18*sin(3*t)"));
  EXPECT_DOUBLE_EQ(f->calc(0.7).f, 2 * std::sin(2.1) + 0.49);
  check_derivatives(*f, 0.7);
  EXPECT_TRUE(f->has_derivatives());
  auto jumps = make_formula("step(t - 1) * pi");
  jumps.x = {1};
  const auto g = make(jumps);
  EXPECT_FALSE(g->has_derivatives());
  EXPECT_EQ(g->calc(1).f, std::acos(-1.0));
  EXPECT_EQ(g->calc(std::nextafter(1, 0)).f, 0);
  EXPECT_THAT(g->jump_times(), ::testing::ElementsAre(1));
}

TEST(TimeFunction, DerivativesOfAnExpressionAreChecked) {
  Diagnostics diagnostics;
  EXPECT_EQ(make_time_function(make_formula("sin(t)", "cos(t)", "sin(t)"), diagnostics, {0, 10}), nullptr);
  ASSERT_EQ(diagnostics.num_errors(), 1);
  EXPECT_EQ(diagnostics.items()[0].id, "function.bad-value");
  EXPECT_THAT(format(diagnostics.items()[0]), ::testing::HasSubstr("acceleration"));
  // Formulas of different scales, with a kink that is reported, and stiff ones.
  auto corner = make_formula("t < 2 ? t^3 : 8 + 100*(t - 2)", "t < 2 ? 3*t^2 : 100", "t < 2 ? 6*t : 0");
  corner.x = {2};
  make_in(corner, 0, 5);
  make_in(make_formula("1e6 + 1e-3*sin(200*t)", "0.2*cos(200*t)", "-40*sin(200*t)"), 0, 20);
  make_in(make_formula("exp(-50*t)", "-50*exp(-50*t)", "2500*exp(-50*t)"), 0, 10);
}

TEST(TimeFunction, SumAndProduct) {
  const auto a = make(make_record("sine", {{"amplitude", 2}, {"omega", 3}}));
  const auto b = make(make_record("sine", {{"amplitude", 1}, {"omega", 0.7}, {"phase", 1}}));
  const auto c = make(make_record("step", {{"value", 1}, {"at", 2}}));
  const FunctionMap others = {{"a", a.get()}, {"b", b.get()}, {"c", c.get()}};
  auto sum = make_record("sum"), product = make_record("product", {{"gain", -2}});
  sum.of = {"a", "b", "c"};
  sum.weights = {1, -3, 0.5};
  product.of = {"a", "b", "a"};
  const auto s = make_in(sum, 0, 5, others), p = make_in(product, 0, 5, others);
  EXPECT_DOUBLE_EQ(s->calc(1).f, a->calc(1).f - 3 * b->calc(1).f);
  EXPECT_DOUBLE_EQ(p->calc(1).f, -2 * a->calc(1).f * a->calc(1).f * b->calc(1).f);
  for (const double t : {0.4, 1.1, 3.3}) {
    check_derivatives(*s, t);
    check_derivatives(*p, t);
  }
  EXPECT_THAT(s->jump_times(), ::testing::ElementsAre(2));
}

struct Fault {
  FunctionRecord record;
  std::string id, text;
};

TEST(TimeFunction, FaultsAreReported) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Fault> faults = {
      {make_record("spinnup", {{"rate", 1}}), "function.unknown-type", "did you mean 'spinup'?"},
      {make_table({0, 1}, {0, 1}, "cubik"), "function.unknown-type", "did you mean 'cubic'?"},
      {make_record("ramp", {{"value", 1}}), "function.missing-parameter", "has no 'to'"},
      {make_record("pulse", {{"value", 1}, {"width", 1}, {"widt", 1}}), "function.unknown-parameter",
       "did you mean 'width'?"},
      {make_record("sine", {{"amplitude", 1}, {"omega", 1}, {"frequency_hz", 1}}), "function.unknown-parameter",
       "both"},
      {make_record("constant", {{"value", nan}}), "function.nan", "not a finite number"},
      {make_table({0, 1, 2}, {0, nan, 1}, "linear"), "function.nan", "y entry 2"},
      {make_table({0, 2, 1}, {0, 1, 2}, "linear"), "function.unsorted", "x entry 3 (1)"},
      {make_table({0, 1}, {0, 1, 2}, "linear"), "function.table-size", "2 x and 3 y"},
      {make_table({0}, {0}, "cubic"), "function.table-size", "1 x and 1 y"},
      {make_record("spinup", {{"rate", 1}, {"duration", 0}}), "function.bad-value", "duration"},
      {make_record("pulse", {{"value", 1}, {"width", -1}}), "function.bad-value", "width"},
      {make_record("ramp", {{"value", 1}, {"from", 2}, {"to", 2}}), "function.bad-value", "ends"},
      {make_record("doublet", {{"value", 1}, {"width", 0}}), "function.bad-value", "width"},
      {make_record("sawtooth", {{"amplitude", 1}, {"frequency_hz", 1}, {"rise", 1.5}}), "function.bad-value", "rise"},
      {make_record("sweep", {{"amplitude", 1}, {"from_hz", 0}, {"to_hz", 1}, {"duration", 1}}), "function.bad-value",
       "octaves"},
      {make_record("expression"), "function.missing-parameter", "expression"},
      {make_formula("sin(t", "", ""), "control.bad-expression", "sin(t"},
      {make_formula("sin(t)", "cos(t)", ""), "function.missing-parameter", "acceleration"},
      {make_record("sum"), "function.missing-parameter", "has no 'of'"},
  };
  for (const Fault& fault : faults) {
    Diagnostics diagnostics;
    EXPECT_EQ(make_time_function(fault.record, diagnostics), nullptr);
    ASSERT_EQ(diagnostics.num_errors(), 1) << fault.text;
    EXPECT_EQ(diagnostics.items()[0].id, fault.id);
    EXPECT_EQ(diagnostics.items()[0].where.line, 7);
    EXPECT_THAT(format(diagnostics.items()[0]), ::testing::HasSubstr(fault.text));
  }
}

TEST(TimeFunction, AllFaultsOfARecordAreReported) {
  Diagnostics diagnostics;
  make_time_function(make_record("ramp", {{"slope", 1}}), diagnostics);
  EXPECT_EQ(diagnostics.num_errors(), 3);  // value and to are missing, slope is unknown
}

}  // namespace
}  // namespace bough::solver
