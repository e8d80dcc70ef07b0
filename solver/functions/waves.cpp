// Functions of time that repeat or sweep: sawtooth, doublet, chirp, sweep.
#include <cmath>
#include <numbers>
#include <sstream>

#include "solver/functions/function_parameters.hpp"
#include "solver/text/names.hpp"

namespace bough::solver {
namespace {

using records::FunctionRecord;
constexpr double kPi = std::numbers::pi;
constexpr double kMaxJumps = 1e6;

/// From -a to a over the share `rise` of each period, and back over the rest; 1: it falls at once.
class Sawtooth final : public TimeFunction {
 public:
  Sawtooth(double amplitude, double period, double rise, double at, double offset, const TimeSpan& run)
      : amplitude_(amplitude), period_(period), rise_(rise), at_(at), offset_(offset) {
    for (double k = std::floor((run.start - at) / period); at + k * period <= run.end; ++k) {
      jumps_.push_back(at + k * period);
      if (rise < 1) jumps_.push_back(at + (k + rise) * period);
    }
  }
  Value calc(double t) const override {
    // Jumps are where jump_times() has them, to the last bit: 0.3 / 0.1 is below 3.
    double k = std::floor((t - at_) / period_);
    if (t >= at_ + (k + 1) * period_) ++k;
    if (t < at_ + k * period_) --k;
    const double up = rise_ * period_, s = t - (at_ + k * period_);
    const bool falls = rise_ < 1 && t >= at_ + (k + rise_) * period_;
    if (!falls) return {offset_ + amplitude_ * (2 * s / up - 1), 2 * amplitude_ / up, 0};
    const double down = period_ - up;
    return {offset_ + amplitude_ * (1 - 2 * (s - up) / down), -2 * amplitude_ / down, 0};
  }
  std::vector<double> jump_times() const override { return jumps_; }

 private:
  double amplitude_, period_, rise_, at_, offset_;
  std::vector<double> jumps_;
};

/// value on [at, at + width), -value on [at + width, at + 2 width), 0 outside.
class Doublet final : public TimeFunction {
 public:
  Doublet(double value, double at, double width) : value_(value), on_(at), turn_(at + width), off_(at + 2 * width) {}
  Value calc(double t) const override { return {t < on_ || t >= off_ ? 0 : t < turn_ ? value_ : -value_, 0, 0}; }
  std::vector<double> jump_times() const override { return {on_, turn_, off_}; }

 private:
  double value_, on_, turn_, off_;
};

/// offset + amplitude sin(φ(s) + phase), s = t - at in [0, T), offset outside. Linear: φ̇ = ω₀ + (ω₁ - ω₀) s / T;
/// logarithmic: φ̇ = ω₀ (ω₁ / ω₀)^(s / T), a constant number of octaves per time.
class SweptSine final : public TimeFunction {
 public:
  SweptSine(double amplitude, double from, double to, double at, double duration, double phase, double offset,
            bool is_log)
      : amplitude_(amplitude),
        from_(from),
        to_(to),
        at_(at),
        end_(at + duration),
        duration_(duration),
        phase_(phase),
        offset_(offset),
        rate_(is_log ? std::log(to / from) / duration : 0) {}
  Value calc(double t) const override {
    if (t < at_ || t >= end_) return {offset_, 0, 0};
    const double s = t - at_;
    double angle = phase_, omega = from_, omega_dot = 0;
    if (rate_ != 0) {
      omega = from_ * std::exp(rate_ * s);
      angle += from_ * std::expm1(rate_ * s) / rate_;
      omega_dot = rate_ * omega;
    } else {
      omega_dot = (to_ - from_) / duration_;
      omega = from_ + omega_dot * s;
      angle += s * (from_ + omega_dot * s / 2);
    }
    const double sine = amplitude_ * std::sin(angle), cosine = amplitude_ * std::cos(angle);
    return {offset_ + sine, omega * cosine, omega_dot * cosine - omega * omega * sine};
  }
  std::vector<double> jump_times() const override { return {at_, end_}; }

 private:
  double amplitude_, from_, to_, at_, end_, duration_, phase_, offset_, rate_;
};

std::unique_ptr<const TimeFunction> make_sawtooth(const TimeSpan& run, FunctionParameters& p) {
  const double amplitude = p.get("amplitude"), frequency = p.get("frequency_hz"), rise = p.get("rise", 1),
               at = p.get("at", 0), offset = p.get("offset", 0);
  p.demand(frequency > 0, "has a frequency_hz that is not positive", "give frequency_hz > 0");
  p.demand(rise > 0 && rise <= 1, "has a rise that is no share of its period", "give 0 < rise <= 1; 0.5 is a triangle");
  if (const double count = (run.end - run.start) * frequency; !p.failed() && count > kMaxJumps) {
    std::ostringstream what;
    what << "has " << count << " periods within the run, each of which the integrator stops at";
    p.error("function.bad-value", what.str(), "give a lower frequency_hz, or a sine");
  }
  if (p.failed()) return nullptr;
  return std::make_unique<Sawtooth>(amplitude, 1 / frequency, rise, at, offset, run);
}

std::unique_ptr<const TimeFunction> make_sweep(const FunctionRecord& r, FunctionParameters& p) {
  const bool is_log = r.type == "sweep" && r.law == "logarithmic";
  const double amplitude = p.get("amplitude"), from = p.get("from_hz"), to = p.get("to_hz"), at = p.get("at", 0),
               duration = p.get("duration"), phase = p.get("phase", 0), offset = p.get("offset", 0);
  p.demand(duration > 0, "has a duration that is not positive", "give duration > 0");
  p.demand(!is_log || (from > 0 && to > 0), "sweeps by octaves from or to a frequency that is not positive",
           "give from_hz > 0 and to_hz > 0, or law = \"linear\"");
  if (r.law != "logarithmic" && r.law != "linear") {
    p.error("function.unknown-type", "has the unknown law '" + r.law + "'",
            suggest_name(r.law, {"linear", "logarithmic"}, "use linear or logarithmic"));
  }
  if (p.failed()) return nullptr;
  return std::make_unique<SweptSine>(amplitude, 2 * kPi * from, 2 * kPi * to, at, duration, phase, offset, is_log);
}

}  // namespace

std::unique_ptr<const TimeFunction> make_wave(const FunctionRecord& r, const TimeSpan& run, FunctionParameters& p) {
  if (r.type == "sawtooth") return make_sawtooth(run, p);
  if (r.type == "chirp" || r.type == "sweep") return make_sweep(r, p);
  const double value = p.get("value"), at = p.get("at", 0), width = p.get("width");
  p.demand(width > 0, "has a width that is not positive", "give width > 0");
  return std::make_unique<Doublet>(value, at, width);
}

}  // namespace bough::solver
