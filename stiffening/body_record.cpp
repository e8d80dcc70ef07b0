// The parts of a flexible body that need no loads: mass, nodes, mass integrals, strain energy.
#include <set>
#include <string>

#include "fe/matrices/mass_directions.hpp"
#include "fe/model/element_loop.hpp"
#include "modal/integrals.hpp"
#include "modal/strained_integrals.hpp"
#include "stiffening/given_model.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

using records::BodyFrame;
using records::FlexBody;

namespace {

constexpr double kMomentRoundoff = 1e-9;  // of the largest

/// Principal moments of inertia about the centre of mass, ascending.
Eigen::Vector3d calc_principal_moments(const FlexBody& body) {
  const Eigen::Vector3d& c = body.cg;
  const Eigen::Matrix3d about_cg =
      body.inertia - body.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(about_cg, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace

FlexBody make_rigid_body(const BodyRequest& request, const fe::Model& model) {
  const auto properties = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero());
  FlexBody body;
  body.name = request.spec.name;
  if (model.prestress()) body.preload = model.prestress()->name;
  body.mass = properties.mass;
  body.cg = properties.cg;
  body.inertia = properties.inertia;
  if (!(body.mass > 0)) {
    request.error("reduce.no-mass", "the translations of the grids carry no mass: this is no body",
                  "give RHO, NSM or CONM2 cards; scalar points and CMASS between them are in no place");
    request.diagnostics.throw_if_errors();
  }
  if (fe::calc_mass_difference(properties.rigid_mass) > fe::kMassDifference) {
    SourceLocation at = request.where();
    const auto masses = fe::describe_mass(model, request.deck, properties.rigid_mass, at);
    const Eigen::Vector3d moments = calc_principal_moments(body);
    const bool is_no_body =
        moments(0) + moments(1) < (1 - kMomentRoundoff) * moments(2) || moments(0) < -kMomentRoundoff * moments(2);
    request.diagnostics.warning(
        "reduce.mass-by-direction", at,
        masses +
            ": a rigid body has one; the body gets their mean, by which gravity, joints and "
            "forces move it" +
            (is_no_body ? "; no body has the moments of inertia that are left: run rejects it" : ""),
        "give CONM2, or CMASS of one value in all three translations of one grid, unless only "
        "the modes matter");
  }
  body.is_free_free =
      request.is_free() && request.spec.frame != BodyFrame::Node && request.spec.frame != BodyFrame::ThreeNodes;
  return body;
}

void set_nodes(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi, FlexBody& body) {
  std::set<int> seen;
  const auto add = [&](int id) {
    if (seen.insert(id).second) body.node_id.push_back(id);
  };
  for (const int id : request.spec.output_nodes) add(id);
  if (request.spec.output_nodes.empty())
    for (const auto& node : model.nodes())
      if (node.num_dofs == 6) add(node.id);
  for (const int id : request.spec.interface_nodes) add(id);
  body.node_xyz.resize(static_cast<Eigen::Index>(body.node_id.size()), 3);
  for (std::size_t k = 0; k < body.node_id.size(); ++k) {
    const auto& node = model.node(model.find_node(body.node_id[k]));
    body.node_xyz.row(static_cast<Eigen::Index>(k)) = node.x.transpose();
    MatrixXd& phi = body.phi.emplace_back(Phi.middleRows(node.first_gdof, 6));
    if (lacks_rotation(model, node)) phi.bottomRows<3>().setZero();
  }
  body.mesh = model.calc_mesh();
  body.dof_map = model.calc_dof_map();
  if (request.spec.full)
    body.full_phi = Phi;
  else
    body.set_mesh_shapes(Phi);
}

/// M as an assembled matrix: many products are cheaper so than element by element.
InertialLoads calc_body_inertial_loads(const fe::Model& model) {
  const auto kind = model.mass_kind();
  InertialLoads loads{fe::assemble_mass(model, fe::DofSet::Global, kind), {}};
  loads.F_I = fe::calc_inertial_loads(model, kind, MatrixXd::Identity(12, 12),
                                      [&](const MatrixXd& X) { return linear::multiply(loads.M, X); });
  return loads;
}

void set_integrals(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi, const InertialLoads& loads,
                   FlexBody& body, const MatrixXd& strain) {
  const auto kind = model.mass_kind();
  const bool is_lumped = kind == fe::MassKind::Lumped, is_approximate = fe::has_approximate_mass(model, kind);
  const auto mass_times = [&](const MatrixXd& X) { return linear::multiply(loads.M, X); };
  body.exact = strain.cols() == 0 ? modal::calc_exact_integrals(model, kind, Phi)
                                  : modal::calc_strained_integrals(model, kind, Phi, strain);
  body.masses = is_approximate ? "nodal momenta" : "bodies";
  if (is_approximate)
    request.warning("reduce.inertia-approximated",
                    "part of the mass matrix is not that of bodies on single grids: the loads of spin, the "
                    "exact integrals and the stiffening by carried mass take its nodal momenta instead",
                    "reduce the deck itself, or give a lumped mass matrix");
  (is_lumped ? body.lumped : body.consistent) =
      is_lumped && !is_approximate
          ? body.exact
          : modal::calc_momentum_integrals(modal::NodalDofs::from_model(model), mass_times, Phi);
  (is_lumped ? body.consistent : body.lumped) =
      modal::calc_named_integrals(model, is_lumped ? fe::MassKind::Consistent : fe::MassKind::Lumped, Phi);
  if (request.given) (request.given->is_lumped ? body.consistent : body.lumped) = {};
  body.integrals_method = request.spec.integrals;
  body.effective_mass = modal::calc_effective_mass(model, Phi, mass_times(Phi));
  body.F_I = loads.F_I;
}

/// φᵀ K_e φ of each element that has stiffness, without K_G0 of a preload.
void set_strain_energy(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi, FlexBody& body) {
  if (!request.spec.strain_energy) return;
  request.report("strain energy of elements");
  const auto n = Phi.cols();
  const auto& elements = model.elements();
  MatrixXd all = MatrixXd::Zero(static_cast<Eigen::Index>(elements.size()), n * (n + 1) / 2), K, u;
  MatrixXd is_stiff = MatrixXd::Zero(all.rows(), 1);
  fe::visit_elements(model, fe::get_own_elements(model), [&](int e, const fe::Element& element) {
    K.setZero(element.num_dofs(), element.num_dofs());
    element.add_stiffness(1, K);
    if (K.isZero(0)) return;
    is_stiff(e, 0) = 1;
    u = Phi(element.gdofs(), Eigen::all);
    const MatrixXd k = u.transpose() * K * u;
    for (Eigen::Index i = 0, column = 0; i < n; ++i)
      for (Eigen::Index j = i; j < n; ++j) all(e, column++) = 0.5 * (k(i, j) + k(j, i));
  });
  linear::sum_over_ranks(all);
  linear::sum_over_ranks(is_stiff);
  auto& energy = body.strain_energy;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index e = 0; e < all.rows(); ++e) {
    if (is_stiff(e, 0) == 0) continue;
    rows.push_back(e);
    energy.id.push_back(elements[static_cast<std::size_t>(e)]->id());
    energy.card.emplace_back(elements[static_cast<std::size_t>(e)]->card());
  }
  energy.matrix = all(rows, Eigen::all);
}

}  // namespace bough::stiffening
