#include <numbers>

#include "base/diagnostic.hpp"
#include "formats/flx/flx_file.hpp"
#include "formats/flx/special_nodes.hpp"

namespace bough::flx {

namespace {

/// Mass integrals with all tables that the solver requires; those that modopt left out are zero.
records::MassIntegrals complete(records::MassIntegrals g, int n) {
  const auto count = static_cast<std::size_t>(n);
  if (g.gamma2.empty()) g.gamma2.assign(count, MatrixXd::Zero(3, n));
  if (g.gamma3.empty()) g.gamma3.assign(count, records::Matrix3d::Zero());
  if (g.gamma4.empty()) g.gamma4.assign(count, std::vector<records::Matrix3d>(count, records::Matrix3d::Zero()));
  return g;
}

void set_stiffening(const FlxFile& file, records::FlexBody& body) {
  const auto& more = file.more;
  body.interface_nodes = more.interface_nodes;
  body.kg_inertial = more.kg_inertial;
  body.kg_inertial_computed = more.kg_inertial_computed;
  body.locators = more.locators;
  body.kg_external = more.kg_external;
  body.external_load = more.external_load;
  body.load_resultant = more.load_resultant;
  body.load_moment = more.load_moment;
  body.preload = more.preload;
  body.kg_preload = more.kg_preload;
  body.preload_A_I = more.preload_A_I;
}

}  // namespace

records::FlexBody make_flex_body(const FlxFile& file, std::vector<std::string>& lacking) {
  const int n = file.num_modes();
  records::FlexBody body;
  body.name = file.name;
  body.mass = file.mass;
  body.node_id = file.node_id;
  body.node_xyz = file.node_xyz;
  body.phi = file.gains;
  body.modal_mass = file.M;
  body.modal_stiffness = file.K;
  body.modal_damping = file.D;
  body.eigenvalue = records::VectorXd::Zero(n);
  for (int j = 0; j < n; ++j)
    if (file.M(j, j) > 0) body.eigenvalue[j] = file.K(j, j) / file.M(j, j);
  body.frequency_hz = body.eigenvalue.cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  body.kind.assign(static_cast<std::size_t>(n), records::ModeKind::Normal);
  if (file.has_rigid) {
    body.cg = file.more.cg;
    body.inertia = file.more.inertia;
    body.is_free_free = file.more.is_free_free;
    body.kind = file.more.kind;
  }
  body.integrals_method = file.method;
  auto& set = file.method == "lumped" ? body.lumped : file.method == "consistent" ? body.consistent : body.exact;
  if (&set == &body.exact) body.integrals_method = "exact";
  set = complete(file.integrals, n);
  body.effective_mass.resize(n, 6);
  for (int j = 0; j < n; ++j) {
    body.effective_mass.row(j) << set.gamma0.col(j).transpose(), set.gamma1.col(j).transpose();
    body.effective_mass.row(j) = body.effective_mass.row(j).cwiseAbs2() / (file.M(j, j) > 0 ? file.M(j, j) : 1);
  }
  for (auto& K_G : body.kg_inertial) K_G.setZero(n, n);
  body.external_load.setZero(n, 0);
  body.load_resultant.setZero(6, 0);
  if (file.has_stiffening) set_stiffening(file, body);
  body.mesh.grid_id = file.node_id;
  body.mesh.grid_xyz = file.node_xyz;

  lacking = {"elements to draw", "inertial loads of the dofs", "other sets of integrals"};
  if (!file.has_stiffening) lacking.insert(lacking.begin(), "geometric stiffness (flx --stiffening writes it)");
  if (file.modopt == 1) lacking.insert(lacking.begin(), "integrals of second order, which count as zero");
  if (file.modopt == 2) lacking.insert(lacking.begin(), "integrals of first and second order, which count as zero");
  return body;
}

void add_special_nodes(const FlxFile& file, records::FlexBody& body) {
  const auto first = static_cast<Eigen::Index>(body.node_id.size());
  body.node_id.insert(body.node_id.end(), file.special_id.begin(), file.special_id.end());
  body.phi.insert(body.phi.end(), file.special_gains.begin(), file.special_gains.end());
  body.node_xyz.conservativeResize(static_cast<Eigen::Index>(body.node_id.size()), 3);
  body.node_xyz.bottomRows(body.node_xyz.rows() - first).setZero();
}

}  // namespace bough::flx
