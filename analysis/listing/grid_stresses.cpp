#include "analysis/listing/grid_stresses.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "base/diagnostic.hpp"
#include "fe/elements/stress_recovery.hpp"
#include "fe/elements/stress_state.hpp"
#include "formats/records/group_names.hpp"

namespace bough::analysis {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using records::StressField;

/// Element of the field with its corner stresses in element axes.
struct Member {
  const fe::Element* element = nullptr;
  std::vector<int> nodes;                ///< corners
  MatrixXd stress;                       ///< components x corners: of a shell x y xy at Z1, at Z2
  Matrix3d axes = Matrix3d::Identity();  ///< columns: element axes in basic
  Vector3d normal() const { return axes.col(2); }
};

/// x along side 1-2, z across the diagonals of a quadrilateral.
Matrix3d calc_shell_axes(const fe::Model& model, const std::vector<int>& nodes) {
  const auto x = [&](std::size_t i) -> const Vector3d& { return model.node(nodes[i]).x; };
  const Vector3d across = nodes.size() == 4 ? (x(2) - x(0)).cross(x(3) - x(1)) : (x(1) - x(0)).cross(x(2) - x(0));
  const Vector3d normal = across.normalized();
  const Vector3d side = x(1) - x(0);
  Matrix3d axes;
  axes.col(2) = normal;
  axes.col(0) = (side - normal * normal.dot(side)).normalized();
  axes.col(1) = normal.cross(axes.col(0));
  return axes;
}

std::vector<Member> collect_members(const fe::Model& model, const ElementIndex& elements, const StressField& field,
                                    const std::vector<records::ElementForces>& forces,
                                    const std::function<bool(int)>& is_member, std::set<std::string>& skipped) {
  std::vector<Member> members;
  for (const auto& of_card : forces) {
    const std::string card = records::get_card_of_group(of_card.card);
    for (std::size_t k = 0; k < of_card.id.size(); ++k) {
      if (!is_member(of_card.id[k])) continue;
      const fe::Element& element = *elements.at({card, of_card.id[k]});
      const auto* recovery = element.stress_recovery();
      if (!recovery || (element.as_solid() != nullptr) != field.is_volume) continue;
      const auto kind = recovery->stress_points().front().kind;
      if (!field.is_volume && kind != fe::StressKind::Plane && kind != fe::StressKind::Ply) continue;
      Member member;
      VectorXd own = VectorXd::Zero(element.stress_state()->num_internal_forces());
      own.head(of_card.force.cols()) = of_card.force.row(static_cast<Index>(k)).transpose();
      if (kind != fe::StressKind::Ply) member.stress = recovery->calc_corner_stresses(own);
      if (member.stress.size() == 0) {
        skipped.insert(card);
        continue;
      }
      member.element = &element;
      member.nodes = element.shape().nodes;
      if (!field.is_volume) member.axes = calc_shell_axes(model, member.nodes);
      members.push_back(std::move(member));
    }
  }
  std::sort(members.begin(), members.end(),
            [](const auto& a, const auto& b) { return a.element->id() < b.element->id(); });
  return members;
}

Matrix3d make_plane_tensor(const Eigen::Ref<const VectorXd>& s) {
  Matrix3d tensor;
  tensor << s[0], s[2], 0, s[2], s[1], 0, 0, 0, 0;
  return tensor;
}

Matrix3d make_solid_tensor(const Eigen::Ref<const VectorXd>& s) {
  Matrix3d tensor;
  tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
  return tensor;
}

/// Axes of the output at grids of one field.
class OutputAxes {
 public:
  OutputAxes(const fe::Model& model, const records::Deck& deck, const StressField& field)
      : model_(model), deck_(deck), field_(field) {
    if (field.system == StressField::System::Cord) origin_ = find_point(Vector3d::Zero());
  }

  /// Axes of the system at a point.
  Matrix3d calc_system(const Vector3d& x) const {
    if (field_.system != StressField::System::Cord) return Matrix3d::Identity();
    Diagnostics diagnostics;
    const Matrix3d axes = model_.calc_axes(field_.cid, x, deck_.locate(field_.at), diagnostics);
    diagnostics.throw_if_errors();
    return axes;
  }
  /// The direction of NORMAL at a grid.
  Vector3d calc_normal(const Vector3d& x) const {
    const Vector3d direction =
        field_.normal == "R" ? Vector3d(x - origin_) : Vector3d(calc_system(x).col(field_.normal[1] - '1'));
    return field_.is_reversed ? Vector3d(-direction) : direction;
  }
  /// Axes of the plane of a shell at one of its grids, z on the side of NORMAL.
  Matrix3d calc_plane(const Member& member, const Vector3d& x) const {
    Matrix3d axes;
    axes.col(2) = calc_normal(x).dot(member.normal()) < 0 ? Vector3d(-member.normal()) : member.normal();
    const Vector3d along = calc_system(x).col(field_.axis - 1);
    const Vector3d in_plane = along - axes.col(2) * axes.col(2).dot(along);
    if (!(in_plane.norm() > 1e-6))
      throw InputError("cli.surface-axis", deck_.locate(field_.at),
                       "SURFACE " + std::to_string(field_.id) + ": its AXIS is along the normal of element " +
                           std::to_string(member.element->id()),
                       "choose another AXIS (X1, X2 or X3) of the system");
    axes.col(0) = in_plane.normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
  }

 private:
  Vector3d find_point(const Vector3d& x) const {
    Diagnostics diagnostics;
    const Vector3d point = model_.calc_point(field_.cid, x, deck_.locate(field_.at), diagnostics);
    diagnostics.throw_if_errors();
    return point;
  }
  const fe::Model& model_;
  const records::Deck& deck_;
  const StressField& field_;
  Vector3d origin_ = Vector3d::Zero();
};

/// Corner stresses of a member in the output system of grid x: of a shell x y xy at Z1 and Z2 of the surface.
MatrixXd turn_stresses(const Member& member, const StressField& field, const OutputAxes& output, const Vector3d& x) {
  const bool of_element = field.system == StressField::System::Element;
  MatrixXd turned = member.stress;
  if (field.is_volume) {
    const Matrix3d axes = output.calc_system(x);
    for (Index c = 0; c < turned.cols() && !of_element; ++c) {
      const Matrix3d s = axes.transpose() * make_solid_tensor(member.stress.col(c)) * axes;
      turned.col(c) << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0);
    }
    return turned;
  }
  if (of_element) return turned;
  const Matrix3d plane = output.calc_plane(member, x);
  const bool is_upside_down = plane.col(2).dot(member.normal()) < 0;
  const Matrix3d R = member.axes.transpose() * plane;
  for (Index c = 0; c < turned.cols(); ++c)
    for (const Index side : {0, 1}) {
      const Index from = 3 * (is_upside_down ? 1 - side : side);
      const Matrix3d s = R.transpose() * make_plane_tensor(member.stress.col(c).segment<3>(from)) * R;
      turned.col(c).segment<3>(3 * side) << s(0, 0), s(1, 1), s(0, 1);
    }
  return turned;
}

/// CQUAD4: the axes of Nastran's element, which bisect its diagonals.
void turn_to_nastran(const fe::Model& model, Member& member) {
  if (member.nodes.size() != 4) return;
  const auto x = [&](std::size_t i) { return model.node(member.nodes[i]).x; };
  const double angle = calc_quad_angle({x(0), x(1), x(2), x(3)});
  for (Index c = 0; c < member.stress.cols(); ++c)
    for (const Index side : {0, 1})
      member.stress.col(c).segment<3>(3 * side) =
          turn_plane(Vector3d(member.stress.col(c).segment<3>(3 * side)), angle);
}

/// Least squares through values (components x points) at places (dims x points): the value at the origin.
VectorXd fit_linear(const MatrixXd& places, const MatrixXd& values) {
  MatrixXd A(places.cols(), places.rows() + 1);
  A.col(0).setOnes();
  A.rightCols(places.rows()) = places.transpose() / places.cwiseAbs().maxCoeff();
  return MatrixXd(A.completeOrthogonalDecomposition().solve(values.transpose())).row(0).transpose();
}

/// x y xy, angle, major, minor, largest shear, von Mises.
VectorXd derive_plane(const Vector3d& s) {
  const double mean = 0.5 * (s(0) + s(1)), radius = std::hypot(0.5 * (s(0) - s(1)), s(2));
  VectorXd row(8);
  row << s, 0.5 * std::atan2(2 * s(2), s(0) - s(1)) * 180 / M_PI, mean + radius, mean - radius, radius,
      fe::calc_plane_von_mises(s);
  return row;
}

/// The columns of ListedGridStresses of a VOLUME.
VectorXd derive_solid(const VectorXd& s) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(make_solid_tensor(s));
  VectorXd row(20);
  row.head<6>() = s;
  row[6] = -s.head<3>().sum() / 3;
  row[7] = fe::calc_solid_von_mises(s);
  for (Index i = 0; i < 3; ++i) {
    row[8 + i] = principal.eigenvalues()[2 - i];
    for (Index x = 0; x < 3; ++x) row[11 + 3 * x + i] = principal.eigenvectors()(x, 2 - i);
  }
  return row;
}

/// Connected elements of a grid: indices of members and corners.
using Connections = std::vector<std::pair<std::size_t, Index>>;

/// Returns true if an edge at node n belongs to more than two members.
bool is_branch(const std::vector<Member>& members, const Connections& connections, int n) {
  std::map<int, int> edges;
  for (const auto& [m, corner] : connections) {
    const auto& nodes = members[m].nodes;
    const std::size_t c = static_cast<std::size_t>(corner), size = nodes.size();
    for (const std::size_t other : {(c + 1) % size, (c + size - 1) % size})
      if (nodes[other] != n) ++edges[nodes[other]];
  }
  return std::any_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second > 2; });
}

/// Returns true if each element has its own row at the grid.
bool is_split(const std::vector<Member>& members, const Connections& connections, const StressField& field, int n) {
  if (field.is_volume) return false;
  if (field.has_break && is_branch(members, connections, n)) return true;
  if (field.tolerance >= 0) return false;
  const double limit = std::cos(-field.tolerance * M_PI / 180);
  for (const auto& a : connections)
    for (const auto& b : connections)
      if (std::abs(members[a.first].normal().dot(members[b.first].normal())) < limit) return true;
  return false;
}

}  // namespace

records::ListedGridStresses calc_grid_stresses(const fe::Model& model, const ElementIndex& elements,
                                               const records::Deck& deck, const StressField& field,
                                               const std::vector<records::ElementForces>& forces,
                                               const std::function<bool(int)>& is_member,
                                               std::set<std::string>& skipped) {
  records::ListedGridStresses listed;
  listed.id = field.id;
  listed.is_volume = field.is_volume;
  listed.cid = field.cid;
  listed.is_element_system = field.system == StressField::System::Element;
  listed.axis = field.axis;
  listed.normal = field.normal;
  listed.is_reversed = field.is_reversed;
  listed.has_direct = field.has_direct;
  listed.has_principal = field.has_principal;
  auto members = collect_members(model, elements, field, forces, is_member, skipped);
  if (listed.is_element_system && !field.is_volume)
    for (auto& member : members) turn_to_nastran(model, member);
  const OutputAxes output(model, deck, field);
  std::map<int, std::pair<int, Connections>> grids;  // id: node, connections
  for (std::size_t m = 0; m < members.size(); ++m)
    for (std::size_t c = 0; c < members[m].nodes.size(); ++c) {
      const int n = members[m].nodes[c];
      auto& grid = grids[model.node(n).id];
      grid.first = n;
      grid.second.emplace_back(m, static_cast<Index>(c));
    }
  std::vector<VectorXd> rows;
  const auto add = [&](int grid, int element, const VectorXd& s) {
    const auto add_row = [&](const char* fibre, const VectorXd& values) {
      listed.grid.push_back(grid);
      listed.element.push_back(element);
      listed.fibre.emplace_back(fibre);
      rows.push_back(values);
    };
    if (field.is_volume) return add_row("", derive_solid(s));
    const Vector3d z1 = s.head<3>(), z2 = s.tail<3>(), mid = 0.5 * (z1 + z2);
    for (const auto& [fibre, values] : {std::pair("Z1", z1), std::pair("Z2", z2), std::pair("MID", mid)})
      if (field.fibres.contains(fibre)) add_row(fibre, derive_plane(values));
  };
  for (const auto& [id, grid] : grids) {
    const auto& [n, connections] = grid;
    const Vector3d& x = model.node(n).x;
    const bool splits = is_split(members, connections, field, n);
    VectorXd sum;
    std::vector<Vector3d> places;
    std::vector<VectorXd> values;
    for (const auto& [m, corner] : connections) {
      const MatrixXd stress = turn_stresses(members[m], field, output, x);
      if (splits) add(id, members[m].element->id(), stress.col(corner));
      sum = sum.size() == 0 ? VectorXd(stress.col(corner)) : VectorXd(sum + stress.col(corner));
      for (Index c = 0; c < stress.cols(); ++c) {
        places.push_back(model.node(members[m].nodes[static_cast<std::size_t>(c)]).x - x);
        values.emplace_back(stress.col(c));
      }
    }
    if (splits) continue;
    VectorXd mean = sum / static_cast<double>(connections.size());
    if (field.is_geometric) {
      MatrixXd at(3, static_cast<Index>(places.size())), of(mean.size(), at.cols());
      for (Index k = 0; k < at.cols(); ++k) {
        at.col(k) = places[static_cast<std::size_t>(k)];
        of.col(k) = values[static_cast<std::size_t>(k)];
      }
      mean = fit_linear(at, of);
    }
    add(id, 0, mean);
  }
  listed.values.resize(static_cast<Index>(rows.size()), field.is_volume ? 20 : 8);
  for (std::size_t r = 0; r < rows.size(); ++r) listed.values.row(static_cast<Index>(r)) = rows[r].transpose();
  return listed;
}

}  // namespace bough::analysis
