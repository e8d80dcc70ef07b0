#include "modal/response/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "fe/linear/blas.hpp"
#include "fe/matrices/assembly.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::response {

using namespace std::complex_literals;

BasisError calc_basis_error(const fe::Model& model, const ResponseModel& response) {
  constexpr double kRoundoff = 1e-13;
  const auto n = response.lambda.size(), num = response.num_dynamic();
  const MatrixXd M =
      linear::calc_inner_products(response.Phi, fe::calc_mass_times(model, model.mass_kind(), response.Phi));
  const MatrixXd K = linear::calc_inner_products(response.Phi, fe::calc_stiffness_times(model, response.Phi));
  BasisError error;
  const auto raise = [](double& worst, double value) {
    if (!std::isnan(worst) && !(value <= worst)) worst = value;
  };
  VectorXd parts;  // made only if the error is large
  const auto is_roundoff = [&](double off, Eigen::Index i, Eigen::Index j) {
    if (parts.size() == 0) {
      const VectorXd diagonal = linear::get_diagonal(fe::assemble_stiffness(model, fe::DofSet::Global)).cwiseAbs();
      parts = (response.Phi.cwiseAbs2().transpose() * diagonal).cwiseSqrt();
    }
    return off <= kRoundoff * parts(i) * parts(j);
  };
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      if (i < num && j < num) raise(error.worst, std::abs(M(i, j) - (i == j ? 1 : 0)));
      if (i < num && j < num) raise(error.beyond_roundoff, std::abs(M(i, j) - (i == j ? 1 : 0)));
      if (i < response.num_rigid || j < response.num_rigid) continue;  // no strain to measure by
      const double size = std::sqrt(std::abs(response.lambda(i) * response.lambda(j)));
      const double off = std::abs(K(i, j) - (i == j ? response.lambda(i) : 0));
      if (!(size > 0)) continue;
      raise(error.worst, off / size);
      if (off / size <= kAccuracyError || !is_roundoff(off, i, j)) raise(error.beyond_roundoff, off / size);
    }
  return error;
}

double calc_solution_error(const ResponseModel& response, const Spectrum& spectrum, const AddedCoordinates& added) {
  const auto n = response.lambda.size();
  VectorXd mass = VectorXd::Ones(n);
  mass.tail(response.num_massless).setZero();
  double worst = 0;
  for (Eigen::Index i = 0; i < spectrum.hz.size(); ++i) {
    const double omega = 2 * std::numbers::pi * spectrum.hz(i);
    const VectorXd inertia = omega * omega * mass;
    const Eigen::VectorXcd q = spectrum.q.col(i), force = response.P * spectrum.a.col(i);
    const Eigen::VectorXcd damped = 1i * (omega * (response.D * q) + response.S * q);
    Eigen::VectorXcd rest = (response.lambda - inertia).cwiseProduct(q) + damped - force;
    if (added) {
      const auto [of_modes, of_supports] = added(spectrum.hz(i));
      rest += of_modes * q;
      if (spectrum.d.rows() > 0) rest += of_supports * spectrum.d.col(i);
    }
    const VectorXd scale =
        response.lambda.cwiseAbs().cwiseMax(inertia).cwiseMax(detail::kTiny).cwiseSqrt().cwiseInverse();
    const double size = scale.cwiseProduct(force).norm(), off = scale.cwiseProduct(rest).norm();
    if (off > 0) worst = std::max(worst, size > 0 ? off / size : 1.0);
  }
  return worst;
}

void ResidualRecord::add(const VectorXd& D, const Eigen::VectorXcd& x, const Eigen::VectorXcd& A_x,
                         const Eigen::VectorXcd& b) {
  constexpr double kEntries = 1e-6;  // as in fe/linear/residual.cpp
  if (std::isnan(rest_)) return;     // and stays
  const VectorXd scale = D.cwiseSqrt().cwiseInverse();
  const double rest = scale.cwiseProduct(A_x - b).norm();
  const double size = scale.cwiseProduct(A_x).norm() + kEntries * D.cwiseSqrt().cwiseProduct(x).norm();
  if (is_over_time_) {
    if (!(rest <= rest_)) rest_ = rest;
    if (!(size <= size_)) size_ = size;
  } else if (rest != 0 && (rest_ == 0 || !(rest * size_ <= rest_ * size))) {
    rest_ = rest;
    size_ = size;
  }
}

double ResidualRecord::worst() const { return rest_ == 0 ? 0 : rest_ / size_; }

void report_residual(double residual, const SourceLocation& at, Diagnostics& diagnostics) {
  if (residual <= kAccuracyWarning) return;
  char text[112];
  std::snprintf(text, sizeof text, "the response fulfils its equation to %.1e, expected below %.0e", residual,
                kAccuracyWarning);
  const char* advice =
      "look for very soft parts next to very stiff ones, for a mode with almost no damping, and for steps far below "
      "what "
      "moves";
  if (residual <= kAccuracyError) return diagnostics.warning("modal.response-accuracy", at, text, advice);
  throw ComputationError("modal.response-accuracy", at, text, advice);
}

void report_accuracy(const BasisError& basis_error, double solution_error, const SourceLocation& at,
                     Diagnostics& diagnostics) {
  const auto is_within = [&](double limit) { return basis_error.worst <= limit && solution_error <= limit; };  // no NaN
  if (is_within(kAccuracyWarning)) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "the modes fulfil their orthogonality to %.1e and the response its equation to %.1e, expected below "
                "%.0e",
                basis_error.worst, solution_error, kAccuracyWarning);
  const char* advice = "look for very soft parts next to very stiff ones, and for a mode with almost no damping";
  if (solution_error <= kAccuracyError && basis_error.beyond_roundoff <= kAccuracyError &&
      std::isfinite(basis_error.worst))
    return diagnostics.warning("modal.response-accuracy", at, text, advice);
  throw ComputationError("modal.response-accuracy", at, text, advice);
}

}  // namespace bough::modal::response
