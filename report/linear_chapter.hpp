#pragma once
/// \file The chapters of a linear model, of its response and of its pointing budget: poles and zeros, Bode diagrams,
/// singular values, margins; RMS by source.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/frequency_response.hpp"
#include "formats/records/pointing_budget.hpp"
#include "report/page.hpp"

namespace bough::report {

/// Results computed from the model, in addition to those in its file.
struct LinearFindings {
  records::FrequencyResponse response;
  records::PeakGain peak;
  records::Margins margins;  ///< of a model with one input and one output
  bool has_margins = false;
};

/// Poles and zeros, Bode diagrams of at most 24 pairs of input and output, singular values, Hankel values.
Chapter make_chapter(const records::LinearModel& model, const LinearFindings& findings, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts);

/// Composes the budget: a table for each weighting; waterfall over sources; RMS up to each frequency by source and over
/// the speeds of wheels, of at most 6 outputs.
Chapter make_chapter(const records::PointingBudget& budget, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts);

/// Without a model's poles: what `response` wrote.
Chapter make_chapter(const LinearFindings& findings, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts);

}  // namespace bough::report
