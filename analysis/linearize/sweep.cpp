#include "analysis/linearize/sweep.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numeric>
#include <sstream>

#include "solver/statespace/track.hpp"

namespace bough::analysis {

using Eigen::Index;
using records::LinearSweep;

namespace {

/// Two motions that turn into two others by halves have 0.5 each.
constexpr double kRecognized = 0.6;
constexpr std::size_t kMaxPoints = 10000;

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

void report_jumps(const LinearSweep& sweep, const std::vector<Index>& path, const std::string& file,
                  Diagnostics& diagnostics) {
  for (Index k = 1; k < sweep.value.size(); ++k) {
    for (Index b = 0; b < sweep.correlation.cols(); ++b) {
      // Poles at 0 and real poles that meet have no unique vectors.
      if (sweep.correlation(k, b) > kRecognized || !(sweep.imag(k, b) > 0) || !(sweep.imag(k - 1, b) > 0)) continue;
      if (is_repeated(sweep, k, b) || is_repeated(sweep, k - 1, b) || is_gone_near(sweep, k, b)) continue;
      diagnostics.warning(
          "linear.sweep-jump", {file},
          fmt::format("from {} to {} a motion of {} changes too much to be recognized (correlation {:.2f})",
                      records::describe_point(sweep, path[static_cast<std::size_t>(k - 1)]),
                      sweep.grid_name.empty() ? fmt::format("{:g}", sweep.value[k])
                                              : records::describe_point(sweep, path[static_cast<std::size_t>(k)]),
                      sweep.mode[static_cast<std::size_t>(k)][static_cast<std::size_t>(b)], sweep.correlation(k, b)),
          "take more values between them");
      break;
    }
  }
}

}  // namespace

void warn_jumps(const LinearSweep& sweep, const std::string& file, Diagnostics& diagnostics) {
  std::vector<Index> path(static_cast<std::size_t>(sweep.value.size()));
  std::iota(path.begin(), path.end(), Index(0));
  report_jumps(sweep, path, file, diagnostics);
}

SweepRange parse_sweep(const std::string& text) {
  const auto fail = [&] {
    return InputError("cli.bad-sweep", {}, "--sweep " + text + " is not NAME=FROM:TO:N",
                      "write --sweep rate=0:6:25, or with :log after it for even ratios");
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

std::vector<SweepRange> parse_sweeps(const std::vector<std::string>& texts) {
  std::vector<SweepRange> ranges;
  std::size_t points = 1;
  for (const auto& text : texts) {
    ranges.push_back(parse_sweep(text));
    points *= ranges.back().values.size();
    for (std::size_t i = 0; i + 1 < ranges.size(); ++i)
      if (ranges[i].name == ranges.back().name)
        throw InputError("cli.bad-sweep", {}, "--sweep names the parameter '" + ranges[i].name + "' twice",
                         "give each parameter of a grid once");
    if (points > kMaxPoints)
      throw InputError("cli.bad-sweep", {}, fmt::format("--sweep makes more than {} models", kMaxPoints),
                       "give fewer values");
  }
  return ranges;
}

namespace {

/// Models from one neighbour to the next: row by row, each second row backwards (a reflected mixed-radix Gray code).
/// \return positions in a grid in which the last range changes fastest
std::vector<Index> list_path(const std::vector<SweepRange>& ranges) {
  Index count = 1;
  for (const auto& range : ranges) count *= std::ssize(range.values);
  std::vector<Index> path;
  for (Index p = 0; p < count; ++p) {
    Index at = 0, below = count, prefix = 0;
    for (const auto& range : ranges) {
      const Index n = std::ssize(range.values);
      below /= n;
      const Index digit = p / below % n;
      at = at * n + (prefix % 2 == 0 ? digit : n - 1 - digit);
      prefix = prefix * n + digit;
    }
    path.push_back(at);
  }
  return path;
}

template <class T>
std::vector<T> reorder(const std::vector<T>& along, const std::vector<Index>& path) {
  std::vector<T> grid(along.size());
  for (std::size_t p = 0; p < path.size(); ++p) grid[static_cast<std::size_t>(path[p])] = along[p];
  return grid;
}

}  // namespace

LinearSweep make_sweep(const std::vector<SweepRange>& ranges,
                       const std::function<records::LinearModel(const std::vector<double>&)>& linearize,
                       const std::string& file, Diagnostics& diagnostics, const Eigen::Vector3d& spin_axis) {
  LinearSweep sweep;
  const std::vector<Index> path = list_path(ranges);
  sweep.parameter = ranges.size() == 1 ? ranges[0].name : "point";
  if (ranges.size() == 1)
    sweep.value = Eigen::Map<const Eigen::VectorXd>(ranges[0].values.data(), std::ssize(ranges[0].values));
  else
    sweep.value = Eigen::VectorXd::LinSpaced(std::ssize(path), 1, static_cast<double>(path.size()));
  for (const auto& range : ranges) {
    if (ranges.size() == 1) break;
    sweep.grid_name.push_back(range.name);
    sweep.grid_value.emplace_back(Eigen::Map<const Eigen::VectorXd>(range.values.data(), std::ssize(range.values)));
  }
  for (const Index at : path) {
    std::vector<double> values(ranges.size());
    Index rest = at;
    for (std::size_t i = ranges.size(); i-- > 0; rest /= std::ssize(ranges[i].values))
      values[i] = ranges[i].values[static_cast<std::size_t>(rest % std::ssize(ranges[i].values))];
    sweep.models.push_back(linearize(values));
    const auto &first = sweep.models.front(), &last = sweep.models.back();
    if (last.states.name != first.states.name || last.inputs.name != first.inputs.name ||
        (last.sample_time > 0) != (first.sample_time > 0))
      throw ComputationError(
          "linear.sweep-states", {file},
          fmt::format("the model at {} has other states or inputs than the first", records::describe_point(sweep, at)),
          "sweep where the system stays the same");
  }
  statespace::track_poles(sweep, spin_axis);
  report_jumps(sweep, path, file, diagnostics);
  if (ranges.size() == 1) return sweep;
  sweep.models = reorder(sweep.models, path);
  sweep.mode = reorder(sweep.mode, path);
  for (Eigen::MatrixXd* m :
       {&sweep.real, &sweep.imag, &sweep.frequency_hz, &sweep.damping, &sweep.correlation, &sweep.whirl}) {
    if (m->size() == 0) continue;
    const Eigen::MatrixXd along = *m;
    for (std::size_t p = 0; p < path.size(); ++p) m->row(path[p]) = along.row(static_cast<Index>(p));
  }
  return sweep;
}

}  // namespace bough::analysis
