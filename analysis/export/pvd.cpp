#include <fmt/format.h>

#include <filesystem>
#include <unordered_map>

#include "analysis/common/output_folder.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/export/moving_system.hpp"
#include "base/xml_text.hpp"
#include "formats/export/uff.hpp"
#include "formats/export/vtu.hpp"
#include "formats/records/mesh_measure.hpp"

namespace bough::analysis {

namespace fs = std::filesystem;

namespace {

using Eigen::MatrixXd;

/// A body in its frame B: the mesh, and of each mode the displacements of its points (g x 3).
struct Part {
  records::BodyMesh mesh;
  std::vector<MatrixXd> modes;
  std::size_t first_block = 0;  ///< of the mesh of all
};

/// The box of a rigid body with its lines, and a point where nothing else is.
Part make_rigid_part(const report::Drawing& drawing) {
  Part part;
  part.mesh.grid_xyz = drawing.xyz;
  part.mesh.grid_id.assign(static_cast<std::size_t>(drawing.xyz.rows()), 0);
  const auto add = [&](const char* type, const std::vector<std::uint32_t>& nodes, Eigen::Index width) {
    records::BodyMesh::Block block;
    block.type = type;
    block.connectivity.resize(static_cast<Eigen::Index>(nodes.size()) / width, width);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      block.connectivity(static_cast<Eigen::Index>(i) / width, static_cast<Eigen::Index>(i) % width) =
          static_cast<int>(nodes[i]);
    block.element_id.assign(static_cast<std::size_t>(block.connectivity.rows()), 0);
    part.mesh.blocks.push_back(std::move(block));
  };
  add("tri3", drawing.triangles, 3);
  add("line2", drawing.edges, 2);
  if (drawing.triangles.empty() && drawing.edges.empty()) add("vertex", {0}, 1);
  return part;
}

Part make_part(const MovingBody& body, Diagnostics& diagnostics) {
  if (!body.flex) return make_rigid_part(body.drawing);
  auto picture = exports::make_picture(*body.flex);
  if (picture.num_missing > 0)
    diagnostics.warning("export.partial-shapes", {},
                        fmt::format("body {}: mode shapes at {} of {} grids, the others are not drawn", body.name,
                                    picture.mesh.grid_id.size(),
                                    picture.mesh.grid_id.size() + static_cast<std::size_t>(picture.num_missing)),
                        "reduce with --full, or without a list of output nodes");
  Part part{std::move(picture.mesh), {}, 0};
  for (auto& array : picture.arrays)
    if (!array.name.ends_with("_rotation")) part.modes.push_back(std::move(array.values));
  return part;
}

MatrixXd sum_modes(const Part& part, const MatrixXd& eta, Eigen::Index sample) {
  MatrixXd u = MatrixXd::Zero(part.mesh.grid_xyz.rows(), 3);
  for (Eigen::Index j = 0; j < std::min(eta.cols(), static_cast<Eigen::Index>(part.modes.size())); ++j)
    u += eta(sample, j) * part.modes[static_cast<std::size_t>(j)];
  return u;
}

/// ½ ηᵀ K η with the stiffness of the body file: what its modes store, without geometric stiffness of the motion.
double calc_strain_energy(const MovingBody& body, Eigen::Index sample) {
  if (!body.flex || body.eta.cols() == 0) return 0;
  const auto n = std::min(body.eta.cols(), body.flex->modal_stiffness.rows());
  const Eigen::VectorXd eta = body.eta.row(sample).head(n).transpose();
  return 0.5 * eta.dot(body.flex->modal_stiffness.topLeftCorner(n, n) * eta);
}

/// ½ ηᵀ k η of each element that the body file has (records::ElementStrainEnergy).
Eigen::VectorXd calc_element_energies(const records::FlexBody& body, const Eigen::RowVectorXd& eta) {
  const auto n = static_cast<Eigen::Index>(body.num_modes());
  Eigen::VectorXd pairs(n * (n + 1) / 2);
  for (Eigen::Index i = 0, k = 0; i < n; ++i)
    for (Eigen::Index j = i; j < n; ++j) pairs[k++] = (i == j ? 0.5 : 1) * eta[i] * eta[j];
  return body.strain_energy.matrix * pairs;
}

/// The folder of the frames. Without keep() what was not there before goes again: a disk that is full stays no fuller.
class FrameFolder {
 public:
  explicit FrameFolder(const fs::path& place) : place_(place) {
    check_place(place.string());
    std::error_code failed;
    is_new_ = fs::create_directories(place, failed);
    if (failed)
      throw ComputationError("cli.write", {place.string()}, "the folder cannot be made: " + failed.message(),
                             "choose another place with -o");
  }
  ~FrameFolder() {
    std::error_code failed;
    for (const auto& file : added_) fs::remove(file, failed);
    if (is_new_) fs::remove(place_, failed);
  }
  FrameFolder(const FrameFolder&) = delete;
  FrameFolder& operator=(const FrameFolder&) = delete;

  void write(const std::string& name, const std::string& text) {
    const auto file = place_ / name;
    std::error_code failed;
    if (!fs::exists(file, failed)) added_.push_back(file);
    write_text_file(file.string(), text);
  }
  void keep() {
    added_.clear();
    is_new_ = false;
  }

 private:
  fs::path place_;
  bool is_new_ = false;
  std::vector<fs::path> added_;
};

/// The mesh of all bodies as one; what moves is filled in for each frame.
class Frames {
 public:
  Frames(const MovingSystem& system, double scale, Diagnostics& diagnostics) : system_(system), scale_(scale) {
    for (const auto& body : system.bodies) parts_.push_back(make_part(body, diagnostics));
    for (auto& part : parts_) {
      part.first_block = mesh_.blocks.size();
      const auto first = static_cast<int>(mesh_.grid_id.size());
      mesh_.grid_id.insert(mesh_.grid_id.end(), part.mesh.grid_id.begin(), part.mesh.grid_id.end());
      for (auto block : part.mesh.blocks) {
        block.connectivity = block.connectivity.unaryExpr([&](int k) { return k < 0 ? k : k + first; });
        mesh_.blocks.push_back(std::move(block));
      }
    }
    const auto g = static_cast<Eigen::Index>(mesh_.grid_id.size());
    mesh_.grid_xyz.resize(g, 3);
    arrays_ = {{"body", MatrixXd(g, 1)},
               {"displacement", MatrixXd(g, 3)},
               {"displacement_magnitude", MatrixXd(g, 1)},
               {"velocity", MatrixXd(g, 3)},
               {"strain_energy", MatrixXd(g, 1)}};
    add_cells();
  }

  /// The mesh as the last sample placed it.
  const records::BodyMesh& get_mesh() const { return mesh_; }

  std::string make(Eigen::Index sample, exports::VtuEncoding encoding) {
    place(sample);
    return exports::make_vtu(mesh_, arrays_, encoding, cells_);
  }

  /// Body b + 1 has ids from (b + 1) 10^d on: with the ids of its grids behind, or, rigid, its points in order.
  /// Numbers from 1 on where these would be longer than an integer.
  std::vector<int> number_grids() const {
    long max_id = 1, unit = 1;
    for (const auto& part : parts_) max_id = std::max(max_id, static_cast<long>(part.mesh.grid_id.size()));
    for (const int id : mesh_.grid_id) max_id = std::max(max_id, static_cast<long>(id));
    while (unit <= max_id) unit *= 10;
    const bool fits = unit * static_cast<long>(parts_.size() + 1) < std::numeric_limits<int>::max();
    std::vector<int> ids;
    for (std::size_t b = 0; b < parts_.size(); ++b)
      for (std::size_t k = 0; k < parts_[b].mesh.grid_id.size(); ++k) {
        const long own = parts_[b].mesh.grid_id[k] > 0 ? parts_[b].mesh.grid_id[k] : static_cast<long>(k) + 1;
        ids.push_back(fits ? static_cast<int>(unit * static_cast<long>(b + 1) + own)
                           : static_cast<int>(ids.size()) + 1);
      }
    return ids;
  }

  /// x = r + R (p + s Φη), v = ṙ + R (ω × (p + Φη) + Φη̇) with ω in B.
  void place(Eigen::Index sample) {
    Eigen::Index first = 0;
    for (std::size_t b = 0; b < parts_.size(); ++b) {
      const auto& body = system_.bodies[b];
      const auto& part = parts_[b];
      const auto g = part.mesh.grid_xyz.rows();
      const Eigen::Matrix3d R = to_rotation(body.quaternion.row(sample));
      const MatrixXd u = sum_modes(part, body.eta, sample);
      const auto rows = Eigen::seqN(first, g);
      mesh_.grid_xyz(rows, Eigen::all) =
          ((part.mesh.grid_xyz + scale_ * u) * R.transpose()).rowwise() + body.position.row(sample);
      arrays_[0].values(rows, 0).setConstant(static_cast<double>(b + 1));
      arrays_[1].values(rows, Eigen::all) = u * R.transpose();
      arrays_[2].values(rows, 0) = u.rowwise().norm();
      MatrixXd v = sum_modes(part, body.eta_dot, sample);
      if (body.angular_velocity.cols() == 3) {
        const Eigen::Vector3d w = body.angular_velocity.row(sample).transpose();
        for (Eigen::Index k = 0; k < g; ++k)
          v.row(k) += w.cross(Eigen::Vector3d((part.mesh.grid_xyz.row(k) + u.row(k)).transpose())).transpose();
      }
      v = v * R.transpose();
      if (body.velocity.cols() == 3) v.rowwise() += body.velocity.row(sample);
      arrays_[3].values(rows, Eigen::all) = v;
      arrays_[4].values(rows, 0).setConstant(calc_strain_energy(body, sample));
      place_energies(b, sample);
      first += g;
    }
  }

 private:
  bool has_energies(std::size_t b) const {
    const auto& body = system_.bodies[b];
    return body.flex && !body.flex->strain_energy.empty() && body.eta.cols() == body.flex->num_modes();
  }

  /// Adds the energies of all elements: zero for bodies without energies, if one has them.
  void add_cells() {
    bool has_any = false;
    for (std::size_t b = 0; b < parts_.size(); ++b) has_any = has_any || has_energies(b);
    if (!has_any) return;
    cells_ = {{"element_strain_energy", {}, {}}, {"element_strain_energy_density", {}, {}}};
    for (auto& array : cells_)
      for (const auto& block : mesh_.blocks)
        array.by_block.emplace_back(Eigen::VectorXd::Zero(block.connectivity.rows()));
    measures_.resize(parts_.size());
    for (std::size_t b = 0; b < parts_.size(); ++b)
      if (has_energies(b)) measures_[b] = records::calc_measures(parts_[b].mesh);
  }

  void place_energies(std::size_t b, Eigen::Index sample) {
    if (!has_energies(b)) return;
    const auto& body = system_.bodies[b];
    const auto& id = body.flex->strain_energy.id;
    const Eigen::VectorXd energy = calc_element_energies(*body.flex, body.eta.row(sample));
    std::unordered_map<int, double> by_element;
    for (std::size_t e = 0; e < id.size(); ++e) by_element[id[e]] = energy[static_cast<Eigen::Index>(e)];
    const auto& blocks = parts_[b].mesh.blocks;
    for (std::size_t k = 0; k < blocks.size(); ++k)
      for (std::size_t e = 0; e < blocks[k].element_id.size(); ++e) {
        const int element = blocks[k].element_id[e];
        const auto found = by_element.find(element);
        const auto measure = measures_[b].find(element);
        const double value = found == by_element.end() ? 0 : found->second;
        const auto at = static_cast<Eigen::Index>(e);
        cells_[0].by_block[parts_[b].first_block + k][at] = value;
        cells_[1].by_block[parts_[b].first_block + k][at] =
            measure != measures_[b].end() && measure->second > 0 ? value / measure->second : 0;
      }
  }

  const MovingSystem& system_;
  double scale_;
  std::vector<Part> parts_;
  records::BodyMesh mesh_;
  std::vector<exports::PointArray> arrays_;
  std::vector<exports::CellArray> cells_;
  std::vector<std::unordered_map<int, double>> measures_;  ///< of the elements of each body
};

/// Without the faces of boxes, of which the edges are there too.
records::BodyMesh take_lines(records::BodyMesh mesh) {
  std::erase_if(mesh.blocks, [](const auto& block) {
    return block.type == "tri3" && !block.element_id.empty() && block.element_id.front() == 0;
  });
  return mesh;
}

}  // namespace

std::string make_moving_uff(const MovingSystem& system, double scale, const std::string& name,
                            Diagnostics& diagnostics) {
  Frames frames(system, scale, diagnostics);
  frames.place(0);
  auto first = take_lines(frames.get_mesh());
  first.grid_id = frames.number_grids();
  const auto calc_displacement = [&](Eigen::Index sample) -> MatrixXd {
    frames.place(sample);
    return frames.get_mesh().grid_xyz - first.grid_xyz;
  };
  return exports::make_uff(first, system.time, calc_displacement, name);
}

int write_pvd(const MovingSystem& system, double scale, bool is_ascii, const std::string& output,
              Diagnostics& diagnostics) {
  const fs::path collection(output);
  const std::string folder = collection.stem().string() + "-frames";
  FrameFolder place(collection.parent_path() / folder);
  Frames frames(system, scale, diagnostics);
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<Collection>\n";
  const auto count = static_cast<int>(system.time.size());
  for (int i = 0; i < count; ++i) {
    const auto name = fmt::format("{:06}.vtu", i);
    place.write(name, frames.make(i, is_ascii ? exports::VtuEncoding::Ascii : exports::VtuEncoding::Base64));
    text += fmt::format("<DataSet timestep=\"{:.17g}\" group=\"\" part=\"0\" file=\"{}\"/>\n", system.time[i],
                        escape_xml(folder + "/" + name));
  }
  // Last: a collection that is there names whole files.
  write_text_file(output, text + "</Collection>\n</VTKFile>\n");
  place.keep();
  return count;
}

}  // namespace bough::analysis
