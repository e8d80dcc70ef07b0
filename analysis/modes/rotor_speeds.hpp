#pragma once
/// \file Modes of a deck over the speed of its rotors: Campbell diagram, critical speeds, onset of instability.
#include <complex>
#include <string>

#include "analysis/common/events.hpp"
#include "formats/records/complex_modes.hpp"
#include "modal/complex/complex_modes.hpp"

namespace bough::analysis {

/// Returns true if a mode oscillates so that an unbalance that passes its frequency excites it most there: |ζ| < 1/√2.
/// An eigenvalue of more damping is no critical speed.
bool is_resonant(std::complex<double> lambda);

/// Solves at every speed of the rotors and follows the modes; critical speeds and thresholds are solved for, not
/// interpolated. Of synchronous analyses the rotors alone. Reports linear.sweep-jump and modal.rotor-lost (warnings).
/// \pre solver.rotor_case() is not nullptr.
records::RotorSpeeds calc_rotor_speeds(const modal::complex_modes::ComplexModesSolver& solver, const std::string& file,
                                       Events& events, Diagnostics& diagnostics);

}  // namespace bough::analysis
