#pragma once
/// \file Frequency response, peak gain and margins of a linear model.
#include <optional>
#include <string>
#include <vector>

#include "analysis/common/events.hpp"
#include "formats/records/frequency_response.hpp"
#include "formats/records/linear_model.hpp"
#include "solver/statespace/frequency_response.hpp"

namespace bough::analysis {

struct ResponseRequest {
  std::string file;                          ///< linear model
  std::vector<std::string> inputs, outputs;  ///< empty: all
  statespace::FrequencyRange range;
  bool is_loop = false;  ///< margins of one input and output as a loop with negative feedback
};

struct ResponseAnswer {
  records::LinearModel model;  ///< with the chosen inputs and outputs
  records::FrequencyResponse response;
  records::PeakGain peak;
  std::optional<records::Margins> margins;  ///< of a loop, also of linearize --break
};

/// Warning: linear.inaccurate.
/// \throws InputError "cli.bad-range", "linear.no-channels", "linear.no-loop", those of choose_channels and of reading.
ResponseAnswer calc_response(const ResponseRequest& request, Events& events);

}  // namespace bough::analysis
