#pragma once
/// \file Modes of a deck over the speed of its rotors: Campbell diagram, critical speeds, onset of instability.
#include <string>

#include "analysis/common/events.hpp"
#include "formats/records/complex_modes.hpp"
#include "modal/complex/complex_modes.hpp"

namespace bough::analysis {

/// Solves at every speed of the rotors and follows the modes; critical speeds and thresholds are solved for, not
/// interpolated. Of synchronous analyses the rotors alone. Reports linear.sweep-jump and modal.rotor-lost (warnings).
/// \pre solver.rotor_case() is not nullptr.
records::RotorSpeeds calc_rotor_speeds(const modal::complex_modes::ComplexModesSolver& solver, const std::string& file,
                                       Events& events, Diagnostics& diagnostics);

}  // namespace bough::analysis
