#include "fe/model/rigid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/rotation.hpp"
#include "fe/model/named_grid.hpp"

namespace bough::fe {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using RowVector6d = Eigen::Matrix<double, 1, 6>;

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

/// Components of one grid of a rigid body.
struct BodyTerm {
  const Node* node = nullptr;
  unsigned c = 0;
};

/// Motion of a rigid body about `reference` by its six independent components.
struct BodyFrame {
  Vector3d reference;
  std::vector<BodyTerm> independent;
  std::vector<std::pair<const Node*, int>> components;  ///< six: grid, component 0..5
  Matrix6d inverse;                                     ///< [v; θ] = inverse u_n, u_n in the axes of the grids
};

std::array<DofSum, 3> make_motion(const BodyFrame& frame, int first_row) {
  std::array<DofSum, 3> motion;
  for (int a = 0; a < 3; ++a)
    for (int j = 0; j < 6; ++j) {
      const auto [node, c] = frame.components[static_cast<std::size_t>(j)];
      for (int b = 0; b < 3; ++b)
        if (const double v = frame.inverse(first_row + a, j) * node->R_basic_cd(b, c % 3); v != 0)
          motion[static_cast<std::size_t>(a)][node->first_gdof + 3 * (c / 3) + b] += v;
    }
  return motion;
}

/// The link of one dependent grid, whose equations `equations[first...]` have as independent dofs those of the frame.
void add_body_link(const BodyFrame& frame, const BodyTerm& dependent, int first,
                   const std::vector<ConstraintEquation>& equations, std::vector<Link>& links) {
  const auto count_joined = [&](const Node* node) {
    unsigned c = node == dependent.node ? dependent.c : 0;
    for (const auto& term : frame.independent)
      if (term.node == node) c |= term.c;
    return c;
  };
  const auto make_component = [&](const Node* node, int c) {
    const bool is_rotation = c > 2;
    return LinkBuilder::Component{node, node->x - frame.reference, node->R_basic_cd.col(c % 3), is_rotation,
                                  (count_joined(node) >> (is_rotation ? 3 : 0) & 7u) == 7u};
  };
  LinkBuilder builder(make_motion(frame, 0), make_motion(frame, 3));
  for (auto e = static_cast<std::size_t>(first); e < equations.size(); ++e) {
    builder.start_equation();
    builder.add_component(make_component(dependent.node, equations[e].dependent - dependent.node->first_gdof), 1);
    for (const auto& [ldof, c] : equations[e].terms)
      for (const auto& [node, component] : frame.components)
        if (node->first_gdof + component == ldof) builder.add_component(make_component(node, component), -c);
  }
  links.push_back(builder.finish(first));
}

}  // namespace

const Node* find_rigid_grid(int id, const std::string& card, const NodeTable& nodes, const SourceLocation& at,
                            Diagnostics& diagnostics) {
  const int index = find_named_six(nodes, id, card, at, diagnostics);
  return index < 0 ? nullptr : &nodes.node(index);
}

Matrix6d calc_rigid_map(const Node& node, const Vector3d& reference) {
  Matrix6d map = Matrix6d::Zero();
  const Matrix3d Rt = node.R_basic_cd.transpose();
  map.topLeftCorner<3, 3>() = Rt;
  map.topRightCorner<3, 3>() = -Rt * skew(node.x - reference);
  map.bottomRightCorner<3, 3>() = Rt;
  return map;
}

void add_rbe2(const records::Rbe2& record, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations, std::vector<Link>& links) {
  const std::string card = "RBE2 " + std::to_string(record.id);
  const Node* gn = find_rigid_grid(record.gn, card, nodes, at, diagnostics);
  for (int id : record.gm) {
    const Node* gm = find_rigid_grid(id, card, nodes, at, diagnostics);
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
    const auto first = static_cast<int>(equations.size());
    std::array<int, 6> ldofs;
    for (int j = 0; j < 6; ++j) ldofs[j] = gn->first_gdof + j;
    for (int c = 0; c < 6; ++c) {
      if (!(record.cm >> c & 1u)) continue;
      RowVector6d scale;
      scale << 1, 1, 1, RowVector6d::Constant(c < 3 ? arm : 1).head<3>();
      add_equation(gm->first_gdof + c, map.row(c), ldofs, scale, card, at, equations);
    }
    if (arm == 0 && record.cm == 63u) continue;
    BodyFrame frame{gn->x, {{gn, 63u}}, {}, rotation};
    for (int c = 0; c < 6; ++c) frame.components.emplace_back(gn, c);
    add_body_link(frame, {gm, record.cm}, first, equations, links);
  }
}

namespace {

/// u_m = D P⁻¹ u_n, P and D the rows of the rigid map of the independent and dependent components. False when P is not
/// 6 x 6 and regular; `num` is the number of its rows. Rotations count with the size of the independent grids as arm.
bool add_body(const std::vector<BodyTerm>& independent, const std::vector<BodyTerm>& dependent, const std::string& card,
              const SourceLocation& at, int& num, std::vector<ConstraintEquation>& equations,
              std::vector<Link>& links) {
  const Vector3d reference = independent.front().node->x;
  Matrix6d P = Matrix6d::Zero();
  std::array<int, 6> ldofs{};
  double arm = 0;
  num = 0;
  BodyFrame frame{reference, independent, {}, Matrix6d::Zero()};
  for (const auto& term : independent) {
    const Matrix6d map = calc_rigid_map(*term.node, reference);
    arm = std::max(arm, (term.node->x - reference).norm());
    for (int c = 0; c < 6; ++c)
      if (term.c >> c & 1u) {
        if (num < 6) {
          frame.components.emplace_back(term.node, c);
          P.row(num) = map.row(c);
          ldofs[num] = term.node->first_gdof + c;
        }
        ++num;
      }
  }
  if (num != 6) return false;
  Matrix6d scaled = P;
  scaled.rightCols<3>() /= arm > 0 ? arm : 1;
  Eigen::FullPivLU<Matrix6d> lu(scaled);
  lu.setThreshold(1e-10);
  if (lu.rank() < 6) return false;
  const Matrix6d inverse = P.inverse();
  frame.inverse = inverse;
  for (const auto& term : dependent) {
    const auto first = static_cast<int>(equations.size());
    const Matrix6d map = calc_rigid_map(*term.node, reference);
    for (int c = 0; c < 6; ++c) {
      if (!(term.c >> c & 1u)) continue;
      const RowVector6d row = map.row(c) * inverse;
      // Each entry's own scale: the sum of magnitudes that made it.
      const RowVector6d scale = map.row(c).cwiseAbs() * inverse.cwiseAbs();
      add_equation(term.node->first_gdof + c, row, ldofs, scale, card, at, equations);
    }
    if (static_cast<int>(equations.size()) > first) add_body_link(frame, term, first, equations, links);
  }
  return true;
}

}  // namespace

namespace {

std::string list_components(unsigned mask) {
  std::string digits;
  for (unsigned c = 0; c < 6; ++c)
    if (mask >> c & 1u) digits += static_cast<char>('1' + c);
  return digits;
}

}  // namespace

void add_rbar(const records::Rbar& record, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations, std::vector<Link>& links) {
  const std::string card = "RBAR " + std::to_string(record.id);
  const Node* ga = find_rigid_grid(record.ga, card, nodes, at, diagnostics);
  const Node* gb = find_rigid_grid(record.gb, card, nodes, at, diagnostics);
  if (!ga || !gb) return;
  unsigned cna = record.cna, cnb = record.cnb, cma = record.cma, cmb = record.cmb;
  if (cna == 0 && cnb == 0) cna = 63u;
  if (std::popcount(cna) + std::popcount(cnb) < 6 && (cna == 0 || cnb == 0)) {
    // Part of one grid: all six of that grid hold the body, unless the card makes some of them dependent. Without CMA
    // and CMB the same components of the other grid depend.
    unsigned& held = cna != 0 ? cna : cnb;
    unsigned& tied = cna != 0 ? cmb : cma;
    const unsigned named = held;
    if (cma == 0 && cmb == 0) tied = named;
    held = 63u & ~(cna != 0 ? cma : cmb);
    if (std::popcount(cna) + std::popcount(cnb) == 6)
      diagnostics.warning("fe.rbar-completed", at,
                          card + " has " + std::to_string(std::popcount(named)) +
                              " independent components, expected 6; all six of grid " +
                              std::to_string(cna != 0 ? record.ga : record.gb) + " hold it, and components " +
                              list_components(tied) + " of grid " + std::to_string(cna != 0 ? record.gb : record.ga) +
                              " depend on them",
                          "write CNA = 123456 with CMB");
  }
  if (cma == 0 && cmb == 0) {
    cma = 63u & ~cna;
    cmb = 63u & ~cnb;
  }
  int num = 0;
  if ((cna & cma) == 0 && (cnb & cmb) == 0 &&
      add_body({{ga, cna}, {gb, cnb}}, {{ga, cma}, {gb, cmb}}, card, at, num, equations, links))
    return;
  num = std::popcount(record.cna) + std::popcount(record.cnb);
  diagnostics.error("fe.rigid-independent", at,
                    card + " has " + std::to_string(num) + " independent components" +
                        (num == 6 ? " that do not fix its rigid-body motion or are dependent too" : ", expected 6"),
                    "choose CNA and CNB so that together they hold a rigid body");
}

void add_rbe1(const records::Rbe1& record, const NodeTable& nodes, const SourceLocation& at, Diagnostics& diagnostics,
              std::vector<ConstraintEquation>& equations, std::vector<Link>& links) {
  const std::string card = "RBE1 " + std::to_string(record.id);
  bool is_valid = !record.independent.empty();
  const auto find = [&](const std::vector<records::GridComponents>& terms) {
    std::vector<BodyTerm> found;
    for (const auto& term : terms) {
      found.push_back({find_rigid_grid(term.g, card, nodes, at, diagnostics), term.c});
      is_valid = is_valid && found.back().node;
    }
    return found;
  };
  const auto independent = find(record.independent), dependent = find(record.dependent);
  if (!is_valid) return;
  for (const auto& m : dependent)
    for (const auto& n : independent)
      if (m.node == n.node && (m.c & n.c) != 0) {
        diagnostics.error(
            "fe.rigid-independent", at,
            card + " names components of grid " + std::to_string(m.node->id) + " as independent and as dependent",
            "remove them from UM");
        return;
      }
  int num = 0;
  if (!add_body(independent, dependent, card, at, num, equations, links))
    diagnostics.error("fe.rigid-independent", at,
                      card + " has " + std::to_string(num) + " independent components" +
                          (num == 6 ? " that do not fix its rigid-body motion" : ", expected 6"),
                      "choose GN and CN so that together they hold a rigid body");
}

}  // namespace bough::fe
