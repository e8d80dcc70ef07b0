// Functions of time that repeat or sweep: sawtooth, doublet, chirp, sweep, harmonics, random.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
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

/// Σ y_k Ωᵖ cos(h_k ψ + phase), ψ = ω t + ω̇ t² / 2, Ω = ψ̇: a rotor whose speed changes evenly, a machine for p = 0.
class Harmonics final : public TimeFunction {
 public:
  Harmonics(std::vector<double> number, std::vector<double> coefficient, double omega, double rate, int power,
            double phase)
      : number_(std::move(number)),
        coefficient_(std::move(coefficient)),
        omega_(omega),
        rate_(rate),
        power_(power),
        phase_(phase) {}
  Value calc(double t) const override {
    const double speed = omega_ + rate_ * t, angle = t * (omega_ + rate_ * t / 2);
    const auto raise = [&](int p) { return p < 0 ? 0 : std::pow(speed, p); };
    // Amplitude of a coefficient of 1 and its two derivatives.
    const double a = raise(power_), a_dot = power_ * raise(power_ - 1) * rate_,
                 a_ddot = power_ * (power_ - 1) * raise(power_ - 2) * rate_ * rate_;
    Value sum{0, 0, 0};
    for (size_t k = 0; k < number_.size(); ++k) {
      const double c = coefficient_[k] * std::cos(number_[k] * angle + phase_),
                   s = coefficient_[k] * std::sin(number_[k] * angle + phase_);
      const double w = number_[k] * speed, w_dot = number_[k] * rate_;
      sum.f += a * c;
      sum.f_dot += a_dot * c - a * w * s;
      sum.f_ddot += a_ddot * c - 2 * a_dot * w * s - a * (w * w * c + w_dot * s);
    }
    return sum;
  }

 private:
  std::vector<double> number_, coefficient_;
  double omega_, rate_;
  int power_;
  double phase_;
};

std::unique_ptr<const TimeFunction> make_harmonics(const FunctionRecord& r, FunctionParameters& p) {
  const double omega = p.get("omega"), rate = p.get("omega_rate", 0), power = p.get("power", 2),
               phase = p.get("phase", 0);
  constexpr double kMaxPower = 4;
  p.demand(power >= 0 && power <= kMaxPower && power == std::floor(power), "has a power that is no whole number 0 to 4",
           "give 2 for a rotor, 0 for fixed amplitudes");
  const auto is_finite = [](double x) { return std::isfinite(x); };
  p.demand(!r.x.empty() && r.x.size() == r.y.size(),
           "has " + std::to_string(r.x.size()) + " x and " + std::to_string(r.y.size()) + " y values",
           "give the harmonic numbers in x and as many coefficients in y");
  p.demand(std::all_of(r.x.begin(), r.x.end(), is_finite) && std::all_of(r.y.begin(), r.y.end(), is_finite),
           "has a value that is not a finite number", "give finite numbers");
  if (p.failed()) return nullptr;
  return std::make_unique<Harmonics>(r.x, r.y, omega, rate, static_cast<int>(power), phase);
}

/// a Σ cos(ω_k t + φ_k).
class CosineSum final : public TimeFunction {
 public:
  CosineSum(double amplitude, std::vector<double> omega, std::vector<double> phase)
      : amplitude_(amplitude), omega_(std::move(omega)), phase_(std::move(phase)) {}
  Value calc(double t) const override {
    Value sum{0, 0, 0};
    for (size_t k = 0; k < omega_.size(); ++k) {
      const double w = omega_[k], c = std::cos(w * t + phase_[k]), s = std::sin(w * t + phase_[k]);
      sum.f += c;
      sum.f_dot -= w * s;
      sum.f_ddot -= w * w * c;
    }
    return {amplitude_ * sum.f, amplitude_ * sum.f_dot, amplitude_ * sum.f_ddot};
  }

 private:
  double amplitude_;
  std::vector<double> omega_, phase_;
};

/// One-sided spectral density between two points, linear or linear in the logarithms.
struct DensitySegment {
  double f0, f1, S0, S1;
  bool is_log;
  /// Exponent of the density plus 1; 0: 1/f.
  double power() const { return 1 + std::log(S1 / S0) / std::log(f1 / f0); }
  bool is_inverse() const { return std::abs(power()) < 1e-9; }
  double calc_variance() const {
    if (!is_log) return 0.5 * (S0 + S1) * (f1 - f0);
    if (is_inverse()) return S0 * f0 * std::log(f1 / f0);
    return S0 * f0 * std::expm1(power() * std::log(f1 / f0)) / power();
  }
  /// Frequency below which the segment has that variance.
  double find_frequency(double variance) const {
    double f = f0;
    if (!is_log) {
      const double slope = (S1 - S0) / (f1 - f0);
      const double root = S0 + std::sqrt(std::max(0.0, S0 * S0 + 2 * slope * variance));
      if (root > 0) f = f0 + 2 * variance / root;
    } else if (is_inverse()) {
      f = f0 * std::exp(variance / (S0 * f0));
    } else {
      f = f0 * std::exp(std::log1p(std::max(-1.0, variance * power() / (S0 * f0))) / power());
    }
    return std::clamp(f, f0, f1);
  }
};

/// Frequencies and phases of a stationary random function, one frequency in each of `number` bins of equal variance.
/// Source: Shinozuka & Jan, J. Sound Vib. 25 (1972) 111; strata of equal variance in place of equal width.
std::unique_ptr<const TimeFunction> make_cosine_sum(const std::vector<DensitySegment>& segments, size_t number,
                                                    std::mt19937_64& generator) {
  const auto roll = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  double variance = 0;
  for (const auto& segment : segments) variance += segment.calc_variance();
  std::vector<double> omega, phase;
  size_t at = 0;
  double before = 0;
  for (size_t k = 0; k < number; ++k) {
    const double below = (static_cast<double>(k) + roll()) / static_cast<double>(number) * variance;
    while (at + 1 < segments.size() && below > before + segments[at].calc_variance())
      before += segments[at++].calc_variance();
    omega.push_back(2 * kPi * segments[at].find_frequency(below - before));
    phase.push_back(2 * kPi * roll());
  }
  return std::make_unique<CosineSum>(std::sqrt(2 * variance / static_cast<double>(number)), std::move(omega),
                                     std::move(phase));
}

std::unique_ptr<const TimeFunction> make_random(const FunctionRecord& r, FunctionParameters& p) {
  const double components = p.get("components", 1000), seed = p.get("seed", 1);
  constexpr double kMaxComponents = 1e5, kMaxSeed = 0x1p53;
  p.demand(components >= 1 && components <= kMaxComponents && components == std::floor(components),
           "has components that are no whole number 1 to 100000", "give components = 1000");
  p.demand(seed >= 0 && seed <= kMaxSeed && seed == std::floor(seed), "has a seed that is no whole number from 0 on",
           "give seed = 1");
  const bool is_log = r.interpolation == "log";
  if (r.interpolation != "linear" && !is_log)
    p.error("function.unknown-type", "has the unknown interpolation '" + r.interpolation + "'", "use linear or log");
  const double lowest = is_log ? std::numeric_limits<double>::min() : 0;
  const auto is_low = [&](double x) { return x < lowest; };
  p.demand(!r.x.empty() && !is_low(r.x[0]), "has a frequency that is not positive", "give positive frequencies in x");
  p.demand(std::none_of(r.y.begin(), r.y.end(), is_low),
           is_log ? "has a density that is not positive" : "has a negative density",
           is_log ? "give positive densities in y, or interpolation = \"linear\"" : "give densities of 0 or more in y");
  if (p.failed()) return nullptr;
  std::vector<DensitySegment> segments;
  for (size_t k = 1; k < r.x.size(); ++k) segments.push_back({r.x[k - 1], r.x[k], r.y[k - 1], r.y[k], is_log});
  std::vector<std::uint64_t> words;
  for (const char c : r.name) words.push_back(static_cast<unsigned char>(c));
  words.push_back(static_cast<std::uint64_t>(seed));
  words.push_back(static_cast<std::uint64_t>(seed) >> 32U);
  std::seed_seq sequence(words.begin(), words.end());
  std::mt19937_64 generator(sequence);
  return make_cosine_sum(segments, static_cast<size_t>(components), generator);
}

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
  if (r.type == "harmonics") return make_harmonics(r, p);
  if (r.type == "random") return make_random(r, p);
  if (r.type == "chirp" || r.type == "sweep") return make_sweep(r, p);
  const double value = p.get("value"), at = p.get("at", 0), width = p.get("width");
  p.demand(width > 0, "has a width that is not positive", "give width > 0");
  return std::make_unique<Doublet>(value, at, width);
}

}  // namespace bough::solver
