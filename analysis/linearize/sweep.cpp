#include "analysis/linearize/sweep.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <sstream>

#include "solver/statespace/track.hpp"

namespace bough::analysis {

using Eigen::Index;
using records::LinearSweep;

namespace {

/// Two motions that turn into two others by halves have 0.5 each.
constexpr double kRecognized = 0.6;

/// Returns true if a branch is at z = 0 at one of the values k - 1 and k of a sampled sweep.
bool is_gone_near(const LinearSweep& sweep, Index k, Index b) {
  return !sweep.models.empty() && sweep.models.front().sample_time > 0 &&
         (records::calc_z(sweep, k, b) == 0.0 || records::calc_z(sweep, k - 1, b) == 0.0);
}

/// Returns true if another pole has the same value: the vectors of repeated poles are arbitrary.
bool is_repeated(const LinearSweep& sweep, Index k, Index b) {
  const std::complex<double> own(sweep.real(k, b), sweep.imag(k, b));
  for (Index other = 0; other < sweep.real.cols(); ++other) {
    const std::complex<double> pole(sweep.real(k, other), sweep.imag(k, other));
    if (other != b && std::abs(pole - own) <= 1e-6 * std::abs(own)) return true;
  }
  return false;
}

}  // namespace

void warn_jumps(const LinearSweep& sweep, const std::string& file, Diagnostics& diagnostics) {
  for (Index k = 1; k < sweep.value.size(); ++k) {
    for (Index b = 0; b < sweep.correlation.cols(); ++b) {
      // Poles at 0 and real poles that meet have no unique vectors.
      if (sweep.correlation(k, b) > kRecognized || !(sweep.imag(k, b) > 0) || !(sweep.imag(k - 1, b) > 0)) continue;
      if (is_repeated(sweep, k, b) || is_repeated(sweep, k - 1, b) || is_gone_near(sweep, k, b)) continue;
      diagnostics.warning(
          "linear.sweep-jump", {file},
          fmt::format("from {} = {:g} to {:g} a motion of {} changes too much to be recognized (correlation {:.2f})",
                      sweep.parameter, sweep.value[k - 1], sweep.value[k],
                      sweep.mode[static_cast<std::size_t>(k)][static_cast<std::size_t>(b)], sweep.correlation(k, b)),
          "take more values between them");
      break;
    }
  }
}

SweepRange parse_sweep(const std::string& text) {
  const auto fail = [&] {
    return InputError("cli.bad-sweep", {}, "--sweep " + text + " is not NAME=FROM:TO:N",
                      "write --sweep rate=0:6:25, or with :log behind it for even ratios");
  };
  const auto sign = text.find('=');
  if (sign == std::string::npos || sign == 0) throw fail();
  std::vector<std::string> words;
  std::stringstream rest(text.substr(sign + 1));
  for (std::string word; std::getline(rest, word, ':');) words.push_back(word);
  const bool is_log = words.size() == 4 && words[3] == "log";
  if (words.size() != 3 && !is_log) throw fail();
  double numbers[3];
  for (std::size_t i = 0; i < 3; ++i) {
    char* end = nullptr;
    numbers[i] = std::strtod(words[i].c_str(), &end);
    if (words[i].empty() || *end != '\0' || !std::isfinite(numbers[i])) throw fail();
  }
  const double from = numbers[0], to = numbers[1];
  if (numbers[2] != std::floor(numbers[2]) || numbers[2] < 2 || numbers[2] > 10000) throw fail();
  if (is_log && !(from > 0 && to > 0)) throw fail();
  SweepRange range{text.substr(0, sign), {}};
  const int n = static_cast<int>(numbers[2]);
  for (int i = 0; i < n; ++i) {
    const double part = static_cast<double>(i) / (n - 1);
    range.values.push_back(i == n - 1 ? to : is_log ? from * std::pow(to / from, part) : from + part * (to - from));
  }
  return range;
}

LinearSweep make_sweep(const std::string& name, const std::vector<double>& values,
                       const std::function<records::LinearModel(double)>& linearize, const std::string& file,
                       Diagnostics& diagnostics, const Eigen::Vector3d& spin_axis) {
  LinearSweep sweep;
  sweep.parameter = name;
  sweep.value = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Index>(values.size()));
  for (const double value : values) {
    sweep.models.push_back(linearize(value));
    const auto &first = sweep.models.front(), &last = sweep.models.back();
    if (last.states.name != first.states.name || last.inputs.name != first.inputs.name ||
        (last.sample_time > 0) != (first.sample_time > 0))
      throw ComputationError(
          "linear.sweep-states", {file},
          fmt::format("the model at {} = {:g} has other states or inputs than the first", name, value),
          "sweep where the system stays the same");
  }
  statespace::track_poles(sweep, spin_axis);
  warn_jumps(sweep, file, diagnostics);
  return sweep;
}

}  // namespace bough::analysis
