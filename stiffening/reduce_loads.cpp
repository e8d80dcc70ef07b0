#include "stiffening/reduction.hpp"

#include <algorithm>
#include <set>

#include "base/rotation.hpp"
#include "fe/linear/blas.hpp"
#include "fe/statics/static_case.hpp"

namespace bough::stiffening {

using modal::bases::StaticSolve;
using records::BodyFrame;

namespace {
constexpr const char* kDirections[] = {"x", "y", "z", "rx", "ry", "rz"};
}

/// A locator for each translation and rotation of the interface nodes and each load of the body file; set_stiffening
/// leaves out the moments at interface nodes that act on nothing (grids of solids).
void Reduction::make_loads(const fe::Model& model) {
  for (const int id : spec_.interface_nodes)
    if (std::find(body_.interface_nodes.begin(), body_.interface_nodes.end(), id) == body_.interface_nodes.end())
      body_.interface_nodes.push_back(id);
  const auto add_unit = [&](const std::string& group, const std::string& name, int id, int direction) {
    const auto& node = model.node(model.find_node(id));
    BodyLoad& load = loads_.emplace_back();
    load.group = group;
    load.locator = {name, id, direction};
    load.load.F = VectorXd::Unit(model.num_gdofs(), node.first_gdof + direction - 1);
  };
  for (const int id : body_.interface_nodes)
    for (int d = 1; d <= (spec_.interface_moments ? 6 : 3); ++d)
      add_unit("", "node" + std::to_string(id) + "_" + kDirections[d - 1], id, d);
  if (spec_.interface_moments) report_partial_rotation(model);
  for (std::size_t i = 0; i < spec_.loads.size(); ++i) {
    const auto& load = spec_.loads[i];
    const std::string name = load.name.empty() ? "load" + std::to_string(i + 1) : load.name;
    if (load.load_set > 0 || load.temperature_set > 0) {
      BodyLoad& pattern = loads_.emplace_back();
      pattern.group = pattern.locator.name = name;
      records::Subcase sets;
      sets.load = pattern.load_set = load.load_set;
      sets.temperature = load.temperature_set;
      auto both = fe::calc_static_load(model, deck_, sets, diagnostics_);
      pattern.initial = std::move(both.initial);
      pattern.load = std::move(both);
      demand_effect(model, name, pattern.load.F);
      continue;
    }
    for (const int d : load.directions) {
      add_unit(name, load.directions.size() == 1 ? name : name + "_" + kDirections[d - 1], load.node, d);
      demand_effect(model, name, loads_.back().load.F);
    }
  }
  diagnostics_.throw_if_errors();
}

/// A load that a body is asked for must act on it.
void Reduction::demand_effect(const fe::Model& model, const std::string& name, const Eigen::VectorXd& F) {
  const auto lost = fe::list_lost_loads(model, F);
  if (lost.empty()) return;
  diagnostics_.error("reduce.load-on-nothing", where(),
                     "load '" + name + "' acts on what has no stiffness: " + lost.front(),
                     "tie the grid by an RBE2 or RBE3 to grids that carry the load");
}

/// Grids that turn about some axes only (membranes, bars without one of their stiffnesses) are named: what hangs on
/// them is not carried about the others.
void Reduction::report_partial_rotation(const fe::Model& model) {
  for (const int id : body_.interface_nodes) {
    if (lacks_rotation(model, model.node(model.find_node(id)))) continue;
    std::string axes;
    for (const auto& entry : model.autospc())
      if (entry.node == id && entry.component > 3) axes += std::to_string(entry.component);
    if (!axes.empty())
      diagnostics_.warning("reduce.partial-rotation", where(),
                           "interface grid " + std::to_string(id) + " has no stiffness in component(s) " + axes +
                               ": a hinge or moment there finds none either",
                           "tie it by an RBE2 or RBE3 to other grids, or see that nothing turns it so");
  }
}

/// What each external load does to the body as a whole: Φ_Rᵀ F, and Σ φ_kj × f_k by which mode j shifts its moment.
void Reduction::set_resultants(const fe::Model& model, const MatrixXd& F_ext) {
  body_.load_resultant = fe::calc_inner_products(model.calc_rigid_modes(), F_ext);
  body_.load_moment.assign(static_cast<std::size_t>(F_ext.cols()), MatrixXd::Zero(3, Phi_.cols()));
  for (Eigen::Index e = 0; e < F_ext.cols(); ++e) {
    for (const auto& node : model.nodes()) {
      if (node.num_dofs != 6) continue;
      const Eigen::Vector3d f = F_ext.block<3, 1>(node.first_gdof, e);
      if (f.isZero(0)) continue;
      body_.load_moment[static_cast<std::size_t>(e)] -= skew(f) * Phi_.middleRows<3>(node.first_gdof);
    }
  }
}

std::vector<int> Reduction::choose_support(const fe::Model& model) {
  if (!is_free()) return {};
  int node = spec_.support.empty() ? 0 : spec_.support.front();
  if (spec_.frame == BodyFrame::Node) node = spec_.frame_nodes.front();
  return fe::choose_determinate_support(model, node);
}

/// The frame rides on a node that follows others (RBE2, RBE3): no dof of its own can be held.
bool Reduction::is_on_dependent_node(const fe::Model& model) const {
  if (spec_.frame != BodyFrame::Node) return false;
  const int index = model.find_node(spec_.frame_nodes.front());
  for (int c = 1; c <= 6; ++c)
    if (model.find_fdof(index, c) < 0) return true;
  return false;
}

/// A deck that leaves a mechanism is wrong input here: what the factorization says, with what a body needs.
StaticSolve Reduction::make_solver(const fe::System& system) {
  const fe::Model& model = system.model;
  try {
    if (is_on_dependent_node(model)) {
      const auto fixed = std::make_shared<modal::bases::FixedInterface>(system, spec_.frame_nodes, diagnostics_);
      return [fixed](const MatrixXd& F) { return fixed->solve(F); };
    }
    const auto solver = std::make_shared<fe::StaticSolver>(model, system.K, choose_support(model));
    factor_ = solver->find_definite_factor();
    return [solver](const MatrixXd& F) { return solver->solve(F); };
  } catch (const ComputationError& error) {
    const auto& id = error.items().front().id;
    const bool is_mechanism = id == "fe.mechanism" || id == "modal.interface-mechanism";
    if (is_mechanism) add_mechanism_error(model, "the stiffness matrix is singular");
    for (auto item : error.items()) {
      if (item.where.file.empty()) item.where = deck_.locate({0, 0});
      diagnostics_.add(std::move(item));
    }
    if (!is_mechanism) throw;
    throw InputError(diagnostics_.items());
  }
}

void Reduction::set_stiffening(const fe::Model& model, const StaticSolve& solve) {
  const auto n = Phi_.cols();
  loads_.erase(std::remove_if(loads_.begin(), loads_.end(),
                              [&](const BodyLoad& load) {
                                if (!load.group.empty() || load.locator.direction <= 3) return false;
                                return lacks_rotation(model, model.node(model.find_node(load.locator.node)));
                              }),
               loads_.end());
  MatrixXd F_ext(model.num_gdofs(), static_cast<Eigen::Index>(loads_.size()));
  for (std::size_t e = 0; e < loads_.size(); ++e) {
    F_ext.col(static_cast<Eigen::Index>(e)) = loads_[e].load.F;
    body_.locators.push_back(loads_[e].locator);
  }
  body_.external_load = fe::calc_inner_products(Phi_, F_ext);
  set_resultants(model, F_ext);

  std::vector<int> inertial;
  if (spec_.inertial_loads.empty()) {
    for (int i = 0; i < records::kNumInertialLoads; ++i) inertial.push_back(i);
  } else {
    std::set<int> wanted;
    for (const auto load : spec_.inertial_loads) wanted.insert(static_cast<int>(load));
    inertial.assign(wanted.begin(), wanted.end());
  }
  const auto num_inertial = static_cast<Eigen::Index>(inertial.size());
  fe::AppliedLoads all;
  all.F.resize(model.num_gdofs(), num_inertial + F_ext.cols());
  all.F << body_.F_I(Eigen::all, inertial), F_ext;
  all.A_I = MatrixXd::Zero(records::kNumInertialLoads, all.F.cols());
  for (Eigen::Index c = 0; c < num_inertial; ++c) all.A_I(inertial[static_cast<std::size_t>(c)], c) = 1;
  all.arms.resize(inertial.size());
  all.followers.resize(inertial.size());
  for (std::size_t e = 0; e < loads_.size(); ++e) {
    all.A_I.col(num_inertial + static_cast<Eigen::Index>(e)) = loads_[e].load.A_I;
    all.arms.push_back(loads_[e].load.arms);
    all.followers.push_back(loads_[e].load.followers);
  }

  const MatrixXd U = solve(all.F);
  set_recovery(model, U, all.F, inertial);
  report("geometric stiffness");
  auto K_G = calc_generalized_geometric_stiffness(model, all, U, Phi_);
  body_.kg_inertial.fill(MatrixXd::Zero(n, n));
  body_.kg_inertial_computed.fill(false);
  for (Eigen::Index c = 0; c < num_inertial; ++c) {
    body_.kg_inertial[inertial[c]] = std::move(K_G[c]);
    body_.kg_inertial_computed[inertial[c]] = true;
  }
  for (std::size_t e = 0; e < loads_.size(); ++e)
    if (!loads_[e].initial.of.empty()) add_thermal_stiffness(model, e, K_G[static_cast<std::size_t>(num_inertial) + e]);
  body_.kg_external.assign(std::make_move_iterator(K_G.begin() + num_inertial), std::make_move_iterator(K_G.end()));
}

}  // namespace bough::stiffening
