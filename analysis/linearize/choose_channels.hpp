#pragma once
/// \file Some inputs and outputs of a linear model.
#include <string>
#include <vector>

#include "formats/records/linear_model.hpp"

namespace bough::analysis {

/// The model with these inputs and outputs only, by name ("tip" is all its components); empty lists: all. InputError
/// "linear.unknown-input", "linear.unknown-output".
records::LinearModel choose_channels(records::LinearModel model, const std::vector<std::string>& inputs,
                                     const std::vector<std::string>& outputs, const std::string& file);

}  // namespace bough::analysis
