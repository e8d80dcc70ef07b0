#pragma once
/// \file Linear fractional models of uncertain parameters (Zhou, Doyle & Glover, Robust and Optimal Control, 1996,
/// ch. 10): the nominal model with inputs w and outputs z more, closed by w = δ z with one δ in [-1, 1] a parameter.
///
/// M δü = ..., ż = ... and y of a mechanical system are affine in stiffnesses, dampings, gains, masses and loads where
/// A, B, C, D themselves are not: written as R(p) [δü; x; u] = [rates; 0; y], R(p) = R0 + Σ δ_i R_i, and each R_i is a
/// product of few columns and rows, of one for a modal stiffness or a gain.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"
#include "formats/records/linear_model.hpp"

namespace bough::statespace {

/// Models at both ends of the range of one parameter, all others in the middle of theirs.
struct ParameterEnds {
  std::string name;
  double low = 0, high = 0;  ///< as they were given
  records::LinearModel at_low, at_high;
};

/// Inputs w and outputs z come before those of the nominal model, "NAME:w1" and "NAME:z1"; uncertainty tells how many
/// each parameter has. The poles and zeros are those of the nominal model.
/// \param nominal  all parameters in the middle of their ranges; with its mass matrix, continuous
/// \param together  all of them at their upper ends: parameters that multiply each other show there
/// \param error  what entries of the models may be off by, relative to the largest of the row
/// \throws InputError "linear.not-affine" where the equations are not affine in a parameter or in all of them together,
/// "linear.no-effect" where a parameter changes nothing.
records::LinearModel make_uncertain_model(const records::LinearModel& nominal, const std::vector<ParameterEnds>& ends,
                                          const records::LinearModel& together, double error, const SourceLocation& at);

/// The model with w = δ z closed; delta: one value a parameter. \throws ComputationError "linear.no-inverse" where the
/// loop has no solution.
records::LinearModel close_uncertainty(const records::LinearModel& model, const Eigen::VectorXd& delta);

}  // namespace bough::statespace
