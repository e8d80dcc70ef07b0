#include <cmath>
#include <cstdio>
#include <numbers>

#include "modal/response/coordinates.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::response {
namespace {

using namespace std::complex_literals;
using Eigen::VectorXcd;

std::string describe(const ResponseModel& model, Eigen::Index j) {
  char text[64];
  if (j < model.num_rigid) return "the model moves freely";
  std::snprintf(text, sizeof text, "the mode at %.8g Hz is not damped",
                std::sqrt(model.lambda(j)) / (2 * std::numbers::pi));
  return text;
}

/// \param Z_added  addition to the matrix; may be empty
VectorXcd solve_coordinates(const ResponseModel& model, double hz, const VectorXcd& force, const MatrixXcd& Z_added) {
  const bool is_coupled = model.is_coupled || Z_added.size() > 0;
  const auto n = model.lambda.size();
  const double omega = 2 * std::numbers::pi * hz;
  VectorXd inertia = VectorXd::Constant(n, omega * omega);
  inertia.tail(model.num_massless).setZero();
  const VectorXd real = model.lambda - inertia;
  const VectorXcd diagonal = real.cast<std::complex<double>>() +
                             1i * (omega * model.D.diagonal() + model.S.diagonal()).cast<std::complex<double>>();
  for (Eigen::Index j = 0; j < n; ++j)
    if (!is_coupled && std::abs(diagonal(j)) <= detail::kResonance * std::max(model.lambda(j), inertia(j)))
      throw_unbounded(hz, describe(model, j));
  if (!is_coupled) return force.cwiseQuotient(diagonal);
  MatrixXcd Z = 1i * (omega * model.D + model.S).cast<std::complex<double>>();
  Z.diagonal() = diagonal;
  if (Z_added.size() > 0) Z += Z_added;
  // Residual vectors lie many orders above the modes: rows and columns of one size.
  const VectorXd scale = model.lambda.cwiseAbs().cwiseMax(inertia).cwiseMax(detail::kTiny).cwiseSqrt().cwiseInverse();
  const Eigen::PartialPivLU<MatrixXcd> lu(scale.asDiagonal() * Z * scale.asDiagonal());
  const VectorXcd pivots = lu.matrixLU().diagonal();
  if (n > 0 && !(pivots.cwiseAbs().minCoeff() > detail::kResonance))
    throw_unbounded(hz, model.num_rigid > 0 && hz == 0 ? "the model moves freely" : "a mode is not damped");
  return scale.asDiagonal() * lu.solve(scale.asDiagonal() * force).eval();
}

}  // namespace

void throw_unbounded(double hz, const std::string& why) {
  char text[64];
  std::snprintf(text, sizeof text, "the response at %.8g Hz is unbounded: ", hz);
  throw ComputationError("modal.unbounded-response", {}, text + why,
                         "give damping (SDAMPING, PARAM,G, GE, dampers), or leave this frequency out");
}

bool BoundedFrequencies::take(const std::function<void()>& solve) {
  try {
    solve();
  } catch (const ComputationError& failure) {
    if (failure.items().empty() || failure.items().front().id != "modal.unbounded-response") throw;
    left_out_.push_back(failure.items().front());
    return false;
  }
  ++num_kept_;
  return true;
}

void BoundedFrequencies::report(Diagnostics& diagnostics) const {
  if (num_kept_ == 0 && !left_out_.empty()) throw ComputationError({left_out_.front()});
  for (auto item : left_out_) {
    item.severity = Severity::Warning;
    item.what += "; it is left out";
    diagnostics.add(item);
  }
}

VectorXcd calc_amplitudes(const Excitation& excitation, double hz, VectorXcd& d) {
  const auto m = excitation.F.cols(), k = excitation.D.cols();
  const double omega = 2 * std::numbers::pi * hz;
  VectorXcd a = VectorXcd::Zero(m + 3 * k);
  for (const auto& term : excitation.forces) a(term.column) += calc_amplitude(term, hz);
  d = VectorXcd::Zero(k);
  for (const auto& term : excitation.motions) {
    using Type = records::DynamicLoad::Excitation;
    auto amplitude = calc_amplitude(term, hz);
    const auto type = term.card->excitation;
    if (type != Type::Displacement && hz == 0)
      throw_unbounded(hz, "a steady velocity or acceleration of the supports goes on and on");
    if (type == Type::Velocity) amplitude /= 1i * omega;
    if (type == Type::Acceleration) amplitude /= -omega * omega;
    d(term.column) += amplitude;
  }
  a.segment(m, k) = omega * omega * d;
  a.segment(m + k, k) = -1i * omega * d;
  a.tail(k) = -1i * d;
  return a;
}

Spectrum calc_spectrum(const ResponseModel& model, const Excitation& excitation, const VectorXd& hz,
                       Diagnostics& diagnostics, const AddedCoordinates& added) {
  const auto n = model.lambda.size();
  Spectrum s;
  s.q.resize(n, hz.size());
  s.d.resize(excitation.D.cols(), hz.size());
  s.a.resize(model.P.cols(), hz.size());
  BoundedFrequencies bounded;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < hz.size(); ++i) {
    const auto solve = [&] {
      VectorXcd d;
      s.a.col(i) = calc_amplitudes(excitation, hz(i), d);
      s.d.col(i) = d;
      VectorXcd force = model.P * s.a.col(i);
      MatrixXcd Z;
      if (added) {
        auto [of_modes, of_supports] = added(hz(i));
        Z = std::move(of_modes);
        if (d.size() > 0) force -= of_supports * d;
      }
      s.q.col(i) = solve_coordinates(model, hz(i), force, Z);
    };
    if (bounded.take(solve)) kept.push_back(i);
  }
  bounded.report(diagnostics);
  s.hz = hz(kept);
  s.q = s.q(Eigen::all, kept).eval();
  s.d = s.d(Eigen::all, kept).eval();
  s.a = s.a(Eigen::all, kept).eval();
  return s;
}

}  // namespace bough::modal::response
