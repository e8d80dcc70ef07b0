#include "analysis/listing/element_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "formats/records/group_names.hpp"

namespace bough::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Nastran's element types.
const std::map<std::string, int>& list_types() {
  static const std::map<std::string, int> types{
      {"CROD", 1},    {"CBEAM", 2},   {"CTUBE", 3}, {"CONROD", 10}, {"CELAS1", 11}, {"CELAS2", 12}, {"CELAS3", 13},
      {"CELAS4", 14}, {"CQUAD4", 33}, {"CBAR", 34}, {"CTRIA3", 74}, {"CBUSH", 102}, {"CWELD", 117}, {"CFAST", 126}};
  return types;
}

/// Area of each of the four quadrature points of a quadrilateral, in the order of its corners x.
VectorXd calc_point_areas(const std::array<Eigen::Vector3d, 4>& x) {
  const Eigen::Vector3d normal = (x[2] - x[0]).cross(x[3] - x[1]).normalized();
  const double g = 1 / std::sqrt(3.0);
  VectorXd areas(4);
  for (int q = 0; q < 4; ++q) {
    const double r = q == 0 || q == 3 ? -g : g, s = q < 2 ? -g : g;
    const Eigen::Vector3d by_r = (1 - s) * (x[1] - x[0]) + (1 + s) * (x[2] - x[3]),
                          by_s = (1 - r) * (x[3] - x[0]) + (1 + r) * (x[2] - x[1]);
    areas[q] = normal.dot(by_r.cross(by_s)) / 16;
  }
  return areas;
}

/// Mean over the element of "Nx@1", "Nx@2", ..., as that of the stresses. areas: of the points; empty: alike.
double calc_mean(const records::ElementForces& forces, Index row, const std::string& component, const VectorXd& areas) {
  double sum = 0, whole = 0;
  Index point = 0;
  for (std::size_t c = 0; c < forces.components.size(); ++c)
    if (forces.components[c].substr(0, forces.components[c].find('@')) == component) {
      const double area = point < areas.size() ? areas[point] : 1;
      sum += area * forces.force(row, static_cast<Index>(c));
      whole += area;
      ++point;
    }
  return whole > 0 ? sum / whole : 0;
}

VectorXd make_shell_row(const records::ElementForces& forces, Index row, double angle, const VectorXd& areas = {}) {
  const auto mean = [&](const char* name) { return calc_mean(forces, row, name, areas); };
  const Eigen::Vector3d N = turn_plane({mean("Nx"), mean("Ny"), mean("Nxy")}, angle);
  const Eigen::Vector3d M = turn_plane({mean("Mx"), mean("My"), mean("Mxy")}, angle);
  const double Qx = mean("Qx"), Qy = mean("Qy"), c = std::cos(angle), s = std::sin(angle);
  VectorXd values(8);
  values << N, -M, c * Qx + s * Qy, -s * Qx + c * Qy;
  return values;
}

/// Row of "axial", "shear_y", "shear_z", "torque", "moment_y_a", "moment_z_a", "moment_y_b", "moment_z_b".
VectorXd make_bar_row(const Eigen::Ref<const Eigen::RowVectorXd>& f) {
  VectorXd values(8);
  values << f(5), -f(4), f(7), -f(6), f(1), f(2), f(0), f(3);
  return values;
}

/// Row of a weld in the columns of a bar; its core is a beam, or springs ("force_x" to "moment_z").
VectorXd make_weld_row(const Eigen::Ref<const Eigen::RowVectorXd>& f) {
  if (f.size() != 6) return make_bar_row(f);
  VectorXd values(8);
  values << f(5), -f(4), f(5), -f(4), f(1), f(2), f(0), f(3);
  return values;
}

/// Both ends: M1 M2 V1 V2 axial torque, and the torque of warping, which this element has not. `loads`: along the beam,
/// forces x y z and moment x, by which those at end B are less.
VectorXd make_beam_row(const Eigen::Ref<const Eigen::RowVectorXd>& f, const Eigen::Vector4d& loads) {
  VectorXd values(14);
  values << f(5), -f(4), f(1), f(2), f(0), f(3), 0,  //
      f(7), -f(6), f(1) - loads(1), f(2) - loads(2), f(0) - loads(0), f(3) - loads(3), 0;
  return values;
}

}  // namespace

Eigen::Vector3d turn_plane(const Eigen::Vector3d& s, double angle) {
  const double c = std::cos(angle), n = std::sin(angle);
  return {c * c * s(0) + n * n * s(1) + 2 * c * n * s(2), n * n * s(0) + c * c * s(1) - 2 * c * n * s(2),
          -c * n * s(0) + c * n * s(1) + (c * c - n * n) * s(2)};
}

double calc_quad_angle(const std::array<Eigen::Vector3d, 4>& x) {
  const Eigen::Vector3d d13 = (x[2] - x[0]).normalized(), d42 = (x[1] - x[3]).normalized();
  const Eigen::Vector3d normal = d13.cross(-d42).normalized();
  Eigen::Vector3d side = x[1] - x[0];
  side -= normal * normal.dot(side);
  const Eigen::Vector3d axis = d13 + d42;
  return std::atan2(normal.dot(side.cross(axis)), side.dot(axis));
}

ElementIndex index_elements(const fe::Model& model) {
  ElementIndex index;
  for (const auto& element : model.elements()) index[{element->card(), element->id()}] = element.get();
  return index;
}

std::optional<records::ListedElements> make_listed_forces(const fe::Model& model, const ElementIndex& elements,
                                                          const records::ElementForces& forces, const BeamLoads& loads,
                                                          const std::function<bool(int)>& is_wanted) {
  const std::string card = records::get_card_of_group(forces.card);
  const auto type = list_types().find(card);
  if (type == list_types().end()) return std::nullopt;
  records::ListedElements block;
  block.card = card;
  block.type = type->second;
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < forces.id.size(); ++k)
    if (is_wanted(forces.id[k])) rows.push_back(k);
  std::sort(rows.begin(), rows.end(), [&](auto a, auto b) { return forces.id[a] < forces.id[b]; });
  for (const auto k : rows) {
    const auto row = static_cast<Index>(k);
    const int id = forces.id[k];
    VectorXd values = forces.force.row(row).transpose();
    if (block.card == "CBAR") {
      values = make_bar_row(forces.force.row(row));
    } else if (block.card == "CWELD") {
      values = make_weld_row(forces.force.row(row));
    } else if (block.card == "CBEAM") {
      const auto own = loads.find(id);
      values = make_beam_row(forces.force.row(row), own == loads.end() ? Eigen::Vector4d::Zero() : own->second);
      const auto& nodes = elements.at({block.card, id})->shape().nodes;
      block.ends.push_back({model.node(nodes[0]).id, model.node(nodes[1]).id});
    } else if (block.card == "CTRIA3") {
      values = make_shell_row(forces, row, 0);
    } else if (block.card == "CQUAD4") {
      const auto& nodes = elements.at({block.card, id})->shape().nodes;
      const std::array corners{model.node(nodes[0]).x, model.node(nodes[1]).x, model.node(nodes[2]).x,
                               model.node(nodes[3]).x};
      values = make_shell_row(forces, row, calc_quad_angle(corners), calc_point_areas(corners));
    }
    if (block.id.empty()) block.real.resize(static_cast<Index>(rows.size()), values.size());
    block.real.row(static_cast<Index>(block.id.size())) = values.transpose();
    block.id.push_back(id);
  }
  return block;
}

}  // namespace bough::analysis
