#pragma once
/// \file Units for headings: of frequencies in cycles per unit of time, of signals with dimensions.
#include <string>

#include "formats/records/unit_labels.hpp"

namespace bough::records {

/// Unit of a number of cycles per unit of time: "Hz" for a time in seconds or without a label, "kHz" for "ms", else
/// "1/min".
///
/// \param time  label of the unit of time, [units] of a system or body file; empty or "T": none.
std::string name_frequency_unit(const std::string& time);
/// Dimensions of a state, input or output in the labels of the units, "kg m^2/s"; `dims` itself where a label is
/// missing.
std::string label_dims(const std::string& dims, const UnitLabels& units);

}  // namespace bough::records
