#pragma once
/// \file The chapter of a linear model: poles and zeros, Bode diagrams.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/linear_model.hpp"
#include "formats/report/page.hpp"

namespace bough::report {

/// H(jω) of chosen pairs of input and output at frequencies in cycles per unit of time.
struct FrequencyResponse {
  struct Pair {
    int output = 0, input = 0;
    Eigen::VectorXd decibel, degrees;  ///< |H| in dB (of the units of y over u), phase unwrapped
  };
  Eigen::VectorXd frequency;
  std::vector<Pair> pairs;
};

/// C (jω - A)⁻¹ B + D by Hessenberg's form of A, at most `most_pairs` pairs; frequencies a decade beyond the poles,
/// dense about those that are lightly damped.
FrequencyResponse calc_frequency_response(const records::LinearModel& model, int most_pairs = 24);

Chapter make_chapter(const records::LinearModel& model, const std::string& file,
                     const std::vector<std::pair<std::string, std::string>>& facts);

}  // namespace bough::report
