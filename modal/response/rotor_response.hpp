#pragma once
/// \file Rotors of a frequency response (RGYRO), and the motion that unbalances drive (docs/theory/rotors.md).
#include "modal/complex/rotor_case.hpp"
#include "modal/response/deck_response.hpp"

namespace bough::modal::response {

/// Rotor terms of the dynamic stiffness at one frequency.
class RotorResponse {
 public:
  /// \param g  PARAM,G. Reports what rotors::choose_rotors and rotors::RotorTerms do. Throws errors.
  RotorResponse(const fe::Model& model, const rotors::RotorCase& rotor_case, double g, Diagnostics& diagnostics)
      : is_synchronous_(rotor_case.is_synchronous),
        speed_(rotor_case.speeds.empty() ? 0 : rotor_case.speeds.front()),
        terms_(model, rotor_case, g, diagnostics) {}

  /// Z = Σ iω (Ω G + C) + Ω R + Ω² S + i H + Ω/ω (-H ẽ), minus the part of the model's structural damping that H
  /// replaces; num_gdofs x num_gdofs, basic axes. Ω is the speed of RGYRO, or ω of synchronous analyses.
  linear::ComplexSparse calc_stiffness(double hz) const;
  /// Returns true if the excitation has the speed of the reference rotor.
  bool is_synchronous() const { return is_synchronous_; }

 private:
  bool is_synchronous_;
  double speed_;  ///< [1/T]
  rotors::RotorTerms terms_;
};

}  // namespace bough::modal::response
