#include "analysis/response/response.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/common/failures.hpp"
#include "analysis/common/inputs.hpp"
#include "analysis/linearize/choose_channels.hpp"
#include "formats/hdf5/linear_file.hpp"

namespace bough::analysis {

namespace {

/// Models with a larger error are reported, as by linearize.
constexpr double kMaxUncertainty = 1e-4;

}  // namespace

ResponseAnswer calc_response(const ResponseRequest& request, Events& events) {
  demand_file(request.file);
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
  answer.response = statespace::calc_frequency_response(
      model, is_loop ? statespace::widen_for_loop(model, request.range) : request.range);
  answer.response.source = calc_sources({request.file});
  answer.peak = statespace::calc_peak_gain(model, answer.response);
  if (is_loop) answer.margins = statespace::calc_margins(model, answer.response);
  add_messages(diagnostics, events);
  return answer;
}

}  // namespace bough::analysis
