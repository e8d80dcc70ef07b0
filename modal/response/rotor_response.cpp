#include "modal/response/rotor_response.hpp"

#include <numbers>
#include <string>

namespace bough::modal::response {

linear::ComplexSparse RotorResponse::calc_stiffness(double hz) const {
  using Complex = std::complex<double>;
  const double omega = 2 * std::numbers::pi * hz, speed = is_synchronous_ ? omega : speed_;
  const auto scaled = [](const fe::SparseColumns& A, Complex factor) {
    return linear::ComplexSparse(A.cast<Complex>() * factor);
  };
  linear::ComplexSparse Z = scaled(terms_.calc_circulation(speed), 1);
  Z += scaled(terms_.calc_centrifugal(speed), 1);
  const fe::SparseColumns circulation = terms_.calc_structural_circulation(speed, omega);
  for (const auto& rotor : terms_.rotors())
    if (rotor.is_spatial && circulation.norm() > 0)
      throw InputError("modal.rotor-unsupported", {},
                       "structural damping inside rotor " + std::to_string(rotor.id) +
                           ", whose grids are around its axis, is not supported in a frequency response",
                       "leave GR, PARAM,G and the GE of its materials out");
  Z += scaled(circulation, 1);
  Z += scaled(terms_.calc_damping(speed), Complex(0, omega));
  Z += scaled(terms_.calc_structural(), Complex(0, 1));
  Z += scaled(terms_.model_structural(), Complex(0, -1));
  return Z;
}

}  // namespace bough::modal::response
