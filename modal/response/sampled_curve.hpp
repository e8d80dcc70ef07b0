#pragma once
/// \file Slope and curvature of a motion that is known at the steps.
#include <Eigen/Dense>

namespace bough::modal::response {

/// On both sides of every sample.
struct SampledCurve {
  Eigen::VectorXd slope_before, slope_after, curvature_before, curvature_after;
  int num_corners = 0, first_corner = -1;
};

/// Through samples y(t), jumps where `before` and `after` differ: cubic splines between jumps and corners (ends not a
/// knot), so that slope and curvature are continuous and the curvature a line over each step (de Boor 1978, ch. IV).
/// A corner: the second difference there is more than eight times those next to it, as where a ramp begins; where a
/// smooth motion is sampled it is not. On lines between corners the curvature is 0.
SampledCurve make_curve(const Eigen::VectorXd& t, const Eigen::VectorXd& before, const Eigen::VectorXd& after);

}  // namespace bough::modal::response
