#pragma once
/// \file A loop that is cut where a signal is held between samples (docs/theory/linear.md, "Margins of sampled loops").
#include "formats/records/linear_model.hpp"
#include "solver/linear/sampled_system.hpp"

namespace bough::solver {

/// Model from sample to sample of the signal after the cut: ξ = [x; m; d], taken just before it changes, with d the
/// addition to it from one change to the next, and y the return at the change, all loops closed. Between samples
/// ẋ = A x + E m + b d by the matrix exponential, at samples by differences (sampled.hpp), their errors in
/// `uncertainty`; queues are renumbered after each period, which makes the map the same for all. If other samples do
/// not repeat within one of the cut's, the model is lifted: N inputs and outputs, the values at the cut within the
/// period of all samples, N times its own; D is lower triangular. `A`, `b`: of the continuous model, m held.
/// Throws InputError "linear.slower-samples" if there is no such period, or N exceeds 100.
records::LinearModel calc_sampled_loop(Plant& plant, const OperatingPoint& point, const PlantInput& cut,
                                       const MatrixXd& A, const VectorXd& b, const SourceLocation& at,
                                       Uncertainty& uncertainty);

/// The modes above half the sample rate 1 / sample_time among the poles λ of the continuous model.
std::vector<records::AliasedMode> find_aliased(const records::Poles& poles, double sample_time);

/// Poles of x⁺ = A x as those of ln z / sample_time; z below 1e-16 count as that.
records::Poles calc_sampled_poles(const records::LinearModel& model);

}  // namespace bough::solver
