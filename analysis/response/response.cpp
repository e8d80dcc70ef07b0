#include "analysis/response/response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/common/choices.hpp"
#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/linearize/choose_channels.hpp"
#include "analysis/response/input_spectrum.hpp"
#include "formats/hdf5/linear_file.hpp"

namespace bough::analysis {

namespace {

/// Models with a larger error are reported, as by linearize.
constexpr double kMaxUncertainty = 1e-4;
/// Relative difference of two RMS values that is reported.
constexpr double kRmsDifference = 0.01;

void compare_integrals(const records::RandomOutputs& random, const std::string& file, Diagnostics& diagnostics) {
  Eigen::Index worst = -1, narrow = -1;
  double max_difference = kRmsDifference, min_share = 1 - kRmsDifference;
  for (Eigen::Index i = 0; i < random.rms.size(); ++i) {
    if (!(random.band_rms[i] > 0)) continue;
    const double difference = std::abs(random.rms[i] / random.band_rms[i] - 1);
    if (difference > max_difference) max_difference = difference, worst = i;
    if (random.total_rms.size() == 0 || !std::isfinite(random.total_rms[i])) continue;
    const double share = random.band_rms[i] / random.total_rms[i];
    if (share < min_share) min_share = share, narrow = i;
  }
  const auto name = [&](Eigen::Index i) { return random.outputs.name[static_cast<std::size_t>(i)]; };
  if (worst >= 0)
    diagnostics.warning("linear.random-sampling", {file},
                        fmt::format("straight lines between the frequencies give output {} an RMS of {:.6g}, the "
                                    "integral over the band {:.6g}",
                                    name(worst), random.rms[worst], random.band_rms[worst]),
                        "take the RMS of the band, or give more frequencies with --points");
  if (narrow >= 0)
    diagnostics.note("linear.random-band", {file},
                     fmt::format("white inputs give output {} an RMS of {:.6g} over all frequencies, {:.3g} % of it in "
                                 "the band",
                                 name(narrow), random.total_rms[narrow], 100 * min_share),
                     "widen the band with --from and --to if the inputs are white beyond it");
}

}  // namespace

ResponseAnswer calc_response(const ResponseRequest& request, Events& events) {
  demand_file(request.file);
  demand_positive("--from", request.range.from_hz, true);
  demand_positive("--to", request.range.to_hz, true);
  demand_range("--points", request.range.points, 1, 100000);
  if (request.range.to_hz > 0 && request.range.to_hz <= request.range.from_hz)
    throw InputError("cli.bad-range", {},
                     fmt::format("frequencies from {:g} to {:g} are none", request.range.from_hz, request.range.to_hz),
                     "give --to above --from");
  ResponseAnswer answer;
  auto& model = answer.model;
  model = hdf5::read_linear_model(request.file);
  const int num_cut = records::is_cut_loop(model) ? model.inputs.size() : 0;
  model = choose_channels(std::move(model), request.inputs, request.outputs, request.file);
  Diagnostics diagnostics;
  if (const double worst = std::max(model.error, model.difference); worst > kMaxUncertainty)
    diagnostics.warning(
        "linear.inaccurate", {request.file},
        fmt::format("entries of the linear model are uncertain by {:.3g} relative to their row, expected below {:g}",
                    worst, kMaxUncertainty),
        "bough linearize names what makes it uncertain: linearize on one side of it");
  const bool is_single = model.inputs.size() == 1 && model.outputs.size() == 1;
  const bool is_cut = num_cut > 0 && model.inputs.size() == num_cut && model.outputs.size() == num_cut;
  with_prior_messages(diagnostics, [&] {
    if (model.inputs.size() == 0 || model.outputs.size() == 0)
      throw InputError("linear.no-channels", {request.file}, "the model has no input or no output",
                       "name some with --inputs and --outputs of bough linearize");
    if (request.is_loop && !is_single && !is_cut)
      throw InputError("linear.no-loop", {request.file},
                       fmt::format("a loop has one input and one output, this model has {} and {}", model.inputs.size(),
                                   model.outputs.size()),
                       "choose them with --inputs and --outputs");
  });
  const bool is_loop = is_cut || (is_single && request.is_loop);
  std::optional<statespace::InputSpectrum> input;
  auto range = is_loop ? statespace::widen_for_loop(model, request.range) : request.range;
  if (!request.psd.empty()) {
    input = read_input_spectrum(request.psd, model, request.file);
    choose_band(model, *input, range);
    if (range.to_hz > 0 && range.to_hz <= range.from_hz)
      throw InputError("cli.bad-range", {request.file},
                       fmt::format("the spectral densities end at {:g} Hz, the frequencies begin at {:g}", range.to_hz,
                                   range.from_hz),
                       "give --from below the end of the tables");
  }
  answer.response = statespace::calc_frequency_response(model, range);
  auto files = list_spectrum_files(request.psd);
  files.insert(files.begin(), request.file);
  answer.response.source = calc_sources(files);
  answer.peak = statespace::calc_peak_gain(model, answer.response);
  if (is_loop) answer.margins = statespace::calc_margins(model, answer.response);
  if (input) {
    const auto& hz = answer.response.frequency_hz;
    with_prior_messages(diagnostics, [&] {
      check_input_spectrum(*input, {hz.begin(), hz.end()}, request.psd, request.file);
      answer.random = statespace::calc_random_outputs(model, *input, answer.response);
    });
    compare_integrals(*answer.random, request.file, diagnostics);
  }
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
