#include <algorithm>

#include "base/version.hpp"
#include "formats/hdf5/body_accuracy.hpp"
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/recovery.hpp"
#include "formats/hdf5/detail/third_order.hpp"
#include "formats/hdf5/detail/writer.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/records/body_faults.hpp"

namespace bough::hdf5 {

namespace {

using Eigen::MatrixXd;
using records::FlexBody;
using records::MassIntegrals;

constexpr const char* kFormat = "bough-flexbody";
constexpr const char* kMethods[] = {"lumped", "consistent", "exact"};
const std::vector<std::string>& get_load_names() {
  static const std::vector<std::string> names{"ax",  "ay",  "az",  "alx",  "aly",  "alz",
                                              "wx2", "wy2", "wz2", "wxwy", "wxwz", "wywz"};
  return names;
}

hsize_t to_dim(std::size_t n) { return static_cast<hsize_t>(n); }

/// Blocks of equal shape one after another, each in C order.
template <class Matrix>
void append(std::vector<double>& data, const Matrix& m) {
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    for (Eigen::Index j = 0; j < m.cols(); ++j) data.push_back(m(i, j));
  }
}

/// Not written if the record has none (older files, other formats).
void write_resultants(FileWriter& file, const FlexBody& body) {
  const auto ne = body.locators.size();
  if (ne > 0 && body.load_resultant.size() == 0) return;
  BOUGH_DEMAND(body.load_moment.size() == ne);
  file.write_matrix("/stiffening/load_resultant", ne == 0 ? MatrixXd::Zero(6, 0) : body.load_resultant);
  std::vector<double> moment;
  for (const auto& m : body.load_moment) append(moment, m);
  const auto n = to_dim(static_cast<std::size_t>(body.num_modes()));
  BOUGH_DEMAND(moment.size() == ne * 3 * n);
  file.write_numbers("/stiffening/load_moment", {to_dim(ne), 3, n}, moment.data());
}

void write_stiffening(FileWriter& file, const FlexBody& body) {
  const auto n = to_dim(static_cast<std::size_t>(body.num_modes()));
  std::vector<double> inertial;
  std::vector<int> computed;
  for (int i = 0; i < records::kNumInertialLoads; ++i) {
    const auto k = static_cast<std::size_t>(i);
    computed.push_back(body.kg_inertial_computed[k] ? 1 : 0);
    const MatrixXd& kg = body.kg_inertial[k];
    BOUGH_DEMAND(kg.size() == 0 || (kg.rows() == body.num_modes() && kg.cols() == body.num_modes()));
    append(inertial, kg.size() == 0 ? MatrixXd::Zero(body.num_modes(), body.num_modes()) : kg);
  }
  const std::string path = "/stiffening/kg_inertial";
  file.write_numbers(path, {records::kNumInertialLoads, n, n}, inertial.data());
  file.write_attribute(path, "loads", get_load_names());
  file.write_attribute(path, "computed", computed);
  file.write_integers("/stiffening/computed", computed);

  std::vector<double> external;
  BOUGH_DEMAND(body.kg_external.size() == body.locators.size());
  for (const auto& kg : body.kg_external) append(external, kg);
  BOUGH_DEMAND(external.size() == body.locators.size() * n * n);
  file.write_numbers("/stiffening/kg_external", {to_dim(body.locators.size()), n, n}, external.data());
  std::vector<std::string> names;
  std::vector<int> nodes, directions;
  for (const auto& locator : body.locators) {
    names.push_back(locator.name);
    nodes.push_back(locator.node);
    directions.push_back(locator.direction);
  }
  file.write_strings("/stiffening/locator/name", names);
  file.write_integers("/stiffening/locator/node", nodes);
  file.write_integers("/stiffening/locator/direction", directions);
  file.write_matrix("/stiffening/external_load",
                    body.locators.empty() ? MatrixXd::Zero(body.num_modes(), 0) : body.external_load);
  write_resultants(file, body);
}

void write_mesh_shapes(FileWriter& file, const FlexBody& body) {
  if (body.mesh_phi.size() == 0) return;
  const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = body.mesh_phi;
  file.write_floats("/mesh/phi", {to_dim(body.mesh.grid_id.size()), 3, to_dim(static_cast<std::size_t>(rows.cols()))},
                    rows.data());
}

void write_preload(FileWriter& file, const FlexBody& body) {
  if (body.preload.empty()) return;
  file.make_group("/preload");
  file.write_attribute("/preload", "loads", body.preload);
  file.write_vector("/preload/inertial", body.preload_A_I);
  file.write_matrix("/stiffening/kg_preload", body.kg_preload);
}

void read_preload(FileReader& file, FlexBody& body) {
  if (!file.has("/preload")) return;
  body.preload = file.read_attribute("/preload", "loads");
  body.preload_A_I = file.read_vector("/preload/inertial");
  body.kg_preload = file.read_matrix("/stiffening/kg_preload");
}

void read_stiffening(FileReader& file, FlexBody& body) {
  const long n = body.num_modes();
  const NumberArray inertial = file.read_array("/stiffening/kg_inertial");
  const std::vector<int> computed = file.read_integers("/stiffening/computed");
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (std::size_t i = 0; i < records::kNumInertialLoads; ++i) {
    body.kg_inertial[i] = Eigen::Map<const RowMajor>(inertial.data.data() + static_cast<long>(i) * n * n, n, n);
    body.kg_inertial_computed[i] = computed[i] != 0;
  }
  const std::vector<std::string> names = file.read_strings("/stiffening/locator/name");
  const auto ne = static_cast<long>(names.size());
  const std::vector<int> nodes = file.read_integers("/stiffening/locator/node");
  const std::vector<int> directions = file.read_integers("/stiffening/locator/direction");
  const NumberArray external = file.read_array("/stiffening/kg_external");
  for (long e = 0; e < ne; ++e) {
    const auto k = static_cast<std::size_t>(e);
    body.locators.push_back({names[k], nodes[k], directions[k]});
    body.kg_external.emplace_back(Eigen::Map<const RowMajor>(external.data.data() + e * n * n, n, n));
  }
  body.external_load = file.read_matrix("/stiffening/external_load");
  if (!file.has("/stiffening/load_resultant")) return;  // an older file
  body.load_resultant = file.read_matrix("/stiffening/load_resultant");
  const NumberArray moment = file.read_array("/stiffening/load_moment");
  for (long e = 0; e < ne; ++e)
    body.load_moment.emplace_back(Eigen::Map<const RowMajor>(moment.data.data() + e * 3 * n, 3, n));
}

void read_method(FileReader& file, FlexBody& body) {
  body.integrals_method = file.read_attribute("/integrals", "method");
  body.masses = file.read_attribute("/integrals", "masses");
  const bool is_known =
      std::find(std::begin(kMethods), std::end(kMethods), body.integrals_method) != std::end(kMethods);
  if (is_known && body.num_modes() > 0 && !file.has("/integrals/" + body.integrals_method)) {
    file.error("hdf5.missing", "/integrals/" + body.integrals_method + " is missing, the set that the solver uses",
               "write the file again");
  }
}

}  // namespace

void write_integrals(FileWriter& file, const std::string& path, const MassIntegrals& g) {
  if (g.empty()) return;
  const auto n = to_dim(static_cast<std::size_t>(g.gamma0.cols()));
  BOUGH_DEMAND(g.gamma2.size() == n && g.gamma3.size() == n && g.gamma4.size() == n);
  file.write_matrix(path + "/gamma0", g.gamma0.transpose());
  file.write_matrix(path + "/gamma1", g.gamma1.transpose());
  std::vector<double> gamma2, gamma3, gamma4;
  for (std::size_t j = 0; j < n; ++j) {
    append(gamma2, g.gamma2[j].transpose());
    append(gamma3, g.gamma3[j]);
    BOUGH_DEMAND(g.gamma4[j].size() == n);
    for (const auto& block : g.gamma4[j]) append(gamma4, block);
  }
  file.write_numbers(path + "/gamma2", {n, n, 3}, gamma2.data());
  file.write_numbers(path + "/gamma3", {n, 3, 3}, gamma3.data());
  file.write_numbers(path + "/gamma4", {n, n, 3, 3}, gamma4.data());
}

MassIntegrals read_integrals(FileReader& file, const std::string& path, long n) {
  MassIntegrals g;
  if (!file.has(path)) return g;
  g.gamma0 = file.read_matrix(path + "/gamma0", n, 3).transpose();
  g.gamma1 = file.read_matrix(path + "/gamma1", n, 3).transpose();
  const NumberArray gamma2 = file.read_array(path + "/gamma2", {n, n, 3});
  const NumberArray gamma3 = file.read_array(path + "/gamma3", {n, 3, 3});
  const NumberArray gamma4 = file.read_array(path + "/gamma4", {n, n, 3, 3});
  using Row3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  for (long j = 0; j < n; ++j) {
    g.gamma2.emplace_back(Eigen::Map<const MatrixXd>(gamma2.data.data() + j * n * 3, 3, n));
    g.gamma3.emplace_back(Eigen::Map<const Row3>(gamma3.data.data() + j * 9));
    g.gamma4.emplace_back();
    for (long k = 0; k < n; ++k) {
      g.gamma4.back().emplace_back(Eigen::Map<const Row3>(gamma4.data.data() + (j * n + k) * 9));
    }
  }
  return g;
}

void write_flex_body(const FlexBody& body, const std::string& path) { write_flex_body(body, {}, path); }

void write_flex_body(const FlexBody& body, const BodyAccuracy& accuracy, const std::string& path) {
  FileWriter file(path, kFormat, body.third_order.empty() ? kFlexBodyFormatVersion : kThirdOrderFormatVersion);
  file.write_source(body.source);
  file.write_attribute("/", "name", body.name);
  file.write_attribute("/", "frame", std::string(body.is_free_free ? "free" : "fixed"));
  file.write_attribute("/", "dims",
                       std::string("M mass, L length, T time, E modal coordinate (M^1/2 L when the modes "
                                   "are mass-normalized); units are those of the model"));

  file.write_number("/rigid/mass", body.mass);
  file.write_vector("/rigid/cg", body.cg);
  file.write_matrix("/rigid/inertia", body.inertia);
  file.write_integers("/nodes/id", body.node_id);
  file.write_matrix("/nodes/xyz", body.node_id.empty() ? MatrixXd::Zero(0, 3) : body.node_xyz);
  file.write_integers("/nodes/interface", body.interface_nodes);

  file.write_vector("/modes/frequency_hz", body.frequency_hz);
  file.write_vector("/modes/eigenvalue", body.eigenvalue);
  write_mode_kinds(file, body.kind);
  write_mode_shapes(file, body.phi, body.num_modes());
  file.write_matrix("/modal/mass", body.modal_mass);
  file.write_matrix("/modal/stiffness", body.modal_stiffness);
  file.write_matrix("/modal/damping", body.modal_damping);
  if (accuracy.mass >= 0) {
    file.write_number("/accuracy/mass", accuracy.mass);
    file.write_number("/accuracy/stiffness", accuracy.stiffness);
  }
  file.write_matrix("/effective_mass", body.effective_mass);

  file.make_group("/integrals");
  file.write_attribute("/integrals", "method", body.integrals_method);
  if (!body.masses.empty()) file.write_attribute("/integrals", "masses", body.masses);
  write_integrals(file, "/integrals/lumped", body.lumped);
  write_integrals(file, "/integrals/consistent", body.consistent);
  write_integrals(file, "/integrals/exact", body.exact);

  if (body.F_I.size() > 0) {
    file.write_matrix("/inertial_loads/f", body.F_I);
    file.write_attribute("/inertial_loads/f", "loads", get_load_names());
  }
  if (body.dof_map.size() > 0) {
    file.write_integers("/dof_map", body.dof_map);
  }
  write_stiffening(file, body);
  write_preload(file, body);
  write_third_order(file, body);
  write_next_order(file, body.next_order);
  write_recovery(file, body);
  if (!body.strain_energy.empty()) {
    file.write_integers("/strain_energy/id", body.strain_energy.id);
    file.write_strings("/strain_energy/card", body.strain_energy.card);
    file.write_matrix("/strain_energy/matrix", body.strain_energy.matrix);
  }
  if (body.full_phi.size() > 0) {
    file.write_matrix("/full/phi", body.full_phi);
  }
  write_mesh(file, body.mesh);
  write_mesh_shapes(file, body);
  file.commit();
}

BodyAccuracy read_body_accuracy(const std::string& path) {
  FileReader file(path, kFormat, kFlexBodyFormatVersion);
  if (!file.has("/accuracy")) return {};
  return {file.read_number("/accuracy/mass"), file.read_number("/accuracy/stiffness")};
}

FlexBody read_flex_body(const std::string& path) {
  FileReader file(path, kFormat, kFlexBodyFormatVersion);
  FlexBody body;
  body.source = file.read_source();
  body.name = file.read_attribute("/", "name");
  body.is_free_free = file.read_attribute("/", "frame") == "free";
  body.mass = file.read_number("/rigid/mass");
  body.cg = file.read_vector("/rigid/cg");
  body.inertia = file.read_matrix("/rigid/inertia");
  body.node_id = file.read_integers("/nodes/id");
  const long p = body.num_nodes();
  body.node_xyz = file.read_matrix("/nodes/xyz");
  body.interface_nodes = file.read_integers("/nodes/interface");

  body.eigenvalue = file.read_vector("/modes/eigenvalue");
  const long n = body.num_modes();
  body.frequency_hz = file.read_vector("/modes/frequency_hz");
  body.kind = read_mode_kinds(file);
  body.phi = read_mode_shapes(file, p, n);
  body.modal_mass = file.read_matrix("/modal/mass");
  body.modal_stiffness = file.read_matrix("/modal/stiffness");
  body.modal_damping = file.read_matrix("/modal/damping");
  body.effective_mass = file.read_matrix("/effective_mass");

  read_method(file, body);
  body.lumped = read_integrals(file, "/integrals/lumped", n);
  body.consistent = read_integrals(file, "/integrals/consistent", n);
  body.exact = read_integrals(file, "/integrals/exact", n);

  const bool has_loads = file.has("/inertial_loads/f"), has_full = file.has("/full/phi");
  if (has_loads || has_full || file.has("/dof_map")) body.dof_map = file.read_integer_matrix("/dof_map");
  if (has_loads) body.F_I = file.read_matrix("/inertial_loads/f");
  if (has_full) body.full_phi = file.read_matrix("/full/phi");
  read_stiffening(file, body);
  read_preload(file, body);
  read_third_order(file, body);
  body.next_order = read_next_order(file, body.num_modes());
  read_recovery(file, body);
  if (file.has("/strain_energy/matrix")) {
    auto& energy = body.strain_energy;
    energy.id = file.read_integers("/strain_energy/id");
    const auto e = static_cast<long>(energy.id.size()), n = static_cast<long>(body.num_modes());
    energy.card = file.read_strings("/strain_energy/card");
    energy.matrix = file.read_matrix("/strain_energy/matrix", e, n * (n + 1) / 2);
  }
  body.mesh = read_mesh(file);
  if (file.has("/mesh/phi")) {
    const auto g = static_cast<long>(body.mesh.grid_id.size());
    const NumberArray shapes = file.read_array("/mesh/phi");
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    body.mesh_phi = Eigen::Map<const Rows>(shapes.data.data(), 3 * g, n).cast<float>();
  }
  const auto add = [&](const std::vector<std::string>& faults) {
    for (const auto& what : faults) file.error("hdf5.value", what, "correct the file, or write it again");
    file.throw_if_errors();
  };
  add(records::find_unknown_names(body));
  add(records::find_body_faults(body));
  return body;
}

}  // namespace bough::hdf5
