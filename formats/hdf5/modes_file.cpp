#include <algorithm>

#include "base/version.hpp"
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {

namespace {
constexpr const char* kFormat = "bough-modes";
using records::ModesResult;

void write_energies(FileWriter& file, const records::ModeEnergies& energies) {
  if (energies.empty()) return;
  file.write_integers("/energies/id", energies.id);
  file.write_integers("/energies/property", energies.property);
  file.write_strings("/energies/card", energies.card);
  file.write_matrix("/energies/strain", energies.strain);
  file.write_matrix("/energies/kinetic", energies.kinetic);
  file.write_vector("/energies/total_strain", energies.total_strain);
  file.write_vector("/energies/total_kinetic", energies.total_kinetic);
}

records::ModeEnergies read_energies(FileReader& file) {
  records::ModeEnergies energies;
  if (!file.has("/energies")) return energies;
  energies.id = file.read_integers("/energies/id");
  energies.property = file.read_integers("/energies/property");
  energies.card = file.read_strings("/energies/card");
  energies.strain = file.read_matrix("/energies/strain");
  energies.kinetic = file.read_matrix("/energies/kinetic");
  energies.total_strain = file.read_vector("/energies/total_strain");
  energies.total_kinetic = file.read_vector("/energies/total_kinetic");
  return energies;
}
}  // namespace

void write_modes(const ModesResult& modes, const std::string& path) {
  // Buckling has shapes without eigenvalues.
  const auto n = static_cast<int>(std::max(modes.eigenvalue.size(), modes.load_factor.size()));
  FileWriter file(path, kFormat, kModesFormatVersion);
  file.write_source(modes.source);
  file.write_attribute("/", "subcase", modes.subcase);
  const auto& rigid = modes.mass_properties;
  file.write_number("/rigid/mass", rigid.mass);
  file.write_vector("/rigid/cg", rigid.cg);
  file.write_matrix("/rigid/inertia", rigid.inertia);
  file.write_vector("/rigid/reference", rigid.reference);
  file.write_matrix("/rigid/mass_matrix", rigid.rigid_mass);
  file.write_integers("/nodes/id", modes.node_id);
  file.write_matrix("/nodes/xyz", modes.node_id.empty() ? Eigen::MatrixXd::Zero(0, 3) : modes.node_xyz);
  file.write_vector("/modes/frequency_hz", modes.frequency_hz);
  file.write_vector("/modes/eigenvalue", modes.eigenvalue);
  write_mode_kinds(file, modes.kind);
  write_mode_shapes(file, modes.phi, n);
  file.write_vector("/modes/residual", modes.residual);
  file.write_vector("/modes/mass", modes.modal_mass);
  file.write_attribute("/modes", "num_rigid", modes.num_rigid_modes);
  file.write_attribute("/modes", "inertia_count", modes.inertia_count);
  file.write_matrix("/effective_mass",
                    modes.effective_mass.size() == 0 ? Eigen::MatrixXd::Zero(0, 6) : modes.effective_mass);
  if (modes.load_factor.size() > 0) {
    file.write_vector("/buckling/load_factor", modes.load_factor);
  }
  write_energies(file, modes.energies);
  if (const auto& about = modes.effective_mass_about; about.grid != 0) {
    file.write_matrix("/effective_mass_about/mass", about.mass);
    file.write_matrix("/effective_mass_about/rigid", about.rigid);
    file.write_attribute("/effective_mass_about", "grid", about.grid);
  }
  write_mesh(file, modes.mesh);
  file.commit();
}

ModesResult read_modes(const std::string& path) {
  FileReader file(path, kFormat, kModesFormatVersion);
  ModesResult modes;
  modes.source = file.read_source();
  modes.subcase = file.read_integer_attribute("/", "subcase", 0);
  auto& rigid = modes.mass_properties;
  rigid.mass = file.read_number("/rigid/mass");
  rigid.cg = file.read_vector("/rigid/cg");
  rigid.inertia = file.read_matrix("/rigid/inertia");
  rigid.reference = file.read_vector("/rigid/reference");
  rigid.rigid_mass = file.read_matrix("/rigid/mass_matrix");
  modes.node_id = file.read_integers("/nodes/id");
  const auto p = static_cast<long>(modes.node_id.size());
  modes.node_xyz = file.read_matrix("/nodes/xyz");
  modes.eigenvalue = file.read_vector("/modes/eigenvalue");
  const auto n = static_cast<long>(modes.eigenvalue.size());
  modes.frequency_hz = file.read_vector("/modes/frequency_hz");
  modes.kind = read_mode_kinds(file);
  modes.residual = file.read_vector("/modes/residual", -1, true);
  modes.modal_mass = file.read_vector("/modes/mass", -1);
  modes.num_rigid_modes = file.read_integer_attribute("/modes", "num_rigid", 0);
  modes.inertia_count = file.read_integer_attribute("/modes", "inertia_count", -1);
  modes.effective_mass = file.read_matrix("/effective_mass", -1, 6);
  if (file.has("/buckling/load_factor")) modes.load_factor = file.read_vector("/buckling/load_factor");
  modes.phi = read_mode_shapes(file, p, std::max(n, static_cast<long>(modes.load_factor.size())));
  modes.energies = read_energies(file);
  modes.mesh = read_mesh(file);
  file.throw_if_errors();
  return modes;
}

}  // namespace bough::hdf5
