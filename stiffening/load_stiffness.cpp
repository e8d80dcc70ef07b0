// Static solutions of the loads of a body, its geometric stiffness K_G1, K_G2, K_G0.
#include <set>

#include "base/rotation.hpp"
#include "fe/elements/stress_state.hpp"
#include "fe/linear/blas.hpp"
#include "fe/linear/products.hpp"
#include "stiffening/stages.hpp"

namespace bough::stiffening {

using records::FlexBody;

namespace {

/// The inertial loads of the body file, ascending; all without such.
std::vector<int> list_inertial_loads(const records::BodySpec& spec) {
  std::set<int> chosen;
  for (const auto load : spec.inertial_loads) chosen.insert(static_cast<int>(load));
  for (int i = 0; i < records::kNumInertialLoads && spec.inertial_loads.empty(); ++i) chosen.insert(i);
  return {chosen.begin(), chosen.end()};
}

MatrixXd gather_forces(const std::vector<LoadPattern>& patterns, Eigen::Index num_gdofs) {
  MatrixXd F(num_gdofs, static_cast<Eigen::Index>(patterns.size()));
  for (std::size_t e = 0; e < patterns.size(); ++e) F.col(static_cast<Eigen::Index>(e)) = patterns[e].load.F;
  return F;
}

/// K_G of the internal forces of heated elements at u = 0, which the static solution does not contain.
void add_thermal_stiffness(const fe::Model& model, const fe::InitialForces& initial, const MatrixXd& Phi,
                           MatrixXd& K_G) {
  MatrixXd K, sum = MatrixXd::Zero(Phi.cols(), Phi.cols());
  for (const auto& element : model.elements()) {
    const auto* part = initial.find(*element);
    if (!part || part->force.size() == 0) continue;
    K.setZero(element->num_dofs(), element->num_dofs());
    element->stress_state()->add_geometric_stiffness(part->force, 1, K);
    const MatrixXd Phi_e = Phi(element->gdofs(), Eigen::all);
    sum += Phi_e.transpose() * K * Phi_e;
  }
  K_G += linear::symmetrize(sum);
}

}  // namespace

void set_loads(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi,
               const std::vector<LoadPattern>& patterns, FlexBody& body) {
  body.interface_nodes = list_interface_nodes(request.spec);
  for (const auto& pattern : patterns) body.locators.push_back(pattern.locator);
  const MatrixXd F = gather_forces(patterns, model.num_gdofs());
  body.external_load = linear::calc_inner_products(Phi, F);
  // Φ_Rᵀ F, and Σ φ_kj × f_k by which mode j shifts its moment.
  body.load_resultant = linear::calc_inner_products(model.calc_rigid_modes(), F);
  body.load_moment.assign(patterns.size(), MatrixXd::Zero(3, Phi.cols()));
  for (Eigen::Index e = 0; e < F.cols(); ++e)
    for (const auto& node : model.nodes()) {
      if (node.num_dofs != 6) continue;
      const Eigen::Vector3d f = F.block<3, 1>(node.first_gdof, e);
      if (f.isZero(0)) continue;
      body.load_moment[static_cast<std::size_t>(e)] -= skew(f) * Phi.middleRows<3>(node.first_gdof);
    }
}

SolvedLoads solve_loads(const BodyRequest& request, const std::vector<LoadPattern>& patterns, const MatrixXd& F_I,
                        const StaticSupport& support) {
  SolvedLoads solved;
  solved.inertial = list_inertial_loads(request.spec);
  const auto num_inertial = solved.num_inertial();
  const auto num_loads = num_inertial + static_cast<Eigen::Index>(patterns.size());
  auto& columns = solved.columns;
  columns.F.resize(F_I.rows(), num_loads);
  columns.F << F_I(Eigen::all, solved.inertial), gather_forces(patterns, F_I.rows());
  columns.A_I = MatrixXd::Zero(records::kNumInertialLoads, num_loads);
  for (Eigen::Index c = 0; c < num_inertial; ++c) columns.A_I(solved.inertial[static_cast<std::size_t>(c)], c) = 1;
  columns.arms.resize(solved.inertial.size());
  columns.followers.resize(solved.inertial.size());
  for (std::size_t e = 0; e < patterns.size(); ++e) {
    const auto& load = patterns[e].load;
    columns.A_I.col(num_inertial + static_cast<Eigen::Index>(e)) = load.A_I;
    columns.arms.push_back(load.arms);
    columns.followers.push_back(load.followers);
  }
  solved.U = support.solve(columns.F);
  return solved;
}

void set_geometric_stiffness(const fe::Model& model, const MatrixXd& Phi, const std::vector<LoadPattern>& patterns,
                             const SolvedLoads& solved, FlexBody& body) {
  auto K_G = calc_generalized_geometric_stiffness(model, solved.columns, solved.U, Phi);
  body.kg_inertial.fill(MatrixXd::Zero(Phi.cols(), Phi.cols()));
  body.kg_inertial_computed.fill(false);
  for (std::size_t c = 0; c < solved.inertial.size(); ++c) {
    const auto i = static_cast<std::size_t>(solved.inertial[c]);
    body.kg_inertial[i] = std::move(K_G[c]);
    body.kg_inertial_computed[i] = true;
  }
  const auto first = K_G.begin() + solved.num_inertial();
  for (std::size_t e = 0; e < patterns.size(); ++e)
    if (!patterns[e].initial.of.empty())
      add_thermal_stiffness(model, patterns[e].initial, Phi, *(first + static_cast<std::ptrdiff_t>(e)));
  body.kg_external.assign(std::make_move_iterator(first), std::make_move_iterator(K_G.end()));
}

void set_preload(const BodyRequest& request, const fe::Model& model, const MatrixXd& Phi, FlexBody& body) {
  const auto* prestress = model.prestress();
  if (!prestress) return;
  const MatrixXd K = Phi.transpose() * fe::calc_prestress_times(model, Phi);
  body.kg_preload = linear::symmetrize(K);
  body.preload_A_I = prestress->A_I;
  for (std::size_t i = 0; i < body.kg_inertial.size(); ++i)
    if (prestress->A_I[static_cast<Eigen::Index>(i)] != 0 && !body.kg_inertial_computed[i]) {
      request.diagnostics.error("reduce.bad-preload", prestress->at,
                                "the preload, " + prestress->name +
                                    ", contains a spin or acceleration whose stiffening is left out of the body",
                                "leave [body.stiffening] inertial at \"all\": the motion that made the preload is not "
                                "to count twice");
      request.diagnostics.throw_if_errors();
    }
}

}  // namespace bough::stiffening
