#include "analysis/response/budget.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/linearize/choose_channels.hpp"
#include "analysis/response/input_spectrum.hpp"
#include "formats/hdf5/linear_file.hpp"
#include "formats/toml/budget.hpp"
#include "solver/statespace/pointing.hpp"

namespace bough::analysis {

namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using records::DisturbanceSource;
using records::LinearModel;
using records::ToneRow;
using statespace::ExposurePart;
using statespace::ExposureWeight;
using statespace::Tone;

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<ExposureWeight> list_weights(const records::BudgetSpec& spec) {
  std::vector<ExposureWeight> weights{{}};
  for (const double exposure : spec.exposures) {
    for (const auto part : {ExposurePart::Jitter, ExposurePart::Smear, ExposurePart::Residual, ExposurePart::Mean})
      weights.push_back({part, exposure, 0});
    if (spec.interval > 0) weights.push_back({ExposurePart::Drift, exposure, spec.interval});
  }
  return weights;
}

/// Column of B of one input; reports an unknown name.
Index find_input(const std::string& name, const LinearModel& model, const SourceLocation& at,
                 Diagnostics& diagnostics) {
  const auto& known = model.inputs.name;
  const auto found = std::find(known.begin(), known.end(), name);
  if (found != known.end()) return found - known.begin();
  const auto near = find_nearest(name, known);
  diagnostics.error(
      "linear.unknown-input", at, fmt::format("there is no input '{}'", name),
      !near.empty() ? "did you mean '" + near + "'?" : fmt::format("the model has {}", fmt::join(known, ", ")));
  return 0;
}

/// Inputs of a source of tones, as columns of B.
struct ToneInputs {
  std::vector<Index> force, moment;
  std::vector<std::vector<Index>> rows;  ///< of each row of type tones
};

ToneInputs find_inputs(const DisturbanceSource& source, const LinearModel& model, Diagnostics& diagnostics) {
  ToneInputs found;
  for (const auto& name : source.force) found.force.push_back(find_input(name, model, source.at, diagnostics));
  for (const auto& name : source.moment) found.moment.push_back(find_input(name, model, source.at, diagnostics));
  for (const auto& row : source.rows) {
    auto& inputs = found.rows.emplace_back();
    for (const auto& name : row.inputs) inputs.push_back(find_input(name, model, row.at, diagnostics));
  }
  return found;
}

/// A vector of size `amplitude` that rotates with ω, below 0 against the spin, in the first two of `inputs`:
/// Re and Im of z exp(iωt).
void add_rotating(Complex z, double omega, const std::vector<Index>& inputs, Eigen::VectorXcd& u) {
  if (z == 0.0) return;
  const Complex x = z, y = Complex(0, -1) * z;
  u[inputs[0]] += omega < 0 ? std::conj(x) : x;
  u[inputs[1]] += omega < 0 ? std::conj(y) : y;
}

void add_axial(Complex z, const std::vector<Index>& inputs, Eigen::VectorXcd& u) {
  if (z != 0.0) u[inputs[2]] += z;
}

/// Tones of a wheel at one speed [1/T].
std::vector<Tone> list_wheel_tones(const DisturbanceSource& source, const ToneInputs& inputs, double speed,
                                   Index num_inputs) {
  std::vector<Tone> tones;
  for (const ToneRow& row : source.rows) {
    const double omega = row.number * speed, square = speed * speed;
    const Complex turn = std::polar(1.0, row.moment_phase);
    const Complex radial = source.radial ? statespace::calc_wheel_transfer(*source.radial, omega) : 1;
    const Complex axial = source.axial ? statespace::calc_wheel_transfer(*source.axial, std::abs(omega)) : 1;
    const Complex rocking =
        source.rocking ? statespace::calc_rocking_transfer(*source.rocking, source.inertia_ratio, omega, speed) : 1;
    Tone tone{std::abs(omega), Eigen::VectorXcd::Zero(num_inputs)};
    add_rotating(square * row.radial_force * radial, omega, inputs.force, tone.amplitude);
    add_rotating(square * row.radial_moment * rocking * turn, omega, inputs.moment, tone.amplitude);
    add_axial(square * row.axial_force * axial, inputs.force, tone.amplitude);
    add_axial(square * row.axial_moment * turn, inputs.moment, tone.amplitude);
    tones.push_back(std::move(tone));
  }
  return tones;
}

std::vector<Tone> list_fixed_tones(const DisturbanceSource& source, const ToneInputs& inputs, Index num_inputs) {
  std::vector<Tone> tones;
  for (std::size_t r = 0; r < source.rows.size(); ++r) {
    const ToneRow& row = source.rows[r];
    Tone tone{kTwoPi * source.frequency_hz * row.number, Eigen::VectorXcd::Zero(num_inputs)};
    for (std::size_t k = 0; k < row.inputs.size(); ++k)
      tone.amplitude[inputs.rows[r][k]] += std::polar(row.amplitude[k], row.phase[k]);
    tones.push_back(std::move(tone));
  }
  return tones;
}

class Budget {
 public:
  Budget(const LinearModel& model, const records::BudgetSpec& spec, const BudgetRequest& request)
      : model_(model), spec_(spec), request_(request), weights_(list_weights(spec)) {}

  records::PointingBudget calc() {
    resolve();
    statespace::demand_decay(model_, list_driven());
    start();
    add_spectra();
    const statespace::TransferMatrix transfer(model_.A, model_.B, model_.C, model_.D);
    for (std::size_t s = 0; s < spec_.sources.size(); ++s) {
      if (spec_.sources[s].type == "tones") add_tones(s, transfer);
      if (spec_.sources[s].type == "wheel") add_wheel(s, transfer);
    }
    for (auto& table : budget_.tables) table.total = table.rms.colwise().norm().transpose();
    return std::move(budget_);
  }

 private:
  void resolve() {
    Diagnostics diagnostics;
    for (const auto& source : spec_.sources) {
      inputs_.push_back(find_inputs(source, model_, diagnostics));
      if (source.type == "psd") spectra_.push_back(make_input_spectrum(source.densities, model_, diagnostics));
      check_band(source, diagnostics);
    }
    diagnostics.throw_if_errors();
  }

  void check_band(const DisturbanceSource& source, Diagnostics& diagnostics) const {
    if (!(model_.sample_time > 0)) return;
    const double nyquist = 0.5 / model_.sample_time;
    const double base = source.type == "wheel" ? *std::max_element(source.speed.begin(), source.speed.end()) / kTwoPi
                                               : source.frequency_hz;
    for (const auto& row : source.rows)
      if (std::abs(row.number) * base > nyquist)
        diagnostics.error("linear.bad-budget", row.at,
                          fmt::format("source '{}' has a tone at {:.6g} Hz, above half the sample rate of the model, "
                                      "{:.6g} Hz",
                                      source.name, std::abs(row.number) * base, nyquist),
                          "leave the harmonic out, or take a model without samples");
  }

  MatrixXd list_driven() const {
    std::vector<Index> driven;
    for (std::size_t s = 0, k = 0; s < spec_.sources.size(); ++s) {
      driven.insert(driven.end(), inputs_[s].force.begin(), inputs_[s].force.end());
      driven.insert(driven.end(), inputs_[s].moment.begin(), inputs_[s].moment.end());
      for (const auto& row : inputs_[s].rows) driven.insert(driven.end(), row.begin(), row.end());
      if (spec_.sources[s].type != "psd") continue;
      for (const Index j : spectra_[k].list_inputs()) driven.push_back(j);
      ++k;
    }
    std::sort(driven.begin(), driven.end());
    driven.erase(std::unique(driven.begin(), driven.end()), driven.end());
    return model_.B(Eigen::all, driven);
  }

  void start() {
    const Index num_sources = std::ssize(spec_.sources), ny = model_.C.rows();
    budget_.outputs = model_.outputs;
    for (const auto& source : spec_.sources) {
      budget_.sources.push_back(source.name);
      budget_.speed.emplace_back(Eigen::Map<const VectorXd>(source.speed.data(), std::ssize(source.speed)));
    }
    budget_.curves.resize(spec_.sources.size());
    for (const auto& weight : weights_) {
      records::BudgetTable table;
      table.weighting = statespace::get_word(weight.part);
      table.exposure = weight.exposure;
      table.rms.setZero(num_sources, ny);
      table.speed.setConstant(num_sources, ny, kNone);
      table.over_speed.resize(spec_.sources.size());
      budget_.tables.push_back(std::move(table));
    }
  }

  void add_spectra() {
    if (spectra_.empty()) return;
    statespace::InputSpectrum all(model_.B.cols(), {});
    for (const auto& one : spectra_) all.append(one);
    auto range = request_.range;
    choose_band(model_, all, range);
    if (range.to_hz > 0 && range.to_hz <= range.from_hz)
      throw InputError("cli.bad-range", {request_.budget},
                       fmt::format("the spectral densities end at {:g} Hz, the frequencies begin at {:g}", range.to_hz,
                                   range.from_hz),
                       "give --from below the end of the tables");
    auto response = statespace::calc_frequency_response(model_, range);
    // White densities next to tables that reach beyond the poles: the band takes both.
    const auto corners = all.list_corners();
    const double last = response.frequency_hz[response.frequency_hz.size() - 1];
    if (!corners.empty() && request_.range.to_hz <= 0 && corners.back() > last) {
      range.to_hz = corners.back();
      range.from_hz = range.from_hz > 0 ? range.from_hz : response.frequency_hz[0];
      response = statespace::calc_frequency_response(model_, range);
    }
    budget_.from_hz = response.frequency_hz[0];
    budget_.to_hz = response.frequency_hz[response.frequency_hz.size() - 1];
    for (const auto& one : spectra_)
      check_input_spectrum(one, {response.frequency_hz.begin(), response.frequency_hz.end()}, {}, request_.budget);
    const auto squares = statespace::integrate_exposures(model_, spectra_, response, weights_);
    for (std::size_t w = 0; w < weights_.size(); ++w)
      for (Index s = 0, k = 0; s < std::ssize(spec_.sources); ++s)
        if (spec_.sources[static_cast<std::size_t>(s)].type == "psd")
          budget_.tables[w].rms.row(s) = squares[w].row(k++).cwiseSqrt();
    for (std::size_t s = 0, k = 0; s < spec_.sources.size(); ++s)
      if (spec_.sources[s].type == "psd")
        budget_.curves[s] = {response.frequency_hz.replicate(1, model_.C.rows()),
                             statespace::calc_running_rms(spectra_[k++], response)};
  }

  /// Sets one output, or all with -1, of the curve of a source to the steps of its tones.
  void add_steps(std::size_t s, const statespace::TransferMatrix& transfer, std::vector<Tone> tones, Index output) {
    std::sort(tones.begin(), tones.end(), [](const Tone& a, const Tone& b) { return a.omega < b.omega; });
    auto& [hz, rms] = budget_.curves[s];
    hz.conservativeResize(std::ssize(tones), model_.C.rows());
    rms.conservativeResize(std::ssize(tones), model_.C.rows());
    VectorXd square = VectorXd::Zero(model_.C.rows());
    for (std::size_t k = 0; k < tones.size(); ++k) {
      const auto row = static_cast<Index>(k);
      square += statespace::calc_tones(model_, transfer, {tones[k]}, {ExposureWeight{}})[0];
      for (Index i = output < 0 ? 0 : output; i < (output < 0 ? model_.C.rows() : output + 1); ++i) {
        hz(row, i) = tones[k].omega / kTwoPi;
        rms(row, i) = std::sqrt(square[i]);
      }
    }
  }

  std::vector<VectorXd> calc_squares(std::size_t s, const statespace::TransferMatrix& transfer,
                                     const std::vector<Tone>& tones) const {
    auto squares = statespace::calc_tones(model_, transfer, tones, weights_);
    for (const auto& one : squares)
      if (!one.allFinite())
        throw ComputationError("linear.unbounded-random", spec_.sources[s].at,
                               "source '" + spec_.sources[s].name + "' has a tone at a pole without damping",
                               "give the modes damping, or choose other speeds");
    return squares;
  }

  void add_tones(std::size_t s, const statespace::TransferMatrix& transfer) {
    const auto tones = list_fixed_tones(spec_.sources[s], inputs_[s], model_.B.cols());
    const auto squares = calc_squares(s, transfer, tones);
    add_steps(s, transfer, tones, -1);
    for (std::size_t w = 0; w < weights_.size(); ++w)
      budget_.tables[w].rms.row(static_cast<Index>(s)) = squares[w].cwiseSqrt().transpose();
  }

  void add_wheel(std::size_t s, const statespace::TransferMatrix& transfer) {
    const auto& source = spec_.sources[s];
    const Index row = static_cast<Index>(s), num_speeds = std::ssize(source.speed), ny = model_.C.rows();
    for (auto& table : budget_.tables) table.over_speed[s].resize(num_speeds, ny);
    for (Index k = 0; k < num_speeds; ++k) {
      const double speed = source.speed[static_cast<std::size_t>(k)];
      const auto squares = calc_squares(s, transfer, list_wheel_tones(source, inputs_[s], speed, model_.B.cols()));
      for (std::size_t w = 0; w < weights_.size(); ++w)
        budget_.tables[w].over_speed[s].row(k) = squares[w].cwiseSqrt().transpose();
    }
    for (auto& table : budget_.tables)
      for (Index i = 0; i < ny; ++i) {
        Index worst = 0;
        table.rms(row, i) = table.over_speed[s].col(i).maxCoeff(&worst);
        table.speed(row, i) = source.speed[static_cast<std::size_t>(worst)];
      }
    for (Index i = 0; i < ny; ++i)
      add_steps(s, transfer,
                list_wheel_tones(source, inputs_[s], budget_.tables.front().speed(row, i), model_.B.cols()), i);
  }

  const LinearModel& model_;
  const records::BudgetSpec& spec_;
  const BudgetRequest& request_;
  std::vector<ExposureWeight> weights_;
  std::vector<ToneInputs> inputs_;
  std::vector<statespace::InputSpectrum> spectra_;  ///< of the sources of type psd, in their order
  records::PointingBudget budget_;
};

}  // namespace

records::PointingBudget calc_budget(const BudgetRequest& request, Events& events) {
  demand_file(request.file);
  demand_file(request.budget);
  if (request.range.to_hz > 0 && request.range.to_hz <= request.range.from_hz)
    throw InputError("cli.bad-range", {},
                     fmt::format("frequencies from {:g} to {:g} are none", request.range.from_hz, request.range.to_hz),
                     "give --to above --from");
  Diagnostics diagnostics;
  const auto spec = toml_files::read_budget(request.budget, diagnostics);
  diagnostics.throw_if_errors();
  const auto model = choose_channels(hdf5::read_linear_model(request.file), {}, request.outputs, request.file);
  if (model.inputs.size() == 0 || model.outputs.size() == 0)
    throw InputError("linear.no-channels", {request.file}, "the model has no input or no output",
                     "name some with --inputs and --outputs of bough linearize");
  records::PointingBudget budget;
  with_prior_messages(diagnostics, [&] { budget = Budget(model, spec, request).calc(); });
  budget.source = calc_sources({request.file, request.budget});
  add_messages(diagnostics, events);
  return budget;
}

std::string make_budget_csv(const records::PointingBudget& budget) {
  std::string text = "weighting,exposure,source,speed";
  for (const auto& name : budget.outputs.name) text += "," + name;
  text += "\n";
  const auto quote = [](const std::string& name) {
    return name.find_first_of(",\"\n") == std::string::npos ? name : fmt::format("{:?}", name);
  };
  for (const auto& table : budget.tables) {
    const auto add = [&](const std::string& source, const std::string& speed, const Eigen::RowVectorXd& values) {
      text += fmt::format("{},{:.17g},{},{}", table.weighting, table.exposure, quote(source), speed);
      for (const double value : values) text += fmt::format(",{:.17g}", value);
      text += "\n";
    };
    for (std::size_t s = 0; s < budget.sources.size(); ++s) {
      for (Index k = 0; k < table.over_speed[s].rows(); ++k)
        add(budget.sources[s], fmt::format("{:.17g}", budget.speed[s][k]), table.over_speed[s].row(k));
      add(budget.sources[s], table.over_speed[s].size() > 0 ? "worst" : "", table.rms.row(static_cast<Index>(s)));
    }
    add("total", "", table.total.transpose());
  }
  return text;
}

}  // namespace bough::analysis
