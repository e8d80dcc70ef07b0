// Threads that share a System, each with a SystemData: what one evaluates does not depend on the others.
#include <thread>

#include "tests/solver/control/support.hpp"

namespace bough::solver::testing {
namespace {

constexpr int kEvaluations = 3000;
constexpr int kTerms = 400;

/// Accelerations at (t, initial state) that differ from those of the first evaluation, on a thread for each time; the
/// first ones are compared with `expected`(t).
int count_wrong(const System& system, const std::vector<double>& times, const std::function<double(double)>& expected) {
  std::vector<int> wrong(times.size(), 0);
  std::vector<std::thread> threads;
  for (size_t k = 0; k < times.size(); ++k) {
    threads.emplace_back([&, k] {
      const auto data = system.make_data();
      VectorXd q(system.num_q()), u(system.num_u());
      system.calc_initial_state(q, u);
      for (int i = 0; i < kEvaluations; ++i) {
        const VectorXd u_dot = calc_u_dot(system, *data, times[k], q, u);
        if (!(std::abs(u_dot[0] - expected(times[k])) < 1e-9)) ++wrong[k];
      }
    });
  }
  for (auto& thread : threads) thread.join();
  int all = 0;
  for (const int n : wrong) all += n;
  return all;
}

/// min(v, 9) + min(v, 9) + ...: kTerms of v, long enough to evaluate that threads meet within it.
std::string make_long_sum(const std::string& v) {
  std::string text;
  for (int i = 0; i < kTerms; ++i) text += (i == 0 ? "min(" : " + min(") + v + ", 9)";
  return text;
}

records::FunctionRecord make_formula(const std::string& name, const std::string& text) {
  records::FunctionRecord f;
  f.name = name;
  f.type = "expression";
  f.expression = text;
  return f;
}

// Formulas of time: of a force, of a sum of functions, as a signal; and one of a controller.
TEST(Threads, FormulasOfASharedSystem) {
  auto spec = make_one_body(records::HingeType::Prismatic);
  spec.hinges[0].axis = {1, 0, 0};
  records::FunctionRecord sum;
  sum.name = "sum";
  sum.type = "sum";
  sum.of = {"f", "f"};
  spec.functions = {make_formula("f", make_long_sum("t")), sum};
  for (const char* name : {"f", "sum"}) {
    records::ForceRecord force;
    force.name = name;
    force.body = "body";
    force.direction = {1, 0, 0};
    force.function = name;
    spec.forces.push_back(force);
  }
  spec.controllers = {make_law("law", "expression", {"f"})};
  spec.controllers[0].settings.words["expression"] = {make_long_sum("t") + " + u1"};
  spec.actuators = {make_drive("drive", "hinge", "law")};
  const System system = build(spec);
  // f, 2 f, and f + f of the controller, on a mass of 2.
  EXPECT_EQ(count_wrong(system, {1, 2}, [](double t) { return 5 * kTerms * t / 2; }), 0);
}

TEST(Threads, AUserLibraryOfASharedSystem) {
  auto spec = make_axis();
  records::FunctionRecord f;
  f.name = "f";
  f.type = "table";
  f.x = {0, 10};
  f.y = {0, 10};
  spec.functions = {f};
  spec.controllers = {make_law("law", "library", {"f"})};
  spec.controllers[0].settings.words["file"] = {BOUGH_LAW_SCRATCH};
  const System system = build(spec);
  EXPECT_EQ(count_wrong(system, {1, 2}, [](double t) { return t / 2; }), 0);
}

}  // namespace
}  // namespace bough::solver::testing
