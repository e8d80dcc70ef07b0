#include <cstdio>
#include <unordered_map>

#include "base/diagnostic.hpp"
#include "formats/export/vtu.hpp"
#include "formats/records/mesh_measure.hpp"

namespace bough::exports {

namespace {

using Eigen::MatrixXd;
using records::BodyMesh;

/// Ends the name of the array of rotations, which follows that of the translations.
constexpr const char* kRotation = "_rotation";

/// printf of three numbers at most, with a point whatever the locale.
std::string format_name(const char* stem, int number, const char* middle, double value, const char* unit) {
  char buffer[80];
  std::snprintf(buffer, sizeof buffer, "%s_%03d_%s%.4g%s", stem, number, middle, value, unit);
  std::string name(buffer);
  for (char& c : name)
    if (c == ',') c = '.';
  return name;
}

/// The part of the mesh whose grids have a shape: `kept` are rows of the mesh. Nodes without a cell get a vertex.
BodyMesh cut_mesh(const BodyMesh& mesh, const std::vector<int>& kept) {
  BodyMesh part;
  std::vector<int> row(mesh.grid_id.size(), -1);
  part.grid_xyz.resize(static_cast<Eigen::Index>(kept.size()), 3);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    row[static_cast<std::size_t>(kept[k])] = static_cast<int>(k);
    part.grid_id.push_back(mesh.grid_id[static_cast<std::size_t>(kept[k])]);
    part.grid_xyz.row(static_cast<Eigen::Index>(k)) = mesh.grid_xyz.row(kept[k]);
  }
  std::vector<bool> has_cell(kept.size(), false);
  for (const auto& block : mesh.blocks) {
    BodyMesh::Block cut;
    cut.type = block.type;
    cut.connectivity.resize(block.connectivity.rows(), block.connectivity.cols());
    for (Eigen::Index e = 0; e < block.connectivity.rows(); ++e) {
      const auto target = static_cast<Eigen::Index>(cut.element_id.size());
      bool is_whole = true;
      for (Eigen::Index i = 0; i < block.connectivity.cols(); ++i) {
        const int node = block.connectivity(e, i);
        const int r = node < 0 ? -1 : row[static_cast<std::size_t>(node)];
        cut.connectivity(target, i) = r;
        is_whole = is_whole && r >= 0;
      }
      if (!is_whole) continue;
      for (Eigen::Index i = 0; i < block.connectivity.cols(); ++i)
        has_cell[static_cast<std::size_t>(cut.connectivity(target, i))] = true;
      cut.element_id.push_back(block.element_id[static_cast<std::size_t>(e)]);
    }
    if (cut.element_id.empty()) continue;
    cut.connectivity.conservativeResize(static_cast<Eigen::Index>(cut.element_id.size()), Eigen::NoChange);
    part.blocks.push_back(std::move(cut));
  }
  BodyMesh::Block points;
  points.type = "vertex";
  std::vector<int> alone;
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (!has_cell[k]) alone.push_back(static_cast<int>(k));
  points.connectivity.resize(static_cast<Eigen::Index>(alone.size()), 1);
  for (std::size_t k = 0; k < alone.size(); ++k) points.connectivity(static_cast<Eigen::Index>(k), 0) = alone[k];
  points.element_id.assign(alone.size(), 0);
  if (!alone.empty()) part.blocks.push_back(std::move(points));
  return part;
}

/// `phi` holds 6 x n of each id, or 3 x n: translations alone.
Picture make_picture(const BodyMesh& mesh, const std::unordered_map<int, MatrixXd>& phi,
                     const std::vector<std::string>& names) {
  Picture picture;
  std::vector<int> kept;
  for (std::size_t k = 0; k < mesh.grid_id.size(); ++k)
    if (phi.count(mesh.grid_id[k]) > 0) kept.push_back(static_cast<int>(k));
  picture.num_missing = static_cast<int>(mesh.grid_id.size() - kept.size());
  picture.mesh = picture.num_missing == 0 ? mesh : cut_mesh(mesh, kept);
  const auto num_points = static_cast<Eigen::Index>(kept.size());
  for (std::size_t j = 0; j < names.size(); ++j) {
    PointArray translation{names[j], MatrixXd(num_points, 3)}, rotation{names[j] + kRotation, MatrixXd(num_points, 3)};
    bool has_rotations = true;
    for (Eigen::Index k = 0; k < num_points; ++k) {
      const auto& shape = phi.at(picture.mesh.grid_id[static_cast<std::size_t>(k)]);
      BOUGH_DEMAND((shape.rows() == 6 || shape.rows() == 3) && shape.cols() == static_cast<Eigen::Index>(names.size()));
      translation.values.row(k) = shape.col(static_cast<Eigen::Index>(j)).head<3>().transpose();
      has_rotations = has_rotations && shape.rows() == 6;
      if (has_rotations) rotation.values.row(k) = shape.col(static_cast<Eigen::Index>(j)).tail<3>().transpose();
    }
    picture.arrays.push_back(std::move(translation));
    if (has_rotations) picture.arrays.push_back(std::move(rotation));
  }
  return picture;
}

std::unordered_map<int, MatrixXd> map_shapes(const std::vector<int>& ids, const std::vector<MatrixXd>& phi) {
  BOUGH_DEMAND(ids.size() == phi.size());
  std::unordered_map<int, MatrixXd> shapes;
  for (std::size_t k = 0; k < ids.size(); ++k) shapes[ids[k]] = phi[k];
  return shapes;
}

/// Rows of U as the dof map says.
std::unordered_map<int, MatrixXd> map_shapes(const Eigen::MatrixXi& dof_map, const MatrixXd& U) {
  BOUGH_DEMAND(U.rows() == dof_map.rows());
  std::unordered_map<int, MatrixXd> shapes;
  for (Eigen::Index i = 0; i < dof_map.rows(); ++i) {
    const int code = dof_map(i, 1);
    if (code < 1 || code > 6) continue;
    auto& shape = shapes.try_emplace(dof_map(i, 0), MatrixXd::Zero(6, U.cols())).first->second;
    shape.row(code - 1) = U.row(i);
  }
  return shapes;
}

std::vector<std::string> make_names(const Eigen::VectorXd& frequency_hz) {
  std::vector<std::string> names;
  for (int j = 0; j < frequency_hz.size(); ++j) names.push_back(format_name("mode", j + 1, "", frequency_hz[j], "Hz"));
  return names;
}

/// A file without a mesh: its nodes alone.
BodyMesh choose_mesh(const BodyMesh& mesh, const std::vector<int>& ids, const MatrixXd& xyz) {
  if (!mesh.grid_id.empty()) return mesh;
  BodyMesh nodes;
  nodes.grid_id = ids;
  nodes.grid_xyz = xyz;
  std::vector<int> all;
  for (int k = 0; k < static_cast<int>(ids.size()); ++k) all.push_back(k);
  return cut_mesh(nodes, all);
}

/// Shares of the whole, an array a mode; and the strain energy itself per length, area or volume.
void add_energies(const std::vector<std::string>& names, const records::ModeEnergies& energies, Picture& picture) {
  const auto add = [&](const std::string& name, const Eigen::VectorXd& part, double whole) {
    auto& array = picture.cells.emplace_back();
    array.name = name;
    for (std::size_t e = 0; e < energies.id.size(); ++e)
      array.by_element[energies.id[e]] = whole > 0 ? part[static_cast<Eigen::Index>(e)] / whole : 0;
  };
  const auto measures = records::calc_measures(picture.mesh);
  for (std::size_t j = 0; !energies.id.empty() && j < names.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    add(names[j] + "_strain_energy", energies.strain.col(column), energies.total_strain[column]);
    if (energies.kinetic.size() > 0)
      add(names[j] + "_kinetic_energy", energies.kinetic.col(column), energies.total_kinetic[column]);
    auto& density = picture.cells.emplace_back();
    density.name = names[j] + "_strain_energy_density";
    for (std::size_t e = 0; e < energies.id.size(); ++e) {
      const auto measure = measures.find(energies.id[e]);
      if (measure != measures.end() && measure->second > 0)
        density.by_element[energies.id[e]] = energies.strain(static_cast<Eigen::Index>(e), column) / measure->second;
    }
  }
}

/// Strain energies of a body that has them; kinetic energies are not in its file.
records::ModeEnergies take_energies(const records::FlexBody& body) {
  const auto& energy = body.strain_energy;
  const auto n = static_cast<Eigen::Index>(body.num_modes());
  records::ModeEnergies taken;
  if (energy.empty()) return taken;
  taken.id = energy.id;
  taken.strain.resize(energy.matrix.rows(), n);
  for (Eigen::Index j = 0; j < n; ++j)
    taken.strain.col(j) = 0.5 * energy.matrix.col(records::ElementStrainEnergy::find_column(j, j, n));
  taken.total_strain = taken.strain.colwise().sum();
  return taken;
}

void add_stresses(const std::string& stem, const records::StaticSubcase& subcase, Picture& picture) {
  auto& energy = picture.cells.emplace_back();
  energy.name = stem + "_strain_energy";
  for (const auto& block : subcase.elements)
    for (std::size_t e = 0; e < block.id.size(); ++e)
      energy.by_element[block.id[e]] = block.strain_energy[static_cast<Eigen::Index>(e)];
  for (const std::string name : {"von_mises", "failure", "max", "min"}) {
    CellArray array;
    array.name = stem + "_" + name;
    for (const auto& block : subcase.stresses)
      for (std::size_t c = 0; c < block.components.size(); ++c)
        for (std::size_t e = 0; block.components[c] == name && e < block.id.size(); ++e)
          array.by_element[block.id[e]] = block.stress(static_cast<Eigen::Index>(e), static_cast<Eigen::Index>(c));
    if (!array.by_element.empty()) picture.cells.push_back(std::move(array));
  }
}

}  // namespace

Picture make_picture(const records::ModesResult& modes) {
  std::vector<std::string> names;
  if (modes.load_factor.size() > 0) {
    for (int j = 0; j < modes.load_factor.size(); ++j)
      names.push_back(format_name("buckling", j + 1, "factor_", modes.load_factor[j], ""));
  } else {
    names = make_names(modes.frequency_hz);
  }
  auto picture =
      make_picture(choose_mesh(modes.mesh, modes.node_id, modes.node_xyz), map_shapes(modes.node_id, modes.phi), names);
  if (!modes.energies.empty()) add_energies(names, modes.energies, picture);
  return picture;
}

Picture make_picture(const records::ComplexModesResult& modes) {
  records::ModesResult parts;
  parts.node_id = modes.node_id;
  parts.node_xyz = modes.node_xyz;
  parts.mesh = modes.mesh;
  parts.frequency_hz = modes.frequency_hz;
  Picture picture;
  for (const bool is_imaginary : {false, true}) {
    parts.phi.clear();
    for (const auto& phi : modes.phi) parts.phi.push_back(is_imaginary ? MatrixXd(phi.imag()) : MatrixXd(phi.real()));
    auto part = make_picture(parts);
    for (auto& array : part.arrays) array.name += is_imaginary ? "_imag" : "_real";
    if (!is_imaginary)
      picture = std::move(part);
    else
      picture.arrays.insert(picture.arrays.end(), part.arrays.begin(), part.arrays.end());
  }
  return picture;
}

Picture make_picture(const records::FlexBody& body) {
  std::unordered_map<int, MatrixXd> shapes;
  if (body.full_phi.size() > 0) {
    shapes = map_shapes(body.dof_map, body.full_phi);
  } else if (body.mesh_phi.size() > 0) {
    for (std::size_t i = 0; i < body.mesh.grid_id.size(); ++i)
      shapes[body.mesh.grid_id[i]] = body.mesh_phi.middleRows(3 * static_cast<Eigen::Index>(i), 3).cast<double>();
  } else {
    shapes = map_shapes(body.node_id, body.phi);
  }
  auto picture =
      make_picture(choose_mesh(body.mesh, body.node_id, body.node_xyz), shapes, make_names(body.frequency_hz));
  add_energies(make_names(body.frequency_hz), take_energies(body), picture);
  return picture;
}

Picture make_picture(const records::StaticResult& result) {
  MatrixXd U(result.dof_map.rows(), static_cast<Eigen::Index>(result.subcases.size()));
  std::vector<std::string> names;
  for (const auto& subcase : result.subcases) {
    U.col(static_cast<Eigen::Index>(names.size())) = subcase.displacement;
    char name[40];
    std::snprintf(name, sizeof name, "subcase_%03d_displacement", subcase.id);
    names.emplace_back(name);
  }
  auto picture = make_picture(result.mesh, map_shapes(result.dof_map, U), names);
  for (const auto& subcase : result.subcases) {
    char stem[40];
    std::snprintf(stem, sizeof stem, "subcase_%03d", subcase.id);
    add_stresses(stem, subcase, picture);
  }
  return picture;
}

}  // namespace bough::exports
