#include "fe/statics/element_results.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "fe/cards/element_properties.hpp"
#include "fe/elements/beam.hpp"
#include "fe/loads/load_sets.hpp"

namespace bough::fe {

MatrixXd calc_internal_forces(const Element& element, const Eigen::Ref<const MatrixXd>& U_g) {
  MatrixXd forces = MatrixXd::Zero(element.num_internal_forces(), U_g.cols());
  VectorXd u(element.num_dofs());
  for (Eigen::Index c = 0; c < U_g.cols(); ++c) {
    for (int i = 0; i < u.size(); ++i) u[i] = U_g(element.gdofs()[static_cast<std::size_t>(i)], c);
    element.calc_internal_forces(u, forces.col(c));
  }
  return forces;
}

namespace {

/// What elements give at their points: stresses or strains of internal forces.
struct PointResult {
  bool of_strain = false;

  std::vector<StressPoint> list_points(const Element& element) const {
    return of_strain ? element.strain_points() : element.stress_points();
  }
  std::vector<std::string> list_names(const std::vector<StressPoint>& points) const {
    return of_strain ? list_strain_result_names(points) : list_result_names(points);
  }
  VectorXd calc(const Element& element, const VectorXd& forces, const InitialForces::Part* heated) const {
    VectorXd values = of_strain ? element.calc_strains(forces) : element.calc_stresses(forces);
    if (heated) add(of_strain ? heated->strain : heated->stress, values);
    const auto points = list_points(element);
    return of_strain ? calc_strain_results(points, values) : calc_stress_results(points, values);
  }
  VectorXd calc_corners(const Element& element, const VectorXd& forces, const InitialForces::Part* heated) const {
    if (!of_strain) return {};
    VectorXd values = element.calc_corner_strains(forces);
    if (heated) add(heated->corner_strain, values);
    return values;
  }

 private:
  static void add(const VectorXd& more, VectorXd& values) {
    if (more.size() > 0) values += more;
  }
};

std::vector<records::ElementStresses> calc_point_results(const Model& model, const VectorXd& u_g,
                                                         const records::Deck& deck, int load,
                                                         const InitialForces& initial, const PointResult& kind) {
  BOUGH_DEMAND(u_g.size() == model.num_gdofs());
  Diagnostics said;  // by calc_element_forces
  std::unordered_map<int, VectorXd> end_loads;
  if (load > 0) end_loads = calc_beam_end_loads(model, deck, load, said);
  const auto properties = list_element_properties(deck);
  std::map<std::pair<std::string, std::vector<std::string>>, std::vector<int>> groups;
  const auto& elements = model.elements();
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (const auto points = kind.list_points(*elements[e]); !points.empty())
      groups[{elements[e]->card(), kind.list_names(points)}].push_back(static_cast<int>(e));
  const auto [begin, end] = calc_element_range(model);
  std::vector<records::ElementStresses> result;
  std::map<std::string, int> count;
  for (const auto& [key, members] : groups) {
    auto& block = result.emplace_back();
    const int number = ++count[key.first];
    block.card = number == 1 ? key.first : key.first + "-" + std::to_string(number);
    block.components = key.second;
    const auto rows = static_cast<Eigen::Index>(members.size());
    const Element& first = *elements[static_cast<std::size_t>(members.front())];
    block.stress = MatrixXd::Zero(rows, static_cast<Eigen::Index>(key.second.size()));
    block.corner = MatrixXd::Zero(
        rows, kind.calc_corners(first, VectorXd::Zero(first.num_internal_forces()), nullptr).size());
    for (Eigen::Index r = 0; r < rows; ++r) {
      const int e = members[static_cast<std::size_t>(r)];
      const Element& element = *elements[static_cast<std::size_t>(e)];
      block.id.push_back(element.id());
      const auto property = properties.find(element.id());
      block.property.push_back(property == properties.end() ? 0 : property->second);
      if (e < begin || e >= end) continue;
      MatrixXd forces = calc_internal_forces(element, u_g);
      const auto* heated = initial.find(element);
      if (heated) forces.col(0) += heated->force;
      if (const auto own = end_loads.find(e); own != end_loads.end())
        element.as_beam()->add_load_forces(own->second, forces.col(0));
      block.stress.row(r) = kind.calc(element, forces, heated).transpose();
      if (block.corner.cols() > 0) block.corner.row(r) = kind.calc_corners(element, forces, heated).transpose();
    }
    sum_over_ranks(block.stress);
    if (block.corner.cols() > 0) sum_over_ranks(block.corner);
  }
  return result;
}

}  // namespace

std::vector<records::ElementStresses> calc_element_stresses(const Model& model, const VectorXd& u_g,
                                                            const records::Deck& deck, int load,
                                                            const InitialForces& initial) {
  return calc_point_results(model, u_g, deck, load, initial, {});
}

std::vector<records::ElementStresses> calc_element_strains(const Model& model, const VectorXd& u_g,
                                                           const records::Deck& deck, int load,
                                                           const InitialForces& initial) {
  return calc_point_results(model, u_g, deck, load, initial, {true});
}

std::vector<records::GridForce> calc_grid_forces(const Model& model, const records::StaticSubcase& solved,
                                                 const InitialForces& initial, const std::vector<int>& grids) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  const std::set<int> wanted(grids.begin(), grids.end());
  std::map<int, std::vector<records::GridForce>> of;  // by node index
  for (std::size_t k = 0; k < model.nodes().size(); ++k) {
    const Node& node = model.nodes()[k];
    if (node.num_dofs == 6 && (wanted.empty() || wanted.contains(node.id))) of[static_cast<int>(k)];
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
      // What is left of a sum that vanishes is no force.
      if (f.cwiseAbs().maxCoeff() > 1e-9 * size) forces.push_back({node.id, name, 0, f});
    }
    result.insert(result.end(), forces.begin(), forces.end());
  }
  return result;
}

}  // namespace bough::fe
