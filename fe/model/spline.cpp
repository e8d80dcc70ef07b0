#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "fe/elements/beam.hpp"
#include "fe/model/rigid.hpp"

namespace bough::fe {
namespace {

/// Stiffness of the tube between two points of the spline (12 x 12, basic). Only ratios count: E = 1, ν = 0.3, thin
/// wall of diameter D, so that I/A = D²/8 and J = 2 I.
MatrixXd calc_tube_stiffness(const Node& a, const Node& b, double diameter) {
  auto property = std::make_shared<BeamProperty>();
  property->material.E = 1;
  property->material.G = 1 / 2.6;
  BeamSection section;
  section.A = 1;
  section.I1 = section.I2 = diameter * diameter / 8;
  section.J = 2 * section.I1;
  property->stations = {section};
  BeamGeometry geometry;
  const Vector3d along = b.x - a.x;
  geometry.length = along.norm();
  const Vector3d ex = along / geometry.length, ey = ex.unitOrthogonal();
  geometry.R_basic_element << ex, ey, ex.cross(ey);
  const Beam beam(0, "RSPLINE", {0, 1}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, std::move(property), geometry);
  MatrixXd K = MatrixXd::Zero(12, 12);
  beam.add_stiffness(1, K);
  return K;
}

MatrixXd calc_turn(const Node& node) {
  MatrixXd R = MatrixXd::Zero(6, 6);
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = node.R_basic_cd;
  return R;
}

/// Points first..last, of which only the two ends are independent: the others follow an unloaded chain of tubes.
void add_segment(const records::Rspline& record, const std::vector<const Node*>& nodes, std::size_t first,
                 std::size_t last, double diameter, const std::string& card, const SourceLocation& at,
                 std::vector<ConstraintEquation>& equations) {
  const auto count = static_cast<Eigen::Index>(last - first + 1), inner = 6 * (count - 2);
  if (inner == 0) return;
  MatrixXd K = MatrixXd::Zero(6 * count, 6 * count);
  for (Eigen::Index k = 0; k + 1 < count; ++k) {
    const auto i = first + static_cast<std::size_t>(k);
    K.block<12, 12>(6 * k, 6 * k) += calc_tube_stiffness(*nodes[i], *nodes[i + 1], diameter);
  }
  MatrixXd K_ends(inner, 12);
  K_ends << K.block(6, 0, inner, 6), K.block(6, 6 * (count - 1), inner, 6);
  const MatrixXd follow = -K.block(6, 6, inner, inner).ldlt().solve(K_ends);
  MatrixXd turn = MatrixXd::Zero(12, 12);
  turn.topLeftCorner<6, 6>() = calc_turn(*nodes[first]);
  turn.bottomRightCorner<6, 6>() = calc_turn(*nodes[last]);
  const double length = (nodes[last]->x - nodes[first]->x).norm();
  for (auto i = first + 1; i < last; ++i) {
    const MatrixXd rows =
        calc_turn(*nodes[i]).transpose() * follow.middleRows(6 * static_cast<Eigen::Index>(i - first - 1), 6) * turn;
    for (int c = 0; c < 6; ++c) {
      if (!(record.points[i].c >> c & 1u)) continue;
      ConstraintEquation equation;
      equation.dependent = nodes[i]->first_gdof + c;
      equation.card = card;
      equation.at = at;
      for (int j = 0; j < 12; ++j) {
        // Against its own size: a rotation by a translation is 1/length, a translation by a rotation length.
        const bool is_turn = c >= 3, by_turn = j % 6 >= 3;
        const double size = is_turn == by_turn ? 1 : is_turn ? 1 / length : length;
        const Node& end = j < 6 ? *nodes[first] : *nodes[last];
        if (std::abs(rows(c, j)) > 1e-12 * size) equation.terms.emplace_back(end.first_gdof + j % 6, rows(c, j));
      }
      equations.push_back(std::move(equation));
    }
  }
}

}  // namespace

void add_rspline(const records::Rspline& record, const NodeTable& nodes, const SourceLocation& at,
                 Diagnostics& diagnostics, std::vector<ConstraintEquation>& equations) {
  const std::string card = "RSPLINE " + std::to_string(record.id);
  std::vector<const Node*> found;
  for (const auto& point : record.points) found.push_back(find_rigid_grid(point.g, card, nodes, at, diagnostics));
  double length = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) return;
    if (i == 0) continue;
    const double step = (found[i]->x - found[i - 1]->x).norm();
    if (!(step > 0)) {
      diagnostics.error("fe.zero-length", at,
                        card + " has its grids " + std::to_string(found[i - 1]->id) + " and " +
                            std::to_string(found[i]->id) + " at one place",
                        "its grids must follow each other along a line");
      return;
    }
    length += step;
  }
  std::size_t first = 0;
  for (std::size_t i = 1; i < found.size(); ++i) {
    if (record.points[i].c != 0) continue;
    add_segment(record, found, first, i, record.ratio * length, card, at, equations);
    first = i;
  }
}

}  // namespace bough::fe
