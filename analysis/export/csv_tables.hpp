#pragma once
/// \file Linear models, their frequency response and events as CSV.
#include <string>
#include <vector>

#include "formats/records/frequency_response.hpp"
#include "formats/records/linear_model.hpp"
#include "formats/records/linear_sweep.hpp"
#include "formats/records/random_outputs.hpp"
#include "formats/records/results.hpp"

namespace bough::analysis {

/// frequency_hz, OUTPUT/INPUT:real and :imag of each pair, singular values sigma1, sigma2, ...
std::string make_response_csv(const records::FrequencyResponse& response);
/// frequency_hz, OUTPUT:psd and OUTPUT:cumulative_rms of each output.
std::string make_random_csv(const records::RandomOutputs& random);
/// [A B; C D] as one table: a row for each state's rate, then for each output; the first column names it.
std::string make_linear_csv(const records::LinearModel& model);
/// A row a value: the parameter, then real, imaginary part, frequency and damping of each branch.
std::string make_sweep_csv(const records::LinearSweep& sweep);
/// time, what, source; texts in quotes (RFC 4180).
std::string make_events_csv(const std::vector<records::EventRecord>& events);

}  // namespace bough::analysis
