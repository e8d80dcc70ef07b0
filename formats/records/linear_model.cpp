#include "formats/records/linear_model.hpp"

namespace bough::records {

SecondOrder make_second_order(const LinearModel& model) {
  const Eigen::Index n = model.mass.rows();
  if (n == 0 || model.sample_time > 0 || model.A.rows() != 2 * n) return {};
  // δ̇ = T δ + δu with constant T, and δu̇ = A_q δ + A_u δu + B u: δu is taken out.
  const Eigen::MatrixXd T = model.A.topLeftCorner(n, n), A_q = model.A.bottomLeftCorner(n, n),
                        A_u = model.A.bottomRightCorner(n, n);
  return {model.mass, -model.mass * (A_u + T), model.mass * (A_u * T - A_q), model.mass * model.B.bottomRows(n)};
}

}  // namespace bough::records
