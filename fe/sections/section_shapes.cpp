#include "fe/sections/section_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fe/sections/thin_wall.hpp"

namespace bough::fe::section_shapes {
namespace {

using Eigen::Vector2d;
constexpr double kPi = std::numbers::pi;

/// Axis-parallel rectangle of the manuals' figures: x to the right, y up.
struct Rectangle {
  double x0, x1, y0, y1;
};

/// Built from rectangles that do not overlap (exact A and I) and walls on midlines (shear and torsion).
struct Outline {
  std::vector<Rectangle> rectangles;
  std::vector<Wall> walls;  ///< figure axes (x, y) until calc_from_outline turns them

  void add_wall(double xa, double ya, double xb, double yb, double t) { walls.push_back({{xa, ya}, {xb, yb}, t}); }
};

/// Saint-Venant torsion of a solid rectangle (Roark, Formulas for Stress and Strain, table of torsion, case 4).
double calc_rectangle_torsion(double p, double q) {
  const double a = std::max(p, q) / 2, b = std::min(p, q) / 2;
  return a * b * b * b * (16.0 / 3 - 3.36 * b / a * (1 - std::pow(b / a, 4) / 12));
}

/// Corners of the convex hull of rectangles, counterclockwise from the one farthest up and to the right (Andrew's
/// monotone chain).
std::vector<Vector2d> list_hull(const std::vector<Rectangle>& rectangles) {
  std::vector<Vector2d> all;
  for (const Rectangle& r : rectangles)
    for (const double x : {r.x0, r.x1})
      for (const double y : {r.y0, r.y1}) all.emplace_back(x, y);
  std::sort(all.begin(), all.end(),
            [](const Vector2d& a, const Vector2d& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  double size = 0;
  for (const auto& p : all) size = std::max(size, p.cwiseAbs().maxCoeff());
  const auto chain = [&](auto begin, auto end) {
    std::vector<Vector2d> hull;
    for (auto it = begin; it != end; ++it) {
      const auto turns_left = [&] {
        const Vector2d u = hull.back() - hull[hull.size() - 2], v = *it - hull.back();
        return u.x() * v.y() - u.y() * v.x() > 1e-12 * size * size;
      };
      while (hull.size() > 1 && !turns_left()) hull.pop_back();
      if (hull.empty() || (*it - hull.back()).norm() > 1e-9 * size) hull.push_back(*it);
    }
    return hull;
  };
  std::vector<Vector2d> hull = chain(all.begin(), all.end()), upper = chain(all.rbegin(), all.rend());
  hull.pop_back();
  upper.pop_back();
  hull.insert(hull.end(), upper.begin(), upper.end());
  const auto farthest = std::max_element(
      hull.begin(), hull.end(), [](const Vector2d& a, const Vector2d& b) { return a.x() + a.y() < b.x() + b.y(); });
  std::rotate(hull.begin(), farthest, hull.end());
  return hull;
}

/// Figure axes (x to the right, y up) to element axes.
Vector2d turn(double x, double y) { return {y, -x}; }

std::vector<Vector2d> list_round(double radius) { return {{radius, 0}, {0, radius}, {-radius, 0}, {0, -radius}}; }

SectionFace make_face(const Rectangle& r, double cx = 0, double cy = 0) {
  const double x0 = r.x0 - cx, x1 = r.x1 - cx, y0 = r.y0 - cy, y1 = r.y1 - cy;
  return {turn(x0, y0), turn(x1, y0), turn(x1, y1), turn(x0, y1)};
}

LibrarySection calc_from_outline(const Outline& outline) {
  LibrarySection s;
  double sx = 0, sy = 0;
  for (const Rectangle& r : outline.rectangles) {
    const double area = (r.x1 - r.x0) * (r.y1 - r.y0);
    s.A += area;
    sx += area * (r.x0 + r.x1) / 2;
    sy += area * (r.y0 + r.y1) / 2;
  }
  const double cx = sx / s.A, cy = sy / s.A;
  for (const Rectangle& r : outline.rectangles) {
    const double w = r.x1 - r.x0, h = r.y1 - r.y0, area = w * h;
    const double x = (r.x0 + r.x1) / 2 - cx, y = (r.y0 + r.y1) / 2 - cy;
    s.I1 += area * (h * h / 12 + y * y);
    s.I2 += area * (w * w / 12 + x * x);
    s.I12 -= area * x * y;  // z points to the left in the figures
  }
  if (std::abs(s.I12) < 1e-14 * (s.I1 + s.I2)) s.I12 = 0;
  for (const Rectangle& r : outline.rectangles) s.faces.push_back(make_face(r, cx, cy));
  for (const Vector2d& p : list_hull(outline.rectangles)) s.points.push_back(turn(p.x() - cx, p.y() - cy));
  std::vector<Wall> walls;
  for (const Wall& w : outline.walls) walls.push_back({{w.a[1], -w.a[0]}, {w.b[1], -w.b[0]}, w.t});
  const ThinWallResult thin = calc_thin_wall(walls);
  s.J = thin.J;
  s.k1 = std::min(1.0, thin.shear_area_1 / s.A);
  s.k2 = std::min(1.0, thin.shear_area_2 / s.A);
  s.n = Vector2d(cy, -cx) - thin.shear_center;
  const double tiny = 1e-12 * std::sqrt(s.A);
  for (double& offset : s.n)
    if (std::abs(offset) < tiny) offset = 0;
  return s;
}

}  // namespace

std::vector<SectionFace> make_round_faces(double outer, double inner) {
  const auto get_corner = [](double radius, int k) -> Vector2d {
    return {radius * std::cos(2 * kPi * k / kRoundSides), radius * std::sin(2 * kPi * k / kRoundSides)};
  };
  std::vector<SectionFace> faces(inner > 0 ? kRoundSides : 1);
  for (int k = 0; k < kRoundSides; ++k) {
    if (inner > 0)
      faces[static_cast<std::size_t>(k)] = {get_corner(outer, k), get_corner(outer, k + 1), get_corner(inner, k + 1),
                                            get_corner(inner, k)};
    else
      faces.front().push_back(get_corner(outer, k));
  }
  return faces;
}

LibrarySection calc_rod(const Dims& d) {
  LibrarySection s;
  s.A = kPi * d[0] * d[0];
  s.I1 = s.I2 = kPi * std::pow(d[0], 4) / 4;
  s.J = 2 * s.I1;
  s.k1 = s.k2 = 0.9;
  s.points = list_round(d[0]);
  s.faces = make_round_faces(d[0], 0);
  return s;
}

LibrarySection calc_annulus(double outer, double inner) {
  LibrarySection s;
  s.A = kPi * (outer * outer - inner * inner);
  s.I1 = s.I2 = kPi / 4 * (std::pow(outer, 4) - std::pow(inner, 4));
  s.J = 2 * s.I1;
  s.k1 = s.k2 = inner > 0 ? 0.5 : 0.9;
  s.points = list_round(outer);
  s.faces = make_round_faces(outer, inner);
  return s;
}

LibrarySection calc_bar(const Dims& d) {
  LibrarySection s;
  s.A = d[0] * d[1];
  s.I1 = d[0] * std::pow(d[1], 3) / 12;
  s.I2 = d[1] * std::pow(d[0], 3) / 12;
  s.J = calc_rectangle_torsion(d[0], d[1]);
  s.k1 = s.k2 = 5.0 / 6;
  const double x = d[0] / 2, y = d[1] / 2;
  s.points = {turn(x, y), turn(-x, y), turn(-x, -y), turn(x, -y)};
  s.faces = {s.points};
  return s;
}

LibrarySection calc_hexa(const Dims& d) {
  LibrarySection s;
  const double w = d[1] - 2 * d[0], e = d[0], h = d[2];
  s.A = h * (w + e);
  s.I1 = w * std::pow(h, 3) / 12 + e * std::pow(h, 3) / 24;
  const double x = w / 2 + e / 3;
  s.I2 = h * std::pow(w, 3) / 12 + 2 * (h * std::pow(e, 3) / 36 + h * e / 2 * x * x);
  s.J = std::pow(s.A, 4) / (40 * (s.I1 + s.I2));
  s.k1 = s.k2 = 5.0 / 6;
  const double a = w / 2, b = d[1] / 2, y = h / 2;
  s.points = {turn(a, y), turn(-a, y), turn(-b, 0), turn(-a, -y), turn(a, -y), turn(b, 0)};
  s.faces = {s.points};
  return s;
}

LibrarySection calc_i(double h, double wb, double wt, double tw, double tb, double tt) {
  Outline o;
  o.rectangles = {{-wb / 2, wb / 2, 0, tb}, {-tw / 2, tw / 2, tb, h - tt}, {-wt / 2, wt / 2, h - tt, h}};
  const double yb = tb / 2, yt = h - tt / 2;
  o.add_wall(-wb / 2, yb, 0, yb, tb);
  o.add_wall(0, yb, wb / 2, yb, tb);
  o.add_wall(0, yb, 0, yt, tw);
  o.add_wall(-wt / 2, yt, 0, yt, tt);
  o.add_wall(0, yt, wt / 2, yt, tt);
  return calc_from_outline(o);
}

LibrarySection calc_channel(double w, double h, double tw, double tf) {
  Outline o;
  o.rectangles = {{0, w, 0, tf}, {0, tw, tf, h - tf}, {0, w, h - tf, h}};
  const double x = tw / 2;
  o.add_wall(x, tf / 2, w, tf / 2, tf);
  o.add_wall(x, tf / 2, x, h - tf / 2, tw);
  o.add_wall(x, h - tf / 2, w, h - tf / 2, tf);
  return calc_from_outline(o);
}

LibrarySection calc_chan2(const Dims& d) {
  const double tf = d[0], tw = d[1], h = d[2], w = d[3], x = w / 2 - tf / 2;
  Outline o;
  o.rectangles = {{-w / 2, w / 2, 0, tw}, {-w / 2, -w / 2 + tf, tw, h}, {w / 2 - tf, w / 2, tw, h}};
  o.add_wall(-x, tw / 2, x, tw / 2, tw);
  o.add_wall(-x, tw / 2, -x, h, tf);
  o.add_wall(x, tw / 2, x, h, tf);
  return calc_from_outline(o);
}

LibrarySection calc_tee(double w, double h, double tf, double tw, double sign) {
  Outline o;
  const double y = h - tf;
  o.rectangles = {{-w / 2, w / 2, y, h}, {-tw / 2, tw / 2, 0, y}};
  for (Rectangle& r : o.rectangles)
    if (sign < 0) r = {r.x0, r.x1, -r.y1, -r.y0};
  const double mid = sign * (h - tf / 2);
  o.add_wall(-w / 2, mid, 0, mid, tf);
  o.add_wall(0, mid, w / 2, mid, tf);
  o.add_wall(0, mid, 0, 0, tw);
  return calc_from_outline(o);
}

LibrarySection calc_t1(const Dims& d) {
  Outline o;
  o.rectangles = {{0, d[2], -d[0] / 2, d[0] / 2}, {-d[1], 0, -d[3] / 2, d[3] / 2}};
  const double x = d[2] / 2;
  o.add_wall(x, -d[0] / 2, x, 0, d[2]);
  o.add_wall(x, 0, x, d[0] / 2, d[2]);
  o.add_wall(-d[1], 0, x, 0, d[3]);
  return calc_from_outline(o);
}

LibrarySection calc_cross(const Dims& d) {
  Outline o;
  const double w = d[0] + d[1];
  o.rectangles = {{-d[1] / 2, d[1] / 2, -d[2] / 2, d[2] / 2},
                  {-w / 2, -d[1] / 2, -d[3] / 2, d[3] / 2},
                  {d[1] / 2, w / 2, -d[3] / 2, d[3] / 2}};
  o.add_wall(0, -d[2] / 2, 0, 0, d[1]);
  o.add_wall(0, 0, 0, d[2] / 2, d[1]);
  o.add_wall(-w / 2, 0, 0, 0, d[3]);
  o.add_wall(0, 0, w / 2, 0, d[3]);
  return calc_from_outline(o);
}

LibrarySection calc_h(const Dims& d) {
  Outline o;
  const double t = d[1] / 2, inner = d[0] / 2, x = inner + t / 2;
  o.rectangles = {{-inner, inner, -d[3] / 2, d[3] / 2},
                  {-inner - t, -inner, -d[2] / 2, d[2] / 2},
                  {inner, inner + t, -d[2] / 2, d[2] / 2}};
  o.add_wall(-x, 0, x, 0, d[3]);
  for (double side : {-x, x}) {
    o.add_wall(side, -d[2] / 2, side, 0, t);
    o.add_wall(side, 0, side, d[2] / 2, t);
  }
  return calc_from_outline(o);
}

LibrarySection calc_z(const Dims& d) {
  Outline o;
  const double tw = d[1], h = d[3], tf = (d[3] - d[2]) / 2;
  o.rectangles = {{-tw / 2, tw / 2, 0, h}, {-tw / 2 - d[0], -tw / 2, h - tf, h}, {tw / 2, tw / 2 + d[0], 0, tf}};
  o.add_wall(0, tf / 2, 0, h - tf / 2, tw);
  o.add_wall(-tw / 2 - d[0], h - tf / 2, 0, h - tf / 2, tf);
  o.add_wall(0, tf / 2, tw / 2 + d[0], tf / 2, tf);
  return calc_from_outline(o);
}

LibrarySection calc_l(const Dims& d) {
  Outline o;
  o.rectangles = {{0, d[0], 0, d[2]}, {0, d[3], d[2], d[1]}};
  o.add_wall(d[3] / 2, d[2] / 2, d[0], d[2] / 2, d[2]);
  o.add_wall(d[3] / 2, d[2] / 2, d[3] / 2, d[1], d[3]);
  return calc_from_outline(o);
}

LibrarySection calc_box(double w, double h, double top, double bottom, double left, double right) {
  Outline o;
  o.rectangles = {{0, w, 0, bottom}, {0, w, h - top, h}, {0, left, bottom, h - top}, {w - right, w, bottom, h - top}};
  const double x0 = left / 2, x1 = w - right / 2, y0 = bottom / 2, y1 = h - top / 2;
  o.add_wall(x0, y0, x1, y0, bottom);
  o.add_wall(x1, y0, x1, y1, right);
  o.add_wall(x1, y1, x0, y1, top);
  o.add_wall(x0, y1, x0, y0, left);
  LibrarySection s = calc_from_outline(o);
  // Shear factors as MSC Nastran prints them: the clear walls along the shear over the area.
  s.k1 = (left + right) * (h - top - bottom) / s.A;
  s.k2 = (top + bottom) * (w - left - right) / s.A;
  return s;
}

LibrarySection calc_dbox(const Dims& d) {
  const double w = d[0], h = d[1], center = d[2], left = d[3], middle = d[4], right = d[5];
  const double top1 = d[6], bottom1 = d[7], top2 = d[8], bottom2 = d[9];
  Outline o;
  o.rectangles = {{0, left, 0, h},
                  {center - middle / 2, center + middle / 2, 0, h},
                  {w - right, w, 0, h},
                  {left, center - middle / 2, 0, bottom1},
                  {left, center - middle / 2, h - top1, h},
                  {center + middle / 2, w - right, 0, bottom2},
                  {center + middle / 2, w - right, h - top2, h}};
  // One mean midline below and above, so that both cells share their corners at the middle wall.
  const double x0 = left / 2, x2 = w - right / 2, y0 = (bottom1 + bottom2) / 4, y1 = h - (top1 + top2) / 4;
  o.add_wall(x0, y0, center, y0, bottom1);
  o.add_wall(center, y0, x2, y0, bottom2);
  o.add_wall(x2, y0, x2, y1, right);
  o.add_wall(x2, y1, center, y1, top2);
  o.add_wall(center, y1, x0, y1, top1);
  o.add_wall(x0, y1, x0, y0, left);
  o.add_wall(center, y0, center, y1, middle);
  return calc_from_outline(o);
}

LibrarySection calc_hat(const Dims& d) {
  const double h = d[0], t = d[1], w = d[2], foot = d[3], x = w / 2 - t / 2;
  Outline o;
  o.rectangles = {{-w / 2, w / 2, h - t, h},
                  {-w / 2, -w / 2 + t, 0, h - t},
                  {w / 2 - t, w / 2, 0, h - t},
                  {-w / 2 - foot, -w / 2, 0, t},
                  {w / 2, w / 2 + foot, 0, t}};
  o.add_wall(-x, h - t / 2, x, h - t / 2, t);
  for (double side : {-1.0, 1.0}) {
    o.add_wall(side * x, t / 2, side * x, h - t / 2, t);
    o.add_wall(side * (w / 2 + foot), t / 2, side * x, t / 2, t);
  }
  return calc_from_outline(o);
}

LibrarySection calc_hat1(const Dims& d) {
  const double w = d[0], h = d[1], top = d[2], t = d[3], plate = d[4], x = top / 2 - t / 2;
  Outline o;
  o.rectangles = {{-w / 2, w / 2, 0, plate},
                  {-top / 2, top / 2, h - t, h},
                  {-top / 2, -top / 2 + t, plate, h - t},
                  {top / 2 - t, top / 2, plate, h - t},
                  {-w / 2, -top / 2, plate, plate + t},
                  {top / 2, w / 2, plate, plate + t}};
  const double y0 = plate / 2, y1 = h - t / 2;
  o.add_wall(-x, y0, x, y0, plate);
  o.add_wall(-x, y1, x, y1, t);
  for (double side : {-1.0, 1.0}) {
    o.add_wall(side * x, y0, side * x, y1, t);
    o.add_wall(side * w / 2, y0, side * x, y0, plate + t);
  }
  return calc_from_outline(o);
}

}  // namespace bough::fe::section_shapes
