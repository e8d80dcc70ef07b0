#pragma once
/// \file Weights of outputs and inputs: --weight NAME=NUMBER.
#include <string>
#include <vector>

namespace bough::analysis {

struct Weight {
  std::string name;
  double value = 1;
};

/// Throws InputError "select.bad-weight" if a word is not NAME=NUMBER.
std::vector<Weight> read_weights(const std::vector<std::string>& words, const std::string& file);

/// Throws InputError "select.bad-weight" for a weight of a signal that is not among `known`.
[[noreturn]] void fail_weight(const std::string& name, const std::string& file, const std::vector<std::string>& known);

}  // namespace bough::analysis
