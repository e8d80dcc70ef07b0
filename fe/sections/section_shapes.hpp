#pragma once
/// \file The shapes of the section library, each from its dimensions d[0], d[1], ... in the order of PBARL and PBEAML
/// (one figure each in the manuals) or from dimensions by name where several shapes share a formula. Any consistent set
/// of units; A and I exact, J and shear of thin walls where walls make the shape. The dimensions fit each other.
#include <vector>

#include "fe/sections/section_library.hpp"

namespace bough::fe::section_shapes {

using Dims = std::vector<double>;

/// Circle, or with inner > 0 the ring between two radii, as polygons with their corners on the circles.
std::vector<SectionFace> make_round_faces(double outer, double inner);

/// Solid circle of radius d0; shear factors 0.9.
LibrarySection calc_rod(const Dims& d);
/// Circular ring between two radii; shear factors 0.5, those of a thin wall, or 0.9 for inner = 0.
LibrarySection calc_annulus(double outer, double inner);
/// Solid rectangle of width d0 along z and height d1 along y; shear factors 5/6, J of Saint-Venant.
LibrarySection calc_bar(const Dims& d);
/// Hexagon: rectangle of width d2 - 2 d1 with a triangle of height d1 on each side; J by Saint-Venant's A⁴ / 40 Ip.
LibrarySection calc_hexa(const Dims& d);
/// Wide flange: height h, flanges wb x tb below and wt x tt above, web tw.
LibrarySection calc_i(double h, double wb, double wt, double tw, double tb, double tt);
/// Web at the left, flanges to the right.
LibrarySection calc_channel(double w, double h, double tw, double tf);
/// Web below, flanges upward.
LibrarySection calc_chan2(const Dims& d);
/// Flange above (sign 1) or below (-1) its web.
LibrarySection calc_tee(double w, double h, double tf, double tw, double sign);
/// Flange at the right (height d1, thickness d3), web of length d2 and thickness d4 to the left.
LibrarySection calc_t1(const Dims& d);
/// Cross: upright of width d1 and height d2, arms of total width d0 and thickness d3.
LibrarySection calc_cross(const Dims& d);
/// Two upright flanges of thickness d2/2 and a web of length d1 between them.
LibrarySection calc_h(const Dims& d);
/// Top flange to the left, bottom flange to the right, each d1 long beyond the web.
LibrarySection calc_z(const Dims& d);
/// Angle: leg of width d0 and thickness d2 to the right, upright leg of height d1 and thickness d3.
LibrarySection calc_l(const Dims& d);
/// Shear factors are the vendor's, the clear walls along the shear over the area.
LibrarySection calc_box(double w, double h, double top, double bottom, double left, double right);
/// Box of width d0 and height d1 with a web of thickness d4 at d2 from the left and walls of separate thicknesses.
LibrarySection calc_dbox(const Dims& d);
/// Hat of height d0, thickness d1 and top width d2, with feet of length d3 to both sides.
LibrarySection calc_hat(const Dims& d);
/// A hat (thickness d4, top width d3) on a plate (d1 x d5); the feet and the plate under them are one wall.
LibrarySection calc_hat1(const Dims& d);

}  // namespace bough::fe::section_shapes
