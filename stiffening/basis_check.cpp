#include "stiffening/basis_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fe/linear/blas.hpp"
#include "fe/matrices/assembly.hpp"

namespace bough::stiffening {

namespace {

/// Round-off of φᵀKφ relative to the sum of the magnitudes of its terms: 1,000 roundings.
constexpr double kStiffnessRoundoff = 1e-13;

/// The largest difference relative to the diagonal of `expected`; rows with zero there are skipped, as are entries up
/// to `roundoff` (m x m, or empty).
double find_largest_difference(const Eigen::MatrixXd& A, const Eigen::MatrixXd& expected,
                               const Eigen::MatrixXd& roundoff = {}) {
  double worst = 0;
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      const double size = std::sqrt(std::abs(expected(i, i) * expected(j, j)));
      const double off = std::abs(A(i, j) - expected(i, j));
      if (!std::isfinite(off)) return off;
      if (size > 0 && (roundoff.size() == 0 || off > roundoff(i, j))) worst = std::max(worst, off / size);
    }
  return worst;
}

}  // namespace

BasisCheck check_basis(const fe::Model& model, const Eigen::MatrixXd& Phi, const Eigen::MatrixXd& modal_mass,
                       const Eigen::MatrixXd& modal_stiffness) {
  if (Phi.cols() == 0) return {};
  const auto M = linear::calc_inner_products(Phi, fe::calc_mass_times(model, model.mass_kind(), Phi));
  const auto K = linear::calc_inner_products(Phi, fe::calc_stiffness_times(model, Phi));
  BasisCheck check;
  check.mass = find_largest_difference(M, modal_mass);
  check.stiffness = find_largest_difference(K, modal_stiffness);
  check.beyond_roundoff = std::max(check.mass, check.stiffness);
  if (check.mass <= kBasisError && check.stiffness > kBasisError) {
    const Eigen::VectorXd diagonal = linear::get_diagonal(fe::assemble_stiffness(model, fe::DofSet::Global)).cwiseAbs();
    const Eigen::VectorXd parts = (Phi.cwiseAbs2().transpose() * diagonal).cwiseSqrt();
    check.beyond_roundoff = find_largest_difference(K, modal_stiffness, kStiffnessRoundoff * parts * parts.transpose());
  }
  return check;
}

void report_basis(const BasisCheck& check, const SourceLocation& at, Diagnostics& diagnostics) {
  if (check.mass <= kBasisWarning && check.stiffness <= kBasisWarning) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "the modal matrices are off from those of the mode shapes: mass %.1e, stiffness %.1e, expected below "
                "%.0e",
                check.mass, check.stiffness, kBasisWarning);
  const char* advice = "look for very soft next to very stiff parts: replace the stiffest by rigid elements";
  if (!std::isfinite(check.mass + check.stiffness) || check.beyond_roundoff > kBasisError)
    throw ComputationError("reduce.basis-off", at, text, advice);
  diagnostics.warning("reduce.basis-off", at, text, advice);
}

}  // namespace bough::stiffening
