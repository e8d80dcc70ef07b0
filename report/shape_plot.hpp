#pragma once
/// \file Shapes of a body as SVG, for readers without a script.
#include <string>
#include <vector>

#include "report/drawing.hpp"

namespace bough::report {

/// Draws the deformed body, coloured by displacement, over its undeformed edges; parallel projection. Dense meshes are
/// thinned to kMaxShapeEdges edges.
///
/// \param shape  index of the shape; -1: undeformed.
/// \param factor  coefficient of the shape; 0: its largest displacement is 12 % of the size of the body.
/// \return empty without points.
std::string draw_shape(const Drawing& drawing, int shape, const std::string& title, double factor = 0);

/// Pictures of the first `max_shapes` shapes, side by side.
std::string draw_shapes(const Drawing& drawing, const std::vector<std::string>& titles, std::size_t max_shapes = 6);

constexpr std::size_t kMaxShapeEdges = 1200, kMaxShapeFaces = 1200;

}  // namespace bough::report
