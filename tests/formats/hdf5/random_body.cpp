#include "tests/formats/hdf5/random_body.hpp"

#include <cmath>
#include <random>

namespace bough::test {

namespace {

using Eigen::MatrixXd;
using records::FlexBody;
using records::MassIntegrals;

class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  double next() { return distribution_(engine_); }
  MatrixXd make(Eigen::Index rows, Eigen::Index cols) {
    return MatrixXd::NullaryExpr(rows, cols, [&] { return next(); });
  }
  MatrixXd make_symmetric(Eigen::Index n) {
    const MatrixXd m = make(n, n);
    return m + m.transpose();
  }
  MatrixXd make_definite(Eigen::Index n) {
    const MatrixXd m = make(n, n);
    return MatrixXd(m * m.transpose()).selfadjointView<Eigen::Lower>();
  }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> distribution_{0, 1e3};
};

MassIntegrals make_integrals(Numbers& r, int n) {
  MassIntegrals g;
  g.gamma0 = r.make(3, n);
  g.gamma1 = r.make(3, n);
  for (int j = 0; j < n; ++j) {
    g.gamma2.push_back(r.make(3, n));
    g.gamma3.emplace_back(r.make(3, 3));
    g.gamma4.emplace_back();
    for (int k = 0; k < n; ++k) g.gamma4.back().emplace_back(r.make(3, 3));
  }
  return g;
}

records::BodyMesh make_mesh(Numbers& r, int p) {
  records::BodyMesh mesh;
  for (int k = 0; k < p; ++k) mesh.grid_id.push_back(1000 + 3 * k);
  mesh.grid_xyz = r.make(p, 3);
  // Out of alphabetical order and one type twice: the order has to survive.
  for (const char* type : {"quad4", "line2", "line2"}) {
    records::BodyMesh::Block block;
    block.type = type;
    const int count = p - 1 + static_cast<int>(mesh.blocks.size());  // another number of elements in each
    block.connectivity.resize(count, type[0] == 'q' ? 4 : 2);
    for (int e = 0; e < count; ++e) {
      block.element_id.push_back(10 * e + static_cast<int>(mesh.blocks.size()));
      for (int k = 0; k < block.connectivity.cols(); ++k) block.connectivity(e, k) = (e + k) % p;
    }
    mesh.blocks.push_back(block);
  }
  return mesh;
}

bool same(const MatrixXd& a, const MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && (a.array() == b.array()).all();
}
bool same(const std::vector<MatrixXd>& a, const std::vector<MatrixXd>& b) {
  bool ok = a.size() == b.size();
  for (std::size_t i = 0; ok && i < a.size(); ++i) ok = same(a[i], b[i]);
  return ok;
}
bool same(const MassIntegrals& a, const MassIntegrals& b) {
  return same(a.gamma0, b.gamma0) && same(a.gamma1, b.gamma1) && same(a.gamma2, b.gamma2) && a.gamma3 == b.gamma3 &&
         a.gamma4 == b.gamma4;
}
bool same(const records::BodyMesh& a, const records::BodyMesh& b) {
  bool ok = a.grid_id == b.grid_id && same(a.grid_xyz, b.grid_xyz) && a.blocks.size() == b.blocks.size();
  for (std::size_t i = 0; ok && i < a.blocks.size(); ++i) {
    ok = a.blocks[i].type == b.blocks[i].type && a.blocks[i].connectivity == b.blocks[i].connectivity &&
         a.blocks[i].element_id == b.blocks[i].element_id;
  }
  return ok;
}
bool same(const std::vector<records::Locator>& a, const std::vector<records::Locator>& b) {
  bool ok = a.size() == b.size();
  for (std::size_t i = 0; ok && i < a.size(); ++i) {
    ok = a[i].name == b[i].name && a[i].node == b[i].node && a[i].direction == b[i].direction;
  }
  return ok;
}

}  // namespace

FlexBody make_random_body(unsigned seed, int n, int p, bool full) {
  Numbers r(seed);
  FlexBody body;
  body.name = "bööm ≠ ascii";
  body.source = {{"deck.bdf", std::string(64, 'a')}, {"größe.toml", std::string(64, 'b')}};
  body.mass = std::abs(r.next());
  body.cg = r.make(3, 1);
  body.inertia = r.make_definite(3);
  body.inertia += body.mass * (body.cg.squaredNorm() * Eigen::Matrix3d::Identity() - body.cg * body.cg.transpose());
  for (int k = 0; k < p; ++k) body.node_id.push_back(7 * k + 1);
  body.node_xyz = r.make(p, 3);
  if (p > 1) body.interface_nodes = {8};
  body.is_free_free = full;
  body.frequency_hz = r.make(n, 1);
  body.eigenvalue = r.make(n, 1);
  for (int j = 0; j < n; ++j) body.kind.push_back(static_cast<records::ModeKind>(j % 3));
  for (int k = 0; k < p; ++k) body.phi.push_back(r.make(6, n));
  body.modal_mass = r.make_definite(n);
  body.modal_stiffness = r.make_symmetric(n);
  body.modal_damping = r.make(n, n);
  body.effective_mass = r.make(n, 6);
  body.exact = make_integrals(r, n);
  body.integrals_method = "exact";
  body.masses = "bodies";
  for (std::size_t i = 0; i < records::kNumInertialLoads; ++i) {
    body.kg_inertial_computed[i] = i % 2 == 0;
    body.kg_inertial[i] = i % 2 == 0 ? r.make_symmetric(n) : MatrixXd::Zero(n, n);
  }
  body.external_load = MatrixXd::Zero(n, 0);
  body.load_resultant = MatrixXd::Zero(6, 0);
  if (!full) return body;

  body.lumped = make_integrals(r, n);
  body.consistent = make_integrals(r, n);
  body.locators = {{"tip x", 8, 1}, {"tip y", 8, 2}, {"thrust", 0, 0}};
  for (int e = 0; e < 3; ++e) body.kg_external.push_back(r.make_symmetric(n));
  body.external_load = r.make(n, 3);
  body.load_resultant = r.make(6, 3);
  for (int e = 0; e < 3; ++e) body.load_moment.push_back(r.make(3, n));
  body.dof_map.resize(6 * p + 1, 2);
  for (int i = 0; i < 6 * p; ++i) body.dof_map.row(i) << body.node_id[static_cast<std::size_t>(i / 6)], i % 6 + 1;
  body.dof_map.row(6 * p) << 99999, 0;
  body.F_I = r.make(6 * p + 1, 12);
  body.full_phi = r.make(6 * p + 1, n);
  body.mesh = make_mesh(r, p);
  body.mesh_phi = r.make(3 * static_cast<int>(body.mesh.grid_id.size()), n).cast<float>();
  body.preload = "spin (0, 0, 5)";
  body.kg_preload = r.make(n, n);
  body.preload_A_I = r.make(12, 1);
  return body;
}

records::ModesResult make_random_modes(unsigned seed, int n, int p) {
  Numbers r(seed);
  records::ModesResult modes;
  modes.source = {{"deck.bdf", std::string(64, 'c')}};
  modes.subcase = 3;
  modes.mass_properties.mass = r.next();
  modes.mass_properties.cg = r.make(3, 1);
  modes.mass_properties.inertia = r.make(3, 3);
  modes.mass_properties.reference = r.make(3, 1);
  modes.mass_properties.rigid_mass = r.make(6, 6);
  for (int k = 0; k < p; ++k) modes.node_id.push_back(k + 1);
  modes.node_xyz = r.make(p, 3);
  modes.eigenvalue = r.make(n, 1);
  modes.frequency_hz = r.make(n, 1);
  modes.kind.assign(static_cast<std::size_t>(n), records::ModeKind::Normal);
  modes.residual = r.make(n, 1);
  modes.num_rigid_modes = 6;
  modes.inertia_count = n;
  for (int k = 0; k < p; ++k) modes.phi.push_back(r.make(6, n));
  modes.modal_mass = r.make(n, 1);
  modes.effective_mass = r.make(n, 6);
  modes.load_factor = r.make(n, 1);
  modes.mesh = make_mesh(r, p);
  return modes;
}

bool are_identical(const FlexBody& a, const FlexBody& b) {
  bool ok =
      a.name == b.name && a.preload == b.preload && same(a.kg_preload, b.kg_preload) &&
      same(a.preload_A_I, b.preload_A_I) && a.source == b.source && a.mass == b.mass && a.cg == b.cg &&
      a.inertia == b.inertia && a.node_id == b.node_id && same(a.node_xyz, b.node_xyz) &&
      a.interface_nodes == b.interface_nodes && a.is_free_free == b.is_free_free &&
      same(a.frequency_hz, b.frequency_hz) && same(a.eigenvalue, b.eigenvalue) && a.kind == b.kind &&
      same(a.phi, b.phi) && same(a.modal_mass, b.modal_mass) && same(a.modal_stiffness, b.modal_stiffness) &&
      same(a.modal_damping, b.modal_damping) && same(a.effective_mass, b.effective_mass) && same(a.lumped, b.lumped) &&
      same(a.consistent, b.consistent) && same(a.exact, b.exact) && a.integrals_method == b.integrals_method &&
      a.masses == b.masses && same(a.F_I, b.F_I) && a.dof_map.rows() == b.dof_map.rows() && a.dof_map == b.dof_map &&
      a.kg_inertial_computed == b.kg_inertial_computed && same(a.locators, b.locators) &&
      same(a.kg_external, b.kg_external) && same(a.external_load, b.external_load) &&
      same(a.load_resultant, b.load_resultant) && same(a.load_moment, b.load_moment) && same(a.full_phi, b.full_phi) &&
      same(a.mesh, b.mesh) && same(a.mesh_phi.cast<double>(), b.mesh_phi.cast<double>());
  for (std::size_t i = 0; ok && i < records::kNumInertialLoads; ++i) ok = same(a.kg_inertial[i], b.kg_inertial[i]);
  return ok;
}

bool are_identical(const records::ModesResult& a, const records::ModesResult& b) {
  const auto &x = a.mass_properties, &y = b.mass_properties;
  return a.source == b.source && a.subcase == b.subcase && x.mass == y.mass && x.cg == y.cg && x.inertia == y.inertia &&
         x.reference == y.reference && x.rigid_mass == y.rigid_mass && a.node_id == b.node_id &&
         same(a.node_xyz, b.node_xyz) && same(a.eigenvalue, b.eigenvalue) && same(a.frequency_hz, b.frequency_hz) &&
         a.kind == b.kind && same(a.residual, b.residual) && a.num_rigid_modes == b.num_rigid_modes &&
         a.inertia_count == b.inertia_count && same(a.phi, b.phi) && same(a.modal_mass, b.modal_mass) &&
         same(a.effective_mass, b.effective_mass) && same(a.load_factor, b.load_factor) && same(a.mesh, b.mesh);
}

}  // namespace bough::test
