#pragma once
/// \file Poles (crosses) and zeros (rings) of linear models: the s plane with rays of constant damping, or, of sampled
/// models, the z plane with the unit circle and curves of constant damping.
#include <string>
#include <utility>
#include <vector>

#include "formats/records/linear_model.hpp"
#include "report/svg_plot.hpp"

namespace bough::report {

/// [1/T] uncertainty of each pole as the file specifies it; at least `min` times the largest pole.
Eigen::VectorXd calc_pole_uncertainty(const records::Poles& poles, double min);

/// The poles without the round-off in the parts of undamped ones, which would fill the picture.
records::Poles round_poles(const records::Poles& poles);

/// Labels and axes of the z plane, with the unit circle and curves of constant damping.
void make_z_plane(Plot& plot);

/// Rays of constant damping and arcs of constant natural frequency |s|, for the s plane with the curves of `plot`.
void add_s_grid(Plot& plot);

/// One model or several with a name each; the z plane if all are sampled. Poles at one point of the marginal limit
/// (s = 0, z = 1) or at z = 0 are counted in a note. In the s plane poles at z = 0 are left out.
Plot make_pole_plot(const std::vector<std::pair<std::string, const records::LinearModel*>>& models);

}  // namespace bough::report
