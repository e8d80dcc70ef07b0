#include "base/version.hpp"
#include "formats/hdf5/detail/writer.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {
namespace {

/// Writes ids and properties of the elements of a card; returns its group.
template <class Block>
std::string write_ids(FileWriter& file, const std::string& path, const Block& block) {
  const std::string group = path + block.card;
  file.write_integers(group + "/id", block.id);
  file.write_integers(group + "/property", block.property);
  return group;
}

void write_grid_forces(FileWriter& file, const std::string& path, const std::vector<records::GridForce>& forces) {
  if (forces.empty()) return;
  std::vector<int> grids, elements;
  std::vector<std::string> sources;
  Eigen::MatrixXd values(static_cast<Eigen::Index>(forces.size()), 6);
  for (const auto& f : forces) {
    values.row(static_cast<Eigen::Index>(grids.size())) = f.force.transpose();
    grids.push_back(f.node);
    elements.push_back(f.element);
    sources.push_back(f.source);
  }
  file.write_integers(path + "/grid", grids);
  file.write_strings(path + "/source", sources);
  file.write_integers(path + "/element", elements);
  file.write_matrix(path + "/force", values);
}

void write_subcase(FileWriter& file, const records::StaticSubcase& subcase) {
  const std::string path = "/subcases/" + std::to_string(subcase.id);
  file.make_group("/subcases");
  file.make_group(path);
  file.write_attribute(path, "label", subcase.label);
  file.write_attribute(path, "load_set", subcase.load_set);
  file.write_attribute(path, "temperature_set", subcase.temperature_set);
  file.write_attribute(path, "spc_set", subcase.spc_set);
  file.write_attribute(path, "mpc_set", subcase.mpc_set);
  file.write_vector(path + "/displacement", subcase.displacement);
  file.write_vector_with_zeros(path + "/load", subcase.load);
  file.write_vector_with_zeros(path + "/reaction", subcase.reaction);
  file.write_vector_with_zeros(path + "/mpc_force", subcase.mpc_force);
  file.write_number(path + "/strain_energy", subcase.strain_energy);
  file.write_number(path + "/epsilon", subcase.epsilon);
  Eigen::Matrix<double, 3, 6> resultants;
  resultants << subcase.load_resultant.transpose(), subcase.reaction_resultant.transpose(),
      subcase.mpc_resultant.transpose();
  file.write_matrix(path + "/resultants", resultants);
  if (!subcase.support.empty()) {
    const auto rows = static_cast<Eigen::Index>(subcase.support.size());
    Eigen::MatrixXi dofs(rows, 2);
    Eigen::VectorXd energy(rows), acceleration(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto& row = subcase.support[static_cast<std::size_t>(i)];
      dofs.row(i) << row.node, row.component;
      energy[i] = row.strain_energy;
      acceleration[i] = row.acceleration;
    }
    const std::string group = path + "/support";
    file.write_integers(group + "/dofs", dofs);
    file.write_vector(group + "/strain_energy", energy);
    file.write_number(group + "/epsilon", subcase.support_epsilon);
    if (subcase.inertia.size() > 0) {
      file.write_vector(group + "/acceleration", acceleration);
      file.write_vector(path + "/inertia", subcase.inertia);
    }
  }
  for (const auto& block : subcase.elements) {
    const auto group = write_ids(file, path + "/elements/", block);
    file.write_matrix(group + "/force", block.force);
    file.write_vector(group + "/strain_energy", block.strain_energy);
    file.write_attribute(group, "components", block.components);
  }
  for (const auto& block : subcase.stresses) {
    const auto group = write_ids(file, path + "/stresses/", block);
    file.write_matrix(group + "/stress", block.stress);
    file.write_attribute(group, "components", block.components);
  }
  for (const auto& block : subcase.strains) {
    const auto group = write_ids(file, path + "/strains/", block);
    file.write_matrix(group + "/strain", block.stress);
    if (block.corner.cols() > 0) file.write_matrix(group + "/corner", block.corner);
    file.write_attribute(group, "components", block.components);
  }
  for (const auto& block : subcase.margins) {
    const std::string group = path + "/margins/" + block.card;
    file.write_integers(group + "/id", block.id);
    file.write_matrix(group + "/margin", block.margin);
    file.write_attribute(group, "components", std::vector<std::string>{"tension", "compression", "shear"});
  }
  write_grid_forces(file, path + "/grid_forces", subcase.grid_forces);
}

void write_extremes(FileWriter& file, const records::CaseExtremes& block) {
  const std::string group = "/extremes/" + block.path;
  file.write_integers(group + "/id", block.id);
  file.write_matrix(group + "/min", block.low, {"", block.dims});
  file.write_matrix(group + "/max", block.high, {"", block.dims});
  file.write_integers(group + "/min_subcase", block.low_case);
  file.write_integers(group + "/max_subcase", block.high_case);
  file.write_attribute(group, "components", block.components);
}

void write_sparse(FileWriter& file, const std::string& path, const records::SparseMatrix& matrix) {
  file.write_vector(path + "/data", Eigen::Map<const Eigen::VectorXd>(matrix.data.data(),
                                                                      static_cast<Eigen::Index>(matrix.data.size())));
  file.write_integers(path + "/indices", matrix.indices);
  file.write_integers(path + "/indptr", matrix.indptr);
  file.write_integers(path + "/shape", std::vector<int>{matrix.num_rows, matrix.num_cols});
}

/// All but the subcases.
void write_common(FileWriter& file, const records::StaticResult& whole) {
  file.write_source(whole.source);
  file.write_integers("/dof_map", whole.dof_map);
  write_mesh(file, whole.mesh);
  for (const auto& block : whole.extremes) write_extremes(file, block);
}

void write_all(FileWriter& file, const records::MatricesResult& result) {
  file.write_source(result.source);
  file.write_integers("/dof_map", result.dof_map);
  write_mesh(file, result.mesh);
  write_sparse(file, "/K", result.K);
  write_sparse(file, "/M", result.M);
  if (result.B.num_rows > 0) write_sparse(file, "/B", result.B);
  for (const auto& [name, matrix] : result.K_G) write_sparse(file, "/KG/" + name, matrix);
}

}  // namespace

StaticWriter::StaticWriter(const std::string& path)
    : file_(std::make_unique<FileWriter>(path, "bough-static", kStaticFormatVersion)) {}

StaticWriter::~StaticWriter() = default;

void StaticWriter::add(const records::StaticSubcase& subcase) { write_subcase(*file_, subcase); }

void StaticWriter::start_sync() { file_->start_sync(); }

void StaticWriter::commit(const records::StaticResult& whole) {
  write_common(*file_, whole);
  file_->commit();
}

void write_static(const records::StaticResult& result, const std::string& path) {
  StaticWriter file(path);
  for (const auto& subcase : result.subcases) file.add(subcase);
  file.commit(result);
}

std::string make_static_image(const records::StaticResult& result) {
  FileWriter file("bough-static", kStaticFormatVersion);
  for (const auto& subcase : result.subcases) write_subcase(file, subcase);
  write_common(file, result);
  return file.get_image();
}

void write_matrices(const records::MatricesResult& result, const std::string& path) {
  FileWriter file(path, "bough-matrices", kMatricesFormatVersion);
  write_all(file, result);
  file.commit();
}

std::string make_matrices_image(const records::MatricesResult& result) {
  FileWriter file("bough-matrices", kMatricesFormatVersion);
  write_all(file, result);
  return file.get_image();
}

}  // namespace bough::hdf5
