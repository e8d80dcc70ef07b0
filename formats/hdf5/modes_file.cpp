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
  file.write_integers("/energies/id", energies.id, {"element ids", "1"});
  file.write_integers("/energies/property", energies.property, {"property ids; 0: none", "1"});
  file.write_strings("/energies/card", energies.card, {"their cards", "1"});
  file.write_matrix("/energies/strain", energies.strain,
                    {"strain energy of each element in each mode, half phi K_e phi: element, mode", "F L/E^2"});
  file.write_matrix("/energies/kinetic", energies.kinetic,
                    {"half phi M_e phi, which times omega^2 is the kinetic energy: element, mode", "M L^2/E^2"});
  file.write_vector("/energies/total_strain", energies.total_strain, {"of the whole stiffness", "F L/E^2"});
  file.write_vector("/energies/total_kinetic", energies.total_kinetic, {"of the whole mass", "M L^2/E^2"});
}

records::ModeEnergies read_energies(FileReader& file, long num_modes) {
  records::ModeEnergies energies;
  if (!file.has("/energies")) return energies;
  energies.id = file.read_integers("/energies/id", -1);
  const auto count = static_cast<long>(energies.id.size());
  energies.property = file.read_integers("/energies/property", count);
  energies.card = file.read_strings("/energies/card", count);
  energies.strain = file.read_matrix("/energies/strain", count, num_modes);
  energies.kinetic = file.read_matrix("/energies/kinetic", count, num_modes);
  energies.total_strain = file.read_vector("/energies/total_strain", num_modes);
  energies.total_kinetic = file.read_vector("/energies/total_kinetic", num_modes);
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
  file.write_number("/rigid/mass", rigid.mass, {"mass, mean of the three directions", "M"});
  file.write_vector("/rigid/cg", rigid.cg, {"centre of mass, basic system", "L"});
  file.write_matrix("/rigid/inertia", rigid.inertia, {"inertia tensor about the reference point, basic axes", "M L^2"});
  file.write_vector("/rigid/reference", rigid.reference, {"reference point, basic system", "L"});
  file.write_matrix("/rigid/mass_matrix", rigid.rigid_mass,
                    {"rigid-body mass matrix about the reference point, translations first", "M, M L, M L^2"});
  file.write_integers("/nodes/id", modes.node_id, {"ids of the nodes", "1"});
  file.write_matrix("/nodes/xyz", modes.node_id.empty() ? Eigen::MatrixXd::Zero(0, 3) : modes.node_xyz,
                    {"their positions, basic system", "L"});
  file.write_vector("/modes/frequency_hz", modes.frequency_hz, {"natural frequency, cycles per unit of time", "1/T"});
  file.write_vector("/modes/eigenvalue", modes.eigenvalue, {"eigenvalue", "1/T^2"});
  write_mode_kinds(file, modes.kind);
  write_mode_shapes(file, modes.phi, n);
  file.write_vector("/modes/residual", modes.residual,
                    {"|K phi - lambda M phi| / |K phi|; absolute for rigid modes", "1"});
  file.write_vector("/modes/mass", modes.modal_mass, {"modal mass", "M L^2/E^2"});
  file.write_attribute("/modes", "num_rigid", modes.num_rigid_modes);
  file.write_attribute("/modes", "inertia_count", modes.inertia_count);
  file.write_matrix(
      "/effective_mass", modes.effective_mass.size() == 0 ? Eigen::MatrixXd::Zero(0, 6) : modes.effective_mass,
      {"modal effective mass: mode, translations x y z and rotations x y z about the origin", "M, M L^2"});
  if (modes.load_factor.size() > 0) {
    file.write_vector("/buckling/load_factor", modes.load_factor,
                      {"factor on the load set at which K + factor K_G is "
                       "singular",
                       "1"});
  }
  write_energies(file, modes.energies);
  if (const auto& about = modes.effective_mass_about; about.grid != 0) {
    file.write_matrix(
        "/effective_mass_about/mass", about.mass,
        {"modal effective mass: mode, translations x y z and rotations x y z about the grid", "M, M L^2"});
    file.write_matrix("/effective_mass_about/rigid", about.rigid,
                      {"rigid-body mass matrix about the grid, translations first", "M, M L, M L^2"});
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
  rigid.cg = file.read_vector("/rigid/cg", 3);
  rigid.inertia = file.read_matrix("/rigid/inertia", 3, 3);
  rigid.reference = file.read_vector("/rigid/reference", 3);
  rigid.rigid_mass = file.read_matrix("/rigid/mass_matrix", 6, 6);
  modes.node_id = file.read_integers("/nodes/id", -1);
  const auto p = static_cast<long>(modes.node_id.size());
  modes.node_xyz = file.read_matrix("/nodes/xyz", p, 3);
  modes.eigenvalue = file.read_vector("/modes/eigenvalue", -1);
  const auto n = static_cast<long>(modes.eigenvalue.size());
  modes.frequency_hz = file.read_vector("/modes/frequency_hz", n);
  modes.kind = read_mode_kinds(file, n);
  modes.residual = file.read_vector("/modes/residual", -1, true);
  modes.modal_mass = file.read_vector("/modes/mass", -1);
  modes.num_rigid_modes = file.read_integer_attribute("/modes", "num_rigid", 0);
  modes.inertia_count = file.read_integer_attribute("/modes", "inertia_count", -1);
  modes.effective_mass = file.read_matrix("/effective_mass", -1, 6);
  if (file.has("/buckling/load_factor")) modes.load_factor = file.read_vector("/buckling/load_factor", -1);
  modes.phi = read_mode_shapes(file, p, std::max(n, static_cast<long>(modes.load_factor.size())));
  modes.energies = read_energies(file, n);
  modes.mesh = read_mesh(file);
  file.throw_if_errors();
  return modes;
}

}  // namespace bough::hdf5
