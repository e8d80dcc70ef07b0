#include "fe/statics/element_results.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "fe/statics/element_recovery.hpp"

namespace bough::fe {

MatrixXd calc_internal_forces(const Element& element, const Eigen::Ref<const MatrixXd>& U_g) {
  const StressState* state = element.stress_state();
  if (!state) return MatrixXd(0, U_g.cols());
  MatrixXd forces = MatrixXd::Zero(state->num_internal_forces(), U_g.cols());
  state->calc_internal_forces_of(U_g(element.gdofs(), Eigen::all), forces);
  return forces;
}

std::vector<records::ElementForces> calc_element_forces(const Model& model, const VectorXd& u_g,
                                                        const records::Deck& deck, int load, Diagnostics& diagnostics,
                                                        const InitialForces& initial) {
  return recover_elements(model, deck, {{&u_g, load, &initial, &diagnostics}}, {true, false, false}).front().forces;
}

std::vector<records::ElementStresses> calc_element_stresses(const Model& model, const VectorXd& u_g,
                                                            const records::Deck& deck, int load,
                                                            const InitialForces& initial) {
  return recover_elements(model, deck, {{&u_g, load, &initial, nullptr}}, {false, true, false}).front().stresses;
}

std::vector<records::ElementStresses> calc_element_strains(const Model& model, const VectorXd& u_g,
                                                           const records::Deck& deck, int load,
                                                           const InitialForces& initial) {
  return recover_elements(model, deck, {{&u_g, load, &initial, nullptr}}, {false, false, true}).front().strains;
}

std::vector<records::GridForce> calc_grid_forces(const Model& model, const records::StaticSubcase& solved,
                                                 const InitialForces& initial, const std::vector<int>& grids) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  const std::set<int> requested(grids.begin(), grids.end());
  std::map<int, std::vector<records::GridForce>> of;  // by node index
  for (std::size_t k = 0; k < model.nodes().size(); ++k) {
    const Node& node = model.nodes()[k];
    if (node.num_dofs == 6 && (requested.empty() || requested.contains(node.id))) of[static_cast<int>(k)];
  }
  MatrixXd K;
  for (const auto& element : model.elements()) {
    const auto& nodes = element->nodes();
    if (std::none_of(nodes.begin(), nodes.end(), [&](int n) { return of.contains(n); })) continue;
    const auto& gdofs = element->gdofs();
    K.setZero(element->num_dofs(), element->num_dofs());
    model.add_stiffness(*element, K);
    const auto* heated = initial.find(*element);
    if (K.isZero(0) && !heated) continue;
    VectorXd force = -K * solved.displacement(gdofs);
    if (heated) force += heated->load;
    std::map<int, Vector6d> at;
    for (std::size_t i = 0; i < gdofs.size(); ++i)
      for (const int n : nodes) {
        const int component = gdofs[i] - model.node(n).first_gdof;
        if (component < 0 || component >= 6 || !of.contains(n)) continue;
        at.try_emplace(n, Vector6d::Zero()).first->second[component] += force[static_cast<Eigen::Index>(i)];
        break;
      }
    for (const auto& [n, f] : at) of[n].push_back({model.node(n).id, element->card(), element->id(), f});
  }
  VectorXd load = solved.load;
  if (!initial.of.empty()) load -= sum_loads(model, initial);
  const std::pair<const char*, const VectorXd*> others[] = {
      {"LOAD", &load}, {"SPC", &solved.reaction}, {"MPC", &solved.mpc_force}, {"INERTIA", &solved.inertia}};
  std::vector<records::GridForce> result;
  for (auto& [n, forces] : of) {
    const Node& node = model.node(n);
    double size = 0;
    for (const auto& f : forces) size = std::max(size, f.force.cwiseAbs().maxCoeff());
    for (const auto& [name, values] : others) {
      if (values->size() == 0) continue;
      const Vector6d f = values->segment<6>(node.first_gdof);
      // Round-off of a sum that vanishes is no force.
      if (f.cwiseAbs().maxCoeff() > 1e-9 * size) forces.push_back({node.id, name, 0, f});
    }
    result.insert(result.end(), forces.begin(), forces.end());
  }
  return result;
}

}  // namespace bough::fe
