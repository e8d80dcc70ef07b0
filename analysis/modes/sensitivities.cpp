#include "analysis/modes/sensitivities.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "analysis/common/ranks.hpp"
#include "analysis/common/superelements.hpp"
#include "analysis/listing/listing.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/statics/build_model.hpp"
#include "formats/nastran/reader.hpp"

namespace bough::analysis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Step of a variable, relative to its value.
constexpr double kStep = 1e-3;
/// Eigenvalues that near to each other are one, repeated.
constexpr double kRepeated = 1e-7;

struct Grams {
  MatrixXd K, M;  ///< ΦᵀKΦ, ΦᵀMΦ
};

/// Matrices of the deck with another value of a variable, on the modes of the deck itself.
Grams calc_grams(const std::string& path, const fe::ModelOptions& options, const records::DesignVariable& variable,
                 double value, const fe::Model& model, const MatrixXd& Phi) {
  Diagnostics ignored;
  nastran::ReadOptions read{options.ignore_cards};
  read.design_values[variable.id] = value;
  auto deck = is_one_of_many()
                  ? nastran::read_packed_deck(share([&] { return nastran::pack_deck(path); }), read, ignored)
                  : nastran::read_deck(path, read, ignored);
  join_superelements(deck, ignored);
  ignored.throw_if_errors();
  const auto other = fe::build_model(deck, options, ignored);
  BOUGH_DEMAND(other.num_gdofs() == model.num_gdofs());  // values of fields add no point
  return {Phi.transpose() * fe::calc_stiffness_times(other, Phi),
          Phi.transpose() * fe::calc_mass_times(other, other.mass_kind(), Phi)};
}

/// Columns of dA of one eigenvalue, repeated `size` times from `first` on: the eigenvalues of dA on its modes.
VectorXd calc_branches(const MatrixXd& dA, Index first, Index size) {
  const MatrixXd block = dA.block(first, first, size, size);
  if (size == 1) return block.diagonal();
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(0.5 * (block + block.transpose()), Eigen::EigenvaluesOnly)
      .eigenvalues();
}

}  // namespace

ModeSensitivities calc_sensitivities(const std::string& path, const fe::ModelOptions& options, const fe::Model& model,
                                     const VectorXd& lambda, const MatrixXd& Phi) {
  Diagnostics ignored;
  const auto deck = read_loads_deck_or_throw(path, options, false, ignored);
  ModeSensitivities found;
  found.variables = deck.dynamics.design_variables;
  if (found.variables.empty())
    throw InputError("modal.no-variables", {path},
                     deck.sol == "200" ? "no DESVAR has a relation to a property"
                                       : "the deck has SOL " + deck.sol + ", and only SOL 200 has design variables",
                     "give DESVAR with DVPREL1, DVMREL1 or DVCREL1 in a deck of SOL 200");
  BOUGH_DEMAND(!model.prestress());  // SOL 200 has no preload
  const Index n = lambda.size(), num = static_cast<Index>(found.variables.size());
  const MatrixXd M = Phi.transpose() * fe::calc_mass_times(model, model.mass_kind(), Phi);
  const VectorXd scale = M.diagonal().cwiseSqrt().cwiseInverse();
  found.eigenvalue.resize(n, num);
  found.frequency_slope_hz.resize(n, num);
  for (Index v = 0; v < num; ++v) {
    const auto& variable = found.variables[static_cast<std::size_t>(v)];
    const double step = variable.value != 0 ? kStep * std::abs(variable.value) : kStep;
    std::array<Grams, 2> slope;
    for (std::size_t half = 0; half < 2; ++half) {
      const double h = half == 0 ? step : step / 2;
      const auto above = calc_grams(path, options, variable, variable.value + h, model, Phi);
      const auto below = calc_grams(path, options, variable, variable.value - h, model, Phi);
      slope[half] = {(above.K - below.K) / (2 * h), (above.M - below.M) / (2 * h)};
    }
    // Richardson: the error of h² cancels.
    const MatrixXd dK = (4 * slope[1].K - slope[0].K) / 3, dM = (4 * slope[1].M - slope[0].M) / 3;
    for (Index first = 0, size = 1; first < n; first += size) {
      size = 1;
      while (first + size < n && std::abs(lambda[first + size] - lambda[first]) <= kRepeated * std::abs(lambda[first]))
        ++size;
      const MatrixXd dA = scale.asDiagonal() * (dK - lambda[first] * dM) * scale.asDiagonal();
      found.eigenvalue.col(v).segment(first, size) = calc_branches(dA, first, size);
    }
  }
  found.frequency_hz = lambda.cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  const double min_hz = n > 0 ? 1e-4 * found.frequency_hz.maxCoeff() : 0;
  for (Index j = 0; j < n; ++j) {
    if (found.frequency_hz[j] > min_hz)
      found.frequency_slope_hz.row(j) =
          found.eigenvalue.row(j) / (8 * std::numbers::pi * std::numbers::pi * found.frequency_hz[j]);
    else
      found.frequency_slope_hz.row(j).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return found;
}

}  // namespace bough::analysis
