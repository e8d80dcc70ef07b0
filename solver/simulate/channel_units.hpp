#pragma once
/// \file Units of the channels of a run, by the labels of the system file.
#include <string>
#include <vector>

#include "formats/records/results.hpp"
#include "formats/records/system_spec.hpp"
#include "solver/system/system.hpp"

namespace bough::solver {

/// Returns true if a dimension 1 or 1/T^n of the channel (a path of the results file) is an angle or its derivative.
bool is_angle(const System& system, const records::SystemSpec& spec, const std::string& channel);

/// Sets the units of each channel; without [units] in the system file the channels are unchanged.
void label_channels(const System& system, const records::SystemSpec& spec, std::vector<records::Channel>& channels);

}  // namespace bough::solver
