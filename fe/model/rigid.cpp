#include "bough/fe/model/rigid.hpp"

#include <cmath>

#include "bough/base/rotation.hpp"

namespace bough::fe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using RowVector6d = Eigen::Matrix<double, 1, 6>;

/// The node of a rigid element, reported when it is missing or a scalar point.
const Node* find_grid(int id, const std::string& card, const NodeTable& nodes, const SourceLocation& at,
                      Diagnostics& diagnostics) {
  const int index = nodes.find_node(id);
  if (index >= 0 && nodes.node(index).num_dofs == 6) return &nodes.node(index);
  diagnostics.error("fe.missing-grid", at,
                    card + " names grid " + std::to_string(id) + ", which the deck does not define",
                    "add the GRID or correct the id");
  return nullptr;
}

/// u_dependent = row · u_n over the six given l-dofs; entries that are round-off of the row are left out.
void add_equation(int dependent, const RowVector6d& row, const std::array<int, 6>& ldofs, const RowVector6d& scale,
                  const std::string& card, const SourceLocation& at, std::vector<ConstraintEquation>& equations) {
  ConstraintEquation equation;
  equation.dependent = dependent;
  equation.card = card;
  equation.at = at;
  for (int j = 0; j < 6; ++j)
    if (std::abs(row[j]) > 1e-14 * scale[j]) equation.terms.emplace_back(ldofs[j], row[j]);
  equations.push_back(std::move(equation));
}

}  // namespace

Matrix6d calc_rigid_map(const Node& node, const Vector3d& reference) {
  Matrix6d map = Matrix6d::Zero();
  const Matrix3d Rt = node.R_basic_cd.transpose();
  map.topLeftCorner<3, 3>() = Rt;
  map.topRightCorner<3, 3>() = -Rt * skew(node.x - reference);
  map.bottomRightCorner<3, 3>() = Rt;
  return map;
}

void add_rbe2(const records::Rbe2& record, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations) {
  const std::string card = "RBE2 " + std::to_string(record.id);
  const Node* gn = find_grid(record.gn, card, nodes, at, diagnostics);
  for (int id : record.gm) {
    const Node* gm = find_grid(id, card, nodes, at, diagnostics);
    if (!gn || !gm) continue;
    if (gm == gn) {
      diagnostics.error("fe.rigid-independent", at,
                        card + " names grid " + std::to_string(id) + " as independent and as dependent",
                        "remove it from the dependent grids");
      continue;
    }
    // From GN's components: its rigid map about its own position is a rotation.
    Matrix6d rotation = Matrix6d::Zero();
    rotation.topLeftCorner<3, 3>() = rotation.bottomRightCorner<3, 3>() = gn->R_basic_cd;
    const Matrix6d map = calc_rigid_map(*gm, gn->x) * rotation;
    const double arm = (gm->x - gn->x).norm();
    std::array<int, 6> ldofs;
    for (int j = 0; j < 6; ++j) ldofs[j] = gn->first_gdof + j;
    for (int c = 0; c < 6; ++c) {
      if (!(record.cm >> c & 1u)) continue;
      RowVector6d scale;
      scale << 1, 1, 1, RowVector6d::Constant(c < 3 ? arm : 1).head<3>();
      add_equation(gm->first_gdof + c, map.row(c), ldofs, scale, card, at, equations);
    }
  }
}

void add_rbar(const records::Rbar& record, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations) {
  const std::string card = "RBAR " + std::to_string(record.id);
  const Node* ga = find_grid(record.ga, card, nodes, at, diagnostics);
  const Node* gb = find_grid(record.gb, card, nodes, at, diagnostics);
  if (!ga || !gb) return;
  const Matrix6d map[2] = {calc_rigid_map(*ga, ga->x), calc_rigid_map(*gb, ga->x)};
  const Node* grid[2] = {ga, gb};
  const unsigned independent[2] = {record.cna, record.cnb};
  unsigned dependent[2] = {record.cma, record.cmb};
  if (dependent[0] == 0 && dependent[1] == 0) {
    dependent[0] = 63u & ~independent[0];
    dependent[1] = 63u & ~independent[1];
  }
  Matrix6d P = Matrix6d::Zero();
  std::array<int, 6> ldofs{};
  int num = 0;
  for (int end = 0; end < 2; ++end)
    for (int c = 0; c < 6; ++c)
      if (independent[end] >> c & 1u) {
        if (num < 6) {
          P.row(num) = map[end].row(c);
          ldofs[num] = grid[end]->first_gdof + c;
        }
        ++num;
      }
  const double arm = (gb->x - ga->x).norm() > 0 ? (gb->x - ga->x).norm() : 1;
  Matrix6d scaled = P;
  scaled.rightCols<3>() /= arm;
  Eigen::FullPivLU<Matrix6d> lu(scaled);
  lu.setThreshold(1e-10);
  if (num != 6 || lu.rank() < 6 || (independent[0] & dependent[0]) || (independent[1] & dependent[1])) {
    diagnostics.error("fe.rigid-independent", at,
                      card + " has " + std::to_string(num) + " independent components" +
                          (num == 6 ? " that do not fix its rigid motion or are dependent too" : ", expected 6"),
                      "choose CNA and CNB so that together they hold a rigid body");
    return;
  }
  const Matrix6d inverse = P.inverse();
  for (int end = 0; end < 2; ++end)
    for (int c = 0; c < 6; ++c) {
      if (!(dependent[end] >> c & 1u)) continue;
      const RowVector6d row = map[end].row(c) * inverse;
      // Each entry's own scale: the sum of magnitudes that made it.
      const RowVector6d scale = map[end].row(c).cwiseAbs() * inverse.cwiseAbs();
      add_equation(grid[end]->first_gdof + c, row, ldofs, scale, card, at, equations);
    }
}

}  // namespace bough::fe
