#include "analysis/linearize/uncertain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "analysis/linearize/operating_point.hpp"
#include "base/platform.hpp"
#include "solver/linear/linearize.hpp"
#include "solver/statespace/uncertainty.hpp"

namespace bough::analysis {

namespace {

bool parse_number(const std::string& text, double& value) {
  const auto end = text.data() + text.size();
  const auto [at, error] = platform::read_number(text.data(), end, value);
  return error == std::errc() && at == end && std::isfinite(value);
}

/// The number that the equations are affine in: of a frequency its square.
double get_affine(const UncertainRange& range, double value) {
  return range.kind == "frequency" ? value * value : value;
}
double get_middle(const UncertainRange& range) {
  return 0.5 * (get_affine(range, range.low) + get_affine(range, range.high));
}

/// Loads the system with given values, and linearizes it.
class Corners {
 public:
  Corners(const LinearizeRequest& request, const LoadOptions& load, std::vector<UncertainRange> ranges,
          Diagnostics& diagnostics)
      : request_(request), load_(load), ranges_(std::move(ranges)) {
    const auto base = load_system(request.file, diagnostics, make_options({}));
    diagnostics.throw_if_errors();
    for (const auto& range : ranges_) add_body(range, base);
  }

  const std::vector<UncertainRange>& ranges() const { return ranges_; }

  records::LinearModel linearize(const std::vector<double>& values, Diagnostics& diagnostics) const {
    const auto loaded = load_system(request_.file, diagnostics, make_options(values));
    diagnostics.throw_if_errors();
    auto one = request_;
    one.uncertain.clear();
    return analysis::linearize(one, loaded, diagnostics);
  }

 private:
  /// A body with uncertain modal coordinates: copies of its file, or of the files of all its fill levels.
  struct UncertainBody {
    std::string name;
    std::map<std::string, records::FlexBody> flex;  ///< by file; with the damping that the body has in the system

    std::string name_copy(const std::string& file) const { return file + "#" + name; }
  };

  void add_body(const UncertainRange& range, const LoadedSystem& base) {
    if (range.body.empty()) return;
    const auto& system = base.system;
    const int b = system.find_body(range.body);
    if (b < 0 || range.mode > system.num_modes(b)) {
      std::vector<std::string> names;
      for (const auto& record : base.spec.bodies) names.push_back(record.name);
      const auto nearest = find_nearest(range.body, names);
      throw InputError(
          "linear.no-mode", {request_.file},
          b < 0 ? fmt::format("there is no body '{}'", range.body)
                : fmt::format("body '{}' has {} modes and no eta{}", range.body, system.num_modes(b), range.mode),
          b < 0 && !nearest.empty() ? "did you mean " + nearest : "name a modal coordinate as BODY:eta1");
    }
    if (find(range.body) != nullptr) return;
    const auto record = std::find_if(base.spec.bodies.begin(), base.spec.bodies.end(),
                                     [&](const auto& r) { return r.name == range.body; });
    UncertainBody body{range.body, {}};
    auto files = record->levels;
    if (files.empty()) files = {record->file};
    for (const auto& file : files) {
      auto flex = base.flex.at(file);
      const auto in_system =
          solver::Body::make_flexible(flex, record->num_modes, record->stiffening, record->damping_ratios);
      const auto n = in_system.num_modes();
      if (flex.modal_damping.size() == 0)
        flex.modal_damping = Eigen::MatrixXd::Zero(flex.num_modes(), flex.num_modes());
      flex.modal_damping.topLeftCorner(n, n) = in_system.D();
      body.flex.emplace(file, std::move(flex));
    }
    bodies_.push_back(std::move(body));
  }

  const UncertainBody* find(const std::string& name) const {
    const auto found =
        std::find_if(bodies_.begin(), bodies_.end(), [&](const auto& body) { return body.name == name; });
    return found == bodies_.end() ? nullptr : &*found;
  }

  /// values: one a range, those that the equations are affine in; empty: bodies as in their files, parameters in the
  /// middle.
  LoadOptions make_options(const std::vector<double>& values) const {
    LoadOptions options = load_;
    for (std::size_t i = 0; i < ranges_.size(); ++i)
      if (ranges_[i].body.empty())
        options.set.push_back(
            fmt::format("{}={:.17g}", ranges_[i].name, values.empty() ? get_middle(ranges_[i]) : values[i]));
    if (values.empty()) return options;
    for (const auto& body : bodies_)
      for (auto [file, flex] : body.flex) {
        for (std::size_t i = 0; i < ranges_.size(); ++i) {
          if (ranges_[i].body != body.name) continue;
          const auto k = ranges_[i].mode - 1;
          (ranges_[i].kind == "damping" ? flex.modal_damping : flex.modal_stiffness)(k, k) *= values[i];
        }
        options.flex[body.name_copy(file)] = std::move(flex);
      }
    options.change_spec = [this](records::SystemSpec& spec) {
      if (load_.change_spec) load_.change_spec(spec);
      for (auto& record : spec.bodies)
        if (const auto* body = find(record.name)) {
          record.file = body->name_copy(record.file);
          for (auto& level : record.levels) level = body->name_copy(level);
          record.damping_ratios.clear();
        }
    };
    return options;
  }

  const LinearizeRequest& request_;
  const LoadOptions& load_;
  std::vector<UncertainRange> ranges_;
  std::vector<UncertainBody> bodies_;
};

}  // namespace

UncertainRange parse_uncertain(const std::string& text) {
  const auto fail = [&](const std::string& why) {
    return InputError("cli.bad-uncertain", {}, fmt::format("--uncertain {} {}", text, why),
                      "write --uncertain gain=4:6 of a parameter, or --uncertain boom:eta1:frequency=0.95:1.05, "
                      "stiffness or damping of a mode as a factor");
  };
  UncertainRange range;
  const auto sign = text.rfind('=');
  const auto colon = sign == std::string::npos ? sign : text.find(':', sign);
  if (sign == 0 || colon == std::string::npos || !parse_number(text.substr(sign + 1, colon - sign - 1), range.low) ||
      !parse_number(text.substr(colon + 1), range.high))
    throw fail("is not NAME=LOW:HIGH");
  if (!(range.low < range.high)) throw fail("does not begin with the lower value");
  range.name = text.substr(0, sign);
  const auto last = range.name.rfind(':');
  if (last == std::string::npos) return range;
  range.kind = range.name.substr(last + 1);
  const auto eta = range.name.rfind(":eta", last - 1);
  double mode = 0;
  if (eta == std::string::npos || eta == 0 || !parse_number(range.name.substr(eta + 4, last - eta - 4), mode) ||
      mode < 1 || mode != std::floor(mode) || mode > 1e6 ||
      (range.kind != "stiffness" && range.kind != "frequency" && range.kind != "damping"))
    throw fail("names no modal coordinate with stiffness, frequency or damping");
  if (range.low < 0) throw fail("has a negative factor");
  range.body = range.name.substr(0, eta);
  range.mode = static_cast<int>(mode);
  return range;
}

std::vector<UncertainRange> parse_uncertain(const std::vector<std::string>& texts) {
  std::vector<UncertainRange> ranges;
  for (const auto& text : texts) {
    auto range = parse_uncertain(text);
    for (const auto& other : ranges)
      if (other.name == range.name)
        throw InputError("cli.bad-uncertain", {}, "--uncertain names " + range.name + " twice", "name it once");
    ranges.push_back(std::move(range));
  }
  return ranges;
}

records::LinearModel linearize_uncertain(const LinearizeRequest& request, const LoadOptions& load,
                                         Diagnostics& diagnostics) {
  const Corners corners(request, load, parse_uncertain(request.uncertain), diagnostics);
  std::vector<double> middle, high;
  for (const auto& range : corners.ranges()) {
    middle.push_back(get_middle(range));
    high.push_back(get_affine(range, range.high));
  }
  auto nominal = corners.linearize(middle, diagnostics);
  if (nominal.sample_time > 0)
    throw InputError("linear.sampled-uncertain", {request.file},
                     "the loop is sampled: its discrete model is not affine in parameters",
                     "cut it with --break or open it with --open, and close it with the discrete controller there");
  Diagnostics again;  // their warnings are those of the nominal model
  // A kink, which is reported, is the same in all models: two difference steps then measure their round-off.
  const auto calc_noise = [](const records::LinearModel& model) {
    constexpr double kKink = 1e-4;
    return model.error > kKink ? model.difference : std::max(model.error, model.difference);
  };
  double error = calc_noise(nominal);
  std::vector<statespace::ParameterEnds> ends;
  for (std::size_t i = 0; i < corners.ranges().size(); ++i) {
    const auto& range = corners.ranges()[i];
    const auto at = [&](double value) {
      auto values = middle;
      values[i] = get_affine(range, value);
      auto model = corners.linearize(values, again);
      error = std::max(error, calc_noise(model));
      return model;
    };
    ends.push_back({range.name, range.low, range.high, at(range.low), at(range.high)});
  }
  return statespace::make_uncertain_model(nominal, ends, corners.linearize(high, again), error, {request.file});
}

}  // namespace bough::analysis
