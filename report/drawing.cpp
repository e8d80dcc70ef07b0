#include "report/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <unordered_map>

#include <Eigen/Eigenvalues>

#include "formats/records/mesh_measure.hpp"
#include "report/pack.hpp"

namespace bough::report {

namespace {

constexpr double kMaxShapeBytes = 2.2e6;     // of one body, before base64
constexpr std::size_t kMaxOutlined = 30000;  // faces; of finer meshes the edges are left out

using Face = std::array<int, 4>;  // a triangle repeats its last corner
struct ElementFace {
  Face corners;
  std::uint32_t element;
};
using Kind = DrawnElements::Kind;

/// Corners of the faces of a cell, in the order of VTK's corners; plane elements are one face. Empty: a line or point.
std::vector<Face> list_faces(const std::string& type) {
  if (type.starts_with("tri")) return {{0, 1, 2, 2}};
  if (type.starts_with("quad")) return {{0, 1, 2, 3}};
  if (type.starts_with("tetra")) return {{0, 2, 1, 1}, {0, 1, 3, 3}, {1, 2, 3, 3}, {0, 3, 2, 2}};
  if (type.starts_with("pyramid")) return {{0, 3, 2, 1}, {0, 1, 4, 4}, {1, 2, 4, 4}, {2, 3, 4, 4}, {3, 0, 4, 4}};
  if (type.starts_with("penta")) return {{0, 1, 2, 2}, {3, 5, 4, 4}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  if (type.starts_with("hexa"))
    return {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  return {};
}

bool is_solid(const std::string& type) {
  return type.starts_with("tetra") || type.starts_with("pyramid") || type.starts_with("penta") ||
         type.starts_with("hexa");
}

class DrawingBuilder {
 public:
  DrawingBuilder(const records::BodyMesh& mesh, const std::vector<int>& node_id, const Eigen::MatrixXd& node_xyz)
      : mesh_(mesh) {
    std::map<int, int> node_of;
    for (std::size_t i = 0; i < node_id.size(); ++i) node_of[node_id[i]] = static_cast<int>(i);
    for (const int id : mesh.grid_id) {
      const auto found = node_of.find(id);
      shape_of_grid_.push_back(found == node_of.end() ? -1 : found->second);
    }
    point_of_grid_.assign(mesh.grid_id.size(), -1);
    add_cells();
    add_faces();
    add_corners();
    // Nodes that no element draws are points all the same: markers, interface nodes of rigid elements. Special nodes of
    // a .FLX are none (records::is_special_node).
    const std::set<int> drawn(drawing.id.begin(), drawing.id.end());
    const bool lists_points = mesh.blocks.empty() && !mesh.grid_id.empty();
    const std::set<int> points(mesh.grid_id.begin(), mesh.grid_id.end());
    for (std::size_t i = 0; i < node_id.size(); ++i)
      if (!drawn.contains(node_id[i]) && (!lists_points || points.contains(node_id[i])))
        add_point(node_id[i], node_xyz.row(static_cast<Eigen::Index>(i)), static_cast<int>(i));
    drawing.xyz.resize(static_cast<Eigen::Index>(places_.size()), 3);
    for (std::size_t i = 0; i < places_.size(); ++i) drawing.xyz.row(static_cast<Eigen::Index>(i)) = places_[i];
  }

  void add_shapes(const std::vector<Eigen::MatrixXd>& phi, bool all_shapes) {
    const Eigen::Index modes = phi.empty() ? 0 : phi.front().cols();
    const double bytes = 6.0 * static_cast<double>(places_.size());
    const auto max_modes = static_cast<Eigen::Index>(kMaxShapeBytes / std::max(bytes, 1.0));
    for (Eigen::Index j = 0; j < (all_shapes ? modes : std::min(modes, max_modes)); ++j) {
      Eigen::MatrixXd shape = Eigen::MatrixXd::Zero(drawing.xyz.rows(), 3);
      for (std::size_t i = 0; i < shape_of_point_.size(); ++i)
        if (const int k = shape_of_point_[i]; k >= 0)
          shape.row(static_cast<Eigen::Index>(i)) = phi[static_cast<std::size_t>(k)].col(j).head<3>().transpose();
      drawing.shapes.push_back(std::move(shape));
    }
    drawing.num_dropped = static_cast<int>(modes) - static_cast<int>(drawing.shapes.size());
  }

  Drawing drawing;

 private:
  int add_point(int id, const Eigen::RowVector3d& place, int shape) {
    drawing.id.push_back(id);
    places_.push_back(place);
    shape_of_point_.push_back(shape);
    return static_cast<int>(places_.size()) - 1;
  }
  std::uint32_t use_grid(int grid) {
    const auto g = static_cast<std::size_t>(grid);
    if (point_of_grid_[g] < 0)
      point_of_grid_[g] = add_point(mesh_.grid_id[g], mesh_.grid_xyz.row(grid), shape_of_grid_[g]);
    return static_cast<std::uint32_t>(point_of_grid_[g]);
  }
  bool has_shape(int grid) const { return shape_of_grid_[static_cast<std::size_t>(grid)] >= 0; }

  void add_cells() {
    const auto grids = static_cast<int>(mesh_.grid_id.size());
    for (const auto& block : mesh_.blocks) {
      const auto local = list_faces(block.type);
      const bool solid = is_solid(block.type), line = block.type.starts_with("line");
      for (Eigen::Index e = 0; e < block.connectivity.rows(); ++e) {
        const auto corner = [&](int k) { return block.connectivity(e, k); };
        const auto is_grid = [&](int k) { return corner(k) >= 0 && corner(k) < grids; };
        const auto element = static_cast<std::uint32_t>(drawing.elements.id.size());
        if (line || !local.empty()) {
          drawing.elements.id.push_back(block.element_id[static_cast<std::size_t>(e)]);
          drawing.elements.kind.push_back(line ? Kind::Line : solid ? Kind::Solid : Kind::Surface);
        }
        if (line && block.connectivity.cols() >= 2 && is_grid(0) && is_grid(1)) add_edge(corner(0), corner(1), element);
        for (const auto& f : local) {
          if (!std::all_of(f.begin(), f.end(), [&](int k) { return k < block.connectivity.cols() && is_grid(k); }))
            continue;
          const Face face{corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])};
          if (!solid) {
            faces_.push_back({face, element});
            continue;
          }
          Face key = face;
          std::sort(key.begin(), key.end());
          auto [at, is_new] = solid_faces_.try_emplace(key, ElementFace{face, element});
          if (!is_new) solid_faces_.erase(at);
        }
      }
    }
  }

  void add_faces() {
    for (const auto& [unused, face] : solid_faces_) faces_.push_back(face);
    const bool is_outlined = faces_.size() <= kMaxOutlined;
    for (const auto& [f, element] : faces_) {
      const bool whole = std::all_of(f.begin(), f.end(), [&](int g) { return has_shape(g); });
      if (whole) {
        add_triangle(f[0], f[1], f[2], element);
        if (f[3] != f[2]) add_triangle(f[0], f[2], f[3], element);
      }
      for (std::size_t k = 0; k < 4 && (is_outlined || !whole); ++k)
        if (f[k] != f[(k + 1) % 4]) add_edge(f[k], f[(k + 1) % 4], DrawnElements::kNone);
    }
  }

  void add_triangle(int a, int b, int c, std::uint32_t element) {
    for (const int g : {a, b, c}) drawing.triangles.push_back(use_grid(g));
    drawing.elements.of_triangle.push_back(element);
  }

  /// Pairs for averages: also elements within a solid that touch its surface in a point alone.
  void add_corners() {
    std::uint32_t element = 0;
    for (const auto& block : mesh_.blocks) {
      const auto local = list_faces(block.type);
      const bool is_line = block.type.starts_with("line");
      std::set<int> corners;
      for (const auto& f : local) corners.insert(f.begin(), f.end());
      for (Eigen::Index e = 0; e < block.connectivity.rows(); ++e) {
        for (const int k : corners) {
          const int grid = k < block.connectivity.cols() ? block.connectivity(e, k) : -1;
          if (grid < 0 || grid >= static_cast<int>(point_of_grid_.size())) continue;
          if (const int point = point_of_grid_[static_cast<std::size_t>(grid)]; point >= 0)
            drawing.elements.at_point.insert(drawing.elements.at_point.end(),
                                             {static_cast<std::uint32_t>(point), element});
        }
        if (is_line || !local.empty()) ++element;
      }
    }
  }

  void add_edge(int a, int b, std::uint32_t element) {
    if (!seen_.insert(std::minmax(a, b)).second) return;
    const bool whole = has_shape(a) && has_shape(b);
    for (const int g : {a, b}) (whole ? drawing.edges : drawing.ghosts).push_back(use_grid(g));
    if (whole) drawing.elements.of_edge.push_back(element);
  }

  const records::BodyMesh& mesh_;
  std::vector<int> shape_of_grid_, point_of_grid_, shape_of_point_;
  std::vector<Eigen::RowVector3d> places_;
  std::vector<ElementFace> faces_;
  std::map<Face, ElementFace> solid_faces_;
  std::set<std::pair<int, int>> seen_;
};

/// Limit of the packed matrices, some 1.6 MB of the page.
constexpr Eigen::Index kMaxEntries = 600000;

void add_measures(const records::BodyMesh& mesh, Drawing& drawing) {
  const auto measures = records::calc_measures(mesh);
  const auto& id = drawing.elements.id;
  drawing.measure = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(id.size()));
  for (std::size_t k = 0; k < id.size(); ++k)
    if (const auto measure = measures.find(id[k]); measure != measures.end())
      drawing.measure[static_cast<Eigen::Index>(k)] = measure->second;
}

}  // namespace

void add_energies(const records::BodyMesh& mesh, const std::vector<int>& id, const Eigen::MatrixXd& energy,
                  const Eigen::VectorXd& whole, Drawing& drawing) {
  if (energy.cols() < static_cast<Eigen::Index>(drawing.shapes.size()) || whole.size() != energy.cols()) return;
  std::unordered_map<int, Eigen::Index> row_of;
  for (std::size_t e = 0; e < id.size(); ++e) row_of[id[e]] = static_cast<Eigen::Index>(e);
  add_measures(mesh, drawing);
  const auto count = static_cast<Eigen::Index>(drawing.elements.id.size());
  drawing.energy.assign(drawing.shapes.size(), Eigen::VectorXd::Zero(count));
  for (Eigen::Index k = 0; k < count; ++k) {
    const int element = drawing.elements.id[static_cast<std::size_t>(k)];
    const auto row = row_of.find(element);
    for (std::size_t j = 0; row != row_of.end() && j < drawing.energy.size(); ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      const double share = energy(row->second, column) / whole[column];
      drawing.energy[j][k] = std::isfinite(share) ? std::max(0.0, share) : 0;
    }
  }
}

void add_energies(const records::FlexBody& body, Drawing& drawing) {
  const auto& energy = body.strain_energy;
  if (energy.empty()) return;
  const auto n = static_cast<Eigen::Index>(body.num_modes());
  Eigen::MatrixXd of_shapes(energy.matrix.rows(), n);
  for (Eigen::Index j = 0; j < n; ++j)
    of_shapes.col(j) = 0.5 * energy.matrix.col(records::ElementStrainEnergy::find_column(j, j, n));
  add_energies(body.mesh, energy.id, of_shapes, of_shapes.colwise().sum().transpose(), drawing);
}

bool add_energy_matrices(const records::FlexBody& body, Drawing& drawing) {
  const auto& energy = body.strain_energy;
  const auto n = static_cast<Eigen::Index>(drawing.shapes.size()), all = static_cast<Eigen::Index>(body.num_modes());
  const auto count = static_cast<Eigen::Index>(drawing.elements.id.size());
  if (energy.empty() || n == 0) return true;
  if (n < all || count * n * (n + 1) / 2 > kMaxEntries) return false;
  std::unordered_map<int, Eigen::Index> row_of;
  for (std::size_t e = 0; e < energy.id.size(); ++e) row_of[energy.id[e]] = static_cast<Eigen::Index>(e);
  add_measures(body.mesh, drawing);
  // Stiff modes and soft ones move by amounts of equal energy.
  drawing.weight = body.modal_stiffness.diagonal().head(n).cwiseAbs().cwiseSqrt();
  drawing.energy_matrix = Eigen::MatrixXd::Zero(count, n * (n + 1) / 2);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto row = row_of.find(drawing.elements.id[static_cast<std::size_t>(k)]);
    for (Eigen::Index i = 0, column = 0; row != row_of.end() && i < n; ++i)
      for (Eigen::Index j = i; j < n; ++j, ++column)
        if (const double w = drawing.weight[i] * drawing.weight[j]; w > 0)
          drawing.energy_matrix(k, column) =
              energy.matrix(row->second, records::ElementStrainEnergy::find_column(i, j, all)) / w;
  }
  return true;
}

int Drawing::find(int node) const {
  const auto at = std::find(id.begin(), id.end(), node);
  return at == id.end() ? -1 : static_cast<int>(at - id.begin());
}

Drawing make_drawing(const records::BodyMesh& mesh, const std::vector<int>& node_id, const Eigen::MatrixXd& node_xyz,
                     const std::vector<Eigen::MatrixXd>& phi, bool all_shapes) {
  DrawingBuilder builder(mesh, node_id, node_xyz);
  builder.add_shapes(phi, all_shapes);
  return std::move(builder.drawing);
}

namespace {

Drawing make_flexible_drawing(const records::FlexBody& body, bool all_shapes) {
  if (body.mesh_phi.size() > 0) {
    std::vector<Eigen::MatrixXd> phi;
    for (std::size_t i = 0; i < body.mesh.grid_id.size(); ++i)
      phi.emplace_back(body.mesh_phi.middleRows(3 * static_cast<Eigen::Index>(i), 3).cast<double>());
    return make_drawing(body.mesh, body.mesh.grid_id, body.mesh.grid_xyz, phi, all_shapes);
  }
  if (body.full_phi.size() == 0) return make_drawing(body.mesh, body.node_id, body.node_xyz, body.phi, all_shapes);
  const auto g = static_cast<Eigen::Index>(body.mesh.grid_id.size());
  std::map<int, Eigen::Index> grid_of;
  for (Eigen::Index i = 0; i < g; ++i) grid_of[body.mesh.grid_id[static_cast<std::size_t>(i)]] = i;
  std::vector<Eigen::MatrixXd> phi(body.mesh.grid_id.size(), Eigen::MatrixXd::Zero(6, body.num_modes()));
  for (Eigen::Index row = 0; row < body.dof_map.rows(); ++row) {
    const auto found = grid_of.find(body.dof_map(row, 0));
    const int code = body.dof_map(row, 1);
    if (found == grid_of.end() || code < 1 || code > 6) continue;
    phi[static_cast<std::size_t>(found->second)].row(code - 1) = body.full_phi.row(row);
  }
  return make_drawing(body.mesh, body.mesh.grid_id, body.mesh.grid_xyz, phi, all_shapes);
}

}  // namespace

Drawing make_drawing(const records::FlexBody& body, bool all_shapes) {
  auto drawing = make_flexible_drawing(body, all_shapes);
  drawing.interface = body.interface_nodes;
  return drawing;
}

Drawing make_box(double mass, const Eigen::Vector3d& cg, const Eigen::Matrix3d& inertia,
                 const std::vector<Eigen::Vector3d>& nodes) {
  Drawing box;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(inertia);
  const Eigen::Vector3d J = axes.eigenvalues();
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    // J_j + J_k - J_i = 2/3 m half_i².
    const double moment = J.sum() - 2 * J[i];
    if (mass > 0 && moment > 0) half[i] = std::sqrt(1.5 * moment / mass);
  }
  if (!half.allFinite()) half.setZero();
  half = half.cwiseMax(0.01 * half.maxCoeff());
  const bool has_box = half.maxCoeff() > 0;
  const auto corners = static_cast<Eigen::Index>(has_box ? 8 : 0);
  box.xyz.resize(corners + 1 + static_cast<Eigen::Index>(nodes.size()), 3);
  for (Eigen::Index k = 0; k < corners; ++k) {
    const Eigen::Vector3d sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    box.xyz.row(k) = (cg + axes.eigenvectors() * half.cwiseProduct(sign)).transpose();
  }
  if (has_box) {
    for (const std::uint32_t k :
         {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5})
      box.triangles.push_back(k);
    for (std::uint32_t a = 0; a < 8; ++a)
      for (const std::uint32_t bit : {1U, 2U, 4U})
        if (!(a & bit)) box.edges.insert(box.edges.end(), {a, a | bit});
  }
  box.xyz.row(corners) = cg.transpose();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    box.xyz.row(corners + 1 + static_cast<Eigen::Index>(i)) = nodes[i].transpose();
    box.edges.insert(box.edges.end(), {static_cast<std::uint32_t>(corners),
                                       static_cast<std::uint32_t>(corners) + 1 + static_cast<std::uint32_t>(i)});
  }
  return box;
}

namespace {

/// Elements of several fields are the same: each list is packed once, and `of` of a field is its number.
void add_fields(const Drawing& drawing, nlohmann::json& json) {
  std::map<std::vector<std::uint32_t>, std::size_t> lists;
  auto fields = nlohmann::json::array();
  for (const auto& field : drawing.fields) {
    const auto [list, unused] = lists.try_emplace(field.element, lists.size());
    auto values = nlohmann::json::array();
    for (const auto& column : field.values) {
      auto packed = pack_column(column);
      values.push_back({{"low", packed.low}, {"step", packed.step}, {"data", std::move(packed.data)}});
    }
    fields.push_back({{"name", field.name},
                      {"group", field.group},
                      {"unit", field.unit},
                      {"average", field.has_average},
                      {"of", list->second},
                      {"count", field.element.size()},
                      {"values", values}});
  }
  std::vector<std::string> packed(lists.size());
  for (const auto& [list, number] : lists) packed[number] = pack_indices(list);
  json["fields"] = {{"lists", packed}, {"list", fields}};
  json["id"] = pack_indices(std::vector<std::uint32_t>(drawing.elements.id.begin(), drawing.elements.id.end()));
  json["property"] = pack_indices(drawing.property);
  json["at_point"] = pack_indices(drawing.elements.at_point);
}

}  // namespace

std::string to_json_text(const Drawing& drawing) {
  const auto flatten = [](const Eigen::MatrixXd& rows) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> r = rows;
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(r.data(), r.size()));
  };
  nlohmann::json json{{"xyz", pack_floats(flatten(drawing.xyz))}, {"triangles", pack_indices(drawing.triangles)},
                      {"edges", pack_indices(drawing.edges)},     {"ghosts", pack_indices(drawing.ghosts)},
                      {"shapes", nlohmann::json::array()},        {"dropped", drawing.num_dropped}};
  json["id"] = pack_indices(std::vector<std::uint32_t>(drawing.id.begin(), drawing.id.end()));
  if (!drawing.interface.empty())
    json["interface"] = pack_indices(std::vector<std::uint32_t>(drawing.interface.begin(), drawing.interface.end()));
  for (const auto& shape : drawing.shapes) {
    const double largest = shape.size() > 0 ? shape.cwiseAbs().maxCoeff() : 0;
    json["shapes"].push_back({{"largest", largest}, {"data", pack_shorts(flatten(shape), largest)}});
  }
  if (!drawing.energy.empty() || drawing.energy_matrix.size() > 0 || !drawing.fields.empty()) {
    std::vector<std::uint32_t> kind;
    for (const auto k : drawing.elements.kind) kind.push_back(static_cast<std::uint32_t>(k));
    json["elements"] = {{"of_triangle", pack_indices(drawing.elements.of_triangle)},
                        {"of_edge", pack_indices(drawing.elements.of_edge)},
                        {"kind", pack_indices(kind)},
                        {"measure", pack_floats(drawing.measure)},
                        {"energy", nlohmann::json::array()}};
    for (const auto& share : drawing.energy) {
      const double largest = share.size() > 0 ? share.maxCoeff() : 0;
      json["elements"]["energy"].push_back({{"largest", largest}, {"data", pack_shorts(share, largest)}});
    }
  }
  if (!drawing.fields.empty()) add_fields(drawing, json["elements"]);
  if (drawing.energy_matrix.size() > 0) {
    const Eigen::VectorXd largest = drawing.energy_matrix.cwiseAbs().rowwise().maxCoeff();
    Eigen::MatrixXd rows = drawing.energy_matrix;
    for (Eigen::Index k = 0; k < rows.rows(); ++k)
      if (largest[k] > 0) rows.row(k) /= largest[k];
    json["elements"]["matrix"] = {{"weight", pack_floats(drawing.weight)},
                                  {"largest", pack_floats(largest)},
                                  {"data", pack_shorts(flatten(rows), 1)}};
  }
  return json.dump();
}

}  // namespace bough::report
