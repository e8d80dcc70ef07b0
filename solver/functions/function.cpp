#include "solver/functions/function.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "solver/functions/function_parameters.hpp"
#include "solver/functions/kepler.hpp"
#include "solver/functions/table.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {
namespace {

using records::FunctionRecord;
constexpr double kPi = std::numbers::pi;

class Constant final : public TimeFunction {
 public:
  explicit Constant(double value) : value_(value) {}
  Value calc(double) const override { return {value_, 0, 0}; }

 private:
  double value_;
};

/// before for t < at, value from `at` on.
class Step final : public TimeFunction {
 public:
  Step(double value, double at, double before) : value_(value), at_(at), before_(before) {}
  Value calc(double t) const override { return {t < at_ ? before_ : value_, 0, 0}; }
  std::vector<double> jump_times() const override { return {at_}; }

 private:
  double value_, at_, before_;
};

class Ramp final : public TimeFunction {
 public:
  Ramp(double value, double from, double to) : value_(value), from_(from), to_(to) {}
  Value calc(double t) const override {
    if (t < from_) return {0, 0, 0};
    if (t >= to_) return {value_, 0, 0};
    const double slope = value_ / (to_ - from_);
    return {slope * (t - from_), slope, 0};
  }
  std::vector<double> jump_times() const override { return {from_, to_}; }

 private:
  double value_, from_, to_;
};

/// value on [at, at + width), 0 outside.
class Pulse final : public TimeFunction {
 public:
  Pulse(double value, double at, double width) : value_(value), on_(at), off_(at + width) {}
  Value calc(double t) const override { return {t >= on_ && t < off_ ? value_ : 0, 0, 0}; }
  std::vector<double> jump_times() const override { return {on_, off_}; }

 private:
  double value_, on_, off_;
};

/// offset + amplitude sin(ω t + phase).
class Sine final : public TimeFunction {
 public:
  Sine(double amplitude, double omega, double phase, double offset)
      : amplitude_(amplitude), omega_(omega), phase_(phase), offset_(offset) {}
  Value calc(double t) const override {
    const double s = amplitude_ * std::sin(omega_ * t + phase_), c = amplitude_ * std::cos(omega_ * t + phase_);
    return {offset_ + s, omega_ * c, -omega_ * omega_ * s};
  }

 private:
  double amplitude_, omega_, phase_, offset_;
};

/// θ(t) = (ω0/T)[t²/2 + (T/2π)²(cos(2πt/T) - 1)] up to T, ω0 (t - T/2) after (NASA-CR-202063, 4.1.4.1; Kane, Ryan &
/// Banerjee, "Dynamics of a cantilever beam attached to a moving base", J. Guidance 10 (1987) 139). θ̈ is continuous:
/// only the third derivative jumps, at T.
class Spinup final : public TimeFunction {
 public:
  Spinup(double rate, double duration) : rate_(rate), duration_(duration) {}
  Value calc(double t) const override {
    if (t < 0) return {0, 0, 0};
    if (t >= duration_) return {rate_ * (t - duration_ / 2), rate_, 0};
    const double a = 2 * kPi / duration_, x = a * t;
    // cos x - 1 = -2 sin²(x/2): no cancellation near the start.
    const double half = std::sin(x / 2);
    return {rate_ / duration_ * (t * t / 2 - 2 * half * half / (a * a)), rate_ / duration_ * (t - std::sin(x) / a),
            rate_ / duration_ * 2 * half * half};
  }
  std::vector<double> jump_times() const override { return {0, duration_}; }

 private:
  double rate_, duration_;
};

/// Checks the points of a table, each fault reported once with the first place it occurs at.
bool check_table(const FunctionRecord& r, FunctionParameters& p) {
  if (r.x.size() != r.y.size() || r.x.size() < 2) {
    std::ostringstream what;
    what << "has " << r.x.size() << " x and " << r.y.size() << " y values";
    p.error("function.table-size", what.str(), "give as many y as x, two at least");
    return false;
  }
  const auto bad = [](double v) { return !std::isfinite(v); };
  for (const auto* list : {&r.x, &r.y}) {
    const auto it = std::find_if(list->begin(), list->end(), bad);
    if (it == list->end()) continue;
    std::ostringstream what;
    what << "has a value that is not a finite number at " << (list == &r.x ? "x" : "y") << " entry "
         << it - list->begin() + 1;
    p.error("function.nan", what.str(), "give finite numbers");
  }
  if (p.failed()) return false;
  for (size_t i = 1; i < r.x.size(); ++i) {
    if (r.x[i] > r.x[i - 1]) continue;
    std::ostringstream what;
    what << "is not sorted: x entry " << i + 1 << " (" << r.x[i] << ") does not pass entry " << i << " (" << r.x[i - 1]
         << ")";
    p.error("function.unsorted", what.str(), "x must increase strictly; for a jump use type = \"step\" or two close x");
    return false;
  }
  return true;
}

}  // namespace

FunctionCopies::FunctionCopies(const std::vector<const TimeFunction*>& functions) {
  for (const TimeFunction* f : functions) {
    if (std::shared_ptr<const TimeFunction> copy = f->clone()) copies_.emplace_back(f, std::move(copy));
  }
  std::sort(copies_.begin(), copies_.end());
}

const TimeFunction& FunctionCopies::find(const TimeFunction& f) const {
  const auto at = std::lower_bound(copies_.begin(), copies_.end(), &f,
                                   [](const auto& copy, const TimeFunction* x) { return copy.first < x; });
  return at != copies_.end() && at->first == &f ? *at->second : f;
}

std::unique_ptr<const TimeFunction> make_time_function(const FunctionRecord& r, Diagnostics& diagnostics,
                                                       const TimeSpan& run, const FunctionMap& others) {
  static const std::vector<std::string> types = {"constant", "step",     "ramp",      "pulse", "sine",  "table",
                                                 "spinup",   "sawtooth", "doublet",   "chirp", "sweep", "expression",
                                                 "sum",      "product",  "harmonics", "random"};
  std::unique_ptr<const TimeFunction> made;
  FunctionParameters p(r, diagnostics);
  if (r.type == "constant") {
    made = std::make_unique<Constant>(p.get("value"));
  } else if (r.type == "step") {
    const double value = p.get("value"), at = p.get("at", 0), before = p.get("before", 0);
    made = std::make_unique<Step>(value, at, before);
  } else if (r.type == "ramp") {
    const double value = p.get("value"), from = p.get("from", 0), to = p.get("to");
    p.demand(to > from, "ends where it starts or before", "give to > from");
    made = std::make_unique<Ramp>(value, from, to);
  } else if (r.type == "pulse") {
    const double value = p.get("value"), at = p.get("at", 0), width = p.get("width");
    p.demand(width > 0, "has a width that is not positive", "give width > 0");
    made = std::make_unique<Pulse>(value, at, width);
  } else if (r.type == "sine") {
    const double amplitude = p.get("amplitude");
    double omega = 0;
    if (p.has("omega") && p.has("frequency_hz")) {
      p.error("function.unknown-parameter", "has both omega and frequency_hz", "give one of them");
      p.get("frequency_hz", 0);
      omega = p.get("omega", 0);
    } else if (p.has("omega")) {
      omega = p.get("omega");
    } else {
      omega = 2 * kPi * p.get("frequency_hz");
      p.get("omega", 0);
    }
    const double phase = p.get("phase", 0), offset = p.get("offset", 0);
    made = std::make_unique<Sine>(amplitude, omega, phase, offset);
  } else if (r.type == "spinup") {
    const double rate = p.get("rate"), duration = p.get("duration");
    p.demand(duration > 0, "has a duration that is not positive", "give duration > 0");
    made = std::make_unique<Spinup>(rate, duration);
  } else if (r.type == "table") {
    if (r.interpolation != "linear" && r.interpolation != "cubic") {
      p.error("function.unknown-type", "has the unknown interpolation '" + r.interpolation + "'",
              suggest_name(r.interpolation, {"linear", "cubic"}, "use linear or cubic"));
    }
    if (check_table(r, p) && !p.failed()) {
      if (r.interpolation == "linear")
        made = std::make_unique<LinearTable>(r.x, r.y);
      else
        made = std::make_unique<CubicTable>(r.x, r.y);
    }
  } else if (r.type == "sawtooth" || r.type == "doublet" || r.type == "chirp" || r.type == "sweep" ||
             r.type == "harmonics") {
    made = make_wave(r, run, p);
  } else if (r.type == "random") {
    if (check_table(r, p)) made = make_wave(r, run, p);
  } else if (r.type == "kepler") {
    made = make_kepler(p);
  } else if (r.type == "expression") {
    made = make_time_expression(r, run, p);
  } else if (r.type == "sum" || r.type == "product") {
    made = make_combination(r, others, p);
  } else {
    std::string list;
    for (const auto& type : types) list += (list.empty() ? "" : ", ") + type;
    diagnostics.error("function.unknown-type", r.at, "function '" + r.name + "' has the unknown type '" + r.type + "'",
                      suggest_name(r.type, types, "use one of: " + list));
    return nullptr;
  }
  p.refuse_others();
  if (p.failed()) return nullptr;
  return made;
}

}  // namespace bough::solver
