// A formula of t, with its derivatives where they are given.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "solver/functions/function_parameters.hpp"
#include "solver/functions/table.hpp"
#include "solver/text/formulas.hpp"

namespace bough::solver {
namespace {

class TimeExpression final : public TimeFunction {
 public:
  TimeExpression() : formulas(std::make_unique<Formulas>(Formulas::Names{{"t", 0}})) {}
  TimeExpression(const TimeExpression& other)
      : formulas(std::make_unique<Formulas>(*other.formulas)), jumps(other.jumps), marks(other.marks) {}
  TimeExpression& operator=(const TimeExpression&) = delete;

  std::unique_ptr<Formulas> formulas;  ///< f; or f, its rate and its acceleration
  std::vector<double> jumps, marks;

  Value calc(double t) const override {
    (*formulas)[0] = t;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (!has_derivatives()) return {formulas->calc(0), nan, nan};
    return {formulas->calc(0), formulas->calc(1), formulas->calc(2)};
  }
  std::unique_ptr<const TimeFunction> clone() const override { return std::make_unique<TimeExpression>(*this); }
  std::vector<double> jump_times() const override { return jumps; }
  std::vector<double> mesh_times() const override { return marks; }
  bool has_derivatives() const override { return formulas->size() == 3; }
};

/// Number of intervals of the run at whose ends a formula is evaluated.
constexpr int kLooks = 10'000;
/// Limit of the mesh times; of more only those at the end of a rest are kept.
constexpr size_t kMaxMarks = 1000;
/// Ratio of the length of a rest to that of the interval after it.
constexpr double kRest = 5;

/// Mesh times of the formula and of its derivatives, found as in a table of its values.
std::vector<double> find_marks(const TimeExpression& made, const TimeSpan& run) {
  std::vector<double> x(kLooks + 1), y[3], found;
  if (!(run.end > run.start)) return found;
  const auto num = static_cast<size_t>(made.formulas->size());
  for (size_t i = 0; i < x.size(); ++i) {
    x[i] = run.start + static_cast<double>(i) / kLooks * (run.end - run.start);
    const auto value = made.calc(x[i]);
    const double all[] = {value.f, value.f_dot, value.f_ddot};
    for (size_t d = 0; d < num; ++d) y[d].push_back(all[d]);
  }
  for (size_t d = 0; d < num; ++d) {
    auto marks = bough::solver::find_mesh_times(x, y[d]);
    if (marks.size() > kMaxMarks) {
      std::vector<double> ends;
      for (size_t i = 1; i + 1 < marks.size(); ++i)
        if (marks[i] - marks[i - 1] > kRest * (marks[i + 1] - marks[i]))
          ends.insert(ends.end(), {marks[i], marks[i + 1]});
      marks = std::move(ends);
    }
    found.insert(found.end(), marks.begin(), marks.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// df/dt at t by differences of the fourth order.
template <class Function>
double calc_slope(const Function& f, double t, double h) {
  return (8 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12 * h);
}

/// The derivatives that were given are those of the formula, at some times of each stretch between its jumps.
void check_derivatives(const TimeExpression& made, const TimeSpan& run, FunctionParameters& p) {
  std::vector<double> ends = {run.start, run.end};
  for (const double t : made.jumps)
    if (t > run.start && t < run.end) ends.push_back(t);
  std::sort(ends.begin(), ends.end());
  constexpr int kPlaces = 7, kSizes = 200;
  constexpr double kClose = 1e-4;
  for (size_t i = 1; i < ends.size(); ++i) {
    const double length = ends[i] - ends[i - 1], h = 1e-4 * length;
    if (!(length > 0)) continue;
    // Formulas round to their largest terms, which may cancel: 1 + tanh(t) is 0 where its slope is not.
    double size[] = {0, 0};
    for (int k = 0; k <= kSizes; ++k) {
      const auto there = made.calc(ends[i - 1] + (k + 0.5) / (kSizes + 1) * length);
      if (std::isfinite(there.f)) size[0] = std::max(size[0], std::abs(there.f));
      if (std::isfinite(there.f_dot)) size[1] = std::max(size[1], std::abs(there.f_dot));
    }
    for (int k = 0; k < kPlaces; ++k) {
      const double t = ends[i - 1] + (k + 0.5) / kPlaces * length;
      const auto value = [&](double at) { return made.calc(at).f; };
      const auto rate = [&](double at) { return made.calc(at).f_dot; };
      const auto here = made.calc(t);
      const double slopes[] = {calc_slope(value, t, h), calc_slope(rate, t, h)};
      // A difference with half the step bounds the error of the first.
      const double again[] = {calc_slope(value, t, h / 2), calc_slope(rate, t, h / 2)};
      const double given[] = {here.f_dot, here.f_ddot};
      for (int d = 0; d < 2; ++d) {
        const double scale = std::max(std::abs(slopes[d]), std::abs(given[d]));
        const double blur = 10 * std::abs(slopes[d] - again[d]) + 1e-9 * size[d] / h;
        if (!(std::abs(again[d] - given[d]) > kClose * scale + blur)) continue;
        std::ostringstream what;
        what << "has a " << (d == 0 ? "rate" : "acceleration") << " of " << given[d] << " at t = " << t
             << ", where differences of its " << (d == 0 ? "expression" : "rate") << " give " << again[d];
        p.error("function.bad-value", what.str(), "give the derivatives of the expression; its jumps and corners in x");
        return;
      }
    }
  }
}

}  // namespace

std::unique_ptr<const TimeFunction> make_time_expression(const records::FunctionRecord& r, const TimeSpan& run,
                                                         FunctionParameters& p) {
  auto made = std::make_unique<TimeExpression>();
  made->jumps = r.x;
  if (r.expression.empty()) {
    p.error("function.missing-parameter", "has no 'expression'", "give a formula of t");
    return nullptr;
  }
  if (r.first.empty() != r.second.empty()) {
    p.error("function.missing-parameter", r.first.empty() ? "has no 'rate'" : "has no 'acceleration'",
            "give both formulas or none");
    return nullptr;
  }
  if (std::adjacent_find(r.x.begin(), r.x.end(), std::greater_equal<>()) != r.x.end())
    p.error("function.unsorted", "has times in x that do not ascend", "give them in order, each once");
  for (const auto* text : {&r.expression, &r.first, &r.second}) {
    if (text->empty()) continue;
    const std::string fault = made->formulas->add(*text);
    if (fault.empty()) continue;
    p.error("control.bad-expression", "has the expression \"" + *text + "\": " + fault,
            "write it of t, pi and functions as sin, sqrt, abs, min, step");
    return nullptr;
  }
  if (!p.failed() && made->has_derivatives()) check_derivatives(*made, run, p);
  if (!p.failed()) made->marks = find_marks(*made, run);
  return made;
}

}  // namespace bough::solver
