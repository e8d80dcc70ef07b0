#pragma once
/// \file Frequency response, peak gain, margins and random response of a linear model.
#include <optional>
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "formats/records/frequency_response.hpp"
#include "formats/records/linear_model.hpp"
#include "formats/records/random_outputs.hpp"
#include "solver/statespace/frequency_response.hpp"

namespace bough::analysis {

struct ResponseRequest {
  std::string file;                          ///< linear model
  std::vector<std::string> inputs, outputs;  ///< empty: all
  statespace::FrequencyRange range;
  bool is_loop = false;          ///< margins of one input and output as a loop with negative feedback
  std::vector<std::string> psd;  ///< spectral densities of the inputs: NUMBER, NAME=NUMBER or files; empty: none
};

struct ResponseAnswer {
  records::LinearModel model;  ///< with the chosen inputs and outputs
  records::FrequencyResponse response;
  records::PeakGain peak;
  std::optional<records::Margins> margins;  ///< of a loop, also of linearize --break
  std::optional<records::RandomOutputs> random;
};

/// Warnings: linear.inaccurate, linear.random-sampling. Note: linear.random-band.
/// \throws InputError "cli.bad-range", "linear.no-channels", "linear.no-loop", those of choose_channels, of
/// read_input_spectrum and of reading; ComputationError "linear.unbounded-random".
ResponseAnswer calc_response(const ResponseRequest& request, Events& events);

}  // namespace bough::analysis
