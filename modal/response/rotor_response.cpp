#include "modal/response/rotor_response.hpp"

#include <numbers>

namespace bough::modal::response {

linear::ComplexSparse RotorResponse::calc_stiffness(double hz) const {
  using Complex = std::complex<double>;
  const double omega = 2 * std::numbers::pi * hz, speed = is_synchronous_ ? omega : speed_;
  const auto scaled = [](const fe::SparseColumns& A, Complex factor) {
    return linear::ComplexSparse(A.cast<Complex>() * factor);
  };
  linear::ComplexSparse Z = scaled(terms_.calc_circulation(speed), 1);
  Z += scaled(terms_.calc_centrifugal(speed), 1);
  Z += scaled(terms_.calc_structural_circulation(speed, omega), 1);
  Z += scaled(terms_.calc_damping(speed), Complex(0, omega));
  Z += scaled(terms_.calc_structural(), Complex(0, 1));
  Z += scaled(terms_.model_structural(), Complex(0, -1));
  return Z;
}

}  // namespace bough::modal::response
