#include "bough/stiffening/reduce.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bough/base/rotation.hpp"
#include "bough/modal/integrals.hpp"
#include "bough/stiffening/body_basis.hpp"

namespace bough::stiffening {

using records::BodyFrame;
using records::BodySpec;
using records::FlexBody;

namespace {

using modal::bases::StaticSolve;

constexpr const char* kDirections[] = {"x", "y", "z", "rx", "ry", "rz"};

std::string join(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// One deck, one spec, one body: the stages in order, each filling its part of the record.
class Reduction {
 public:
  Reduction(const records::Deck& deck, const BodySpec& spec, const ReduceOptions& options, Diagnostics& diagnostics)
      : deck_(deck), spec_(spec), options_(options), diagnostics_(diagnostics) {}

  FlexBody run();

 private:
  /// The body file, or the deck when there is none.
  SourceLocation where() const { return spec_.file.empty() ? deck_.locate({0, 0}) : SourceLocation{spec_.file, 0, 0}; }
  void report(const std::string& stage) const {
    if (options_.progress) options_.progress(stage);
  }
  void check_spec();
  void check_nodes(const fe::Model& model);
  void check_node(const fe::Model& model, int id, const std::string& what, const SourceLocation& at);
  fe::ModelOptions make_model_options() const;
  void set_rigid_part(const fe::Model& model);
  std::vector<int> choose_columns(int available, const std::string& whose);
  void check_rigid(const modal::bases::Basis& basis);
  void set_modes(const fe::Model& model, const StaticSolve& solve);
  void set_given_modes(const fe::Model& model);
  void set_damping(const modal::bases::Basis& basis);
  void add_dampers(const fe::Model& model);
  void set_nodes(const fe::Model& model);
  void set_integrals(const fe::Model& model);
  void set_stiffening(const fe::Model& model, const StaticSolve& solve);
  void make_loads(const fe::Model& model);
  void set_resultants(const fe::Model& model, const MatrixXd& F_ext);
  std::vector<int> choose_support(const fe::Model& model);
  bool is_on_dependent_node(const fe::Model& model) const;
  StaticSolve make_solver(const fe::Model& model, const fe::PetscMat& K);
  fe::Model build_model();
  void add_mechanism_error(const std::string& what);

  bool is_free() const { return spec_.frame != BodyFrame::Fixed; }

  const records::Deck& deck_;
  const BodySpec& spec_;
  const ReduceOptions& options_;
  Diagnostics& diagnostics_;
  FlexBody body_;
  MatrixXd Phi_;
  std::vector<BodyLoad> loads_;
  const fe::SymmetricFactor* factor_ = nullptr;  // of K, kept by the static solver
};

void Reduction::check_spec() {
  check_basis(spec_, !options_.modes, where(), diagnostics_);
  for (const int s : spec_.select)
    if (s < 1)
      diagnostics_.error("reduce.bad-select", where(), "mode " + std::to_string(s) + " in select, modes count from 1");
  if (std::set<int>(spec_.select.begin(), spec_.select.end()).size() != spec_.select.size())
    diagnostics_.error("reduce.bad-select", where(), "a mode stands twice in select", "name each mode once");
  const std::vector<std::string> masses = {"deck", "lumped", "consistent"};
  if (std::find(masses.begin(), masses.end(), spec_.mass) == masses.end())
    diagnostics_.error("reduce.bad-mass", where(), "mass is \"" + spec_.mass + "\", expected one of " + join(masses),
                       "did you mean \"" + find_nearest(spec_.mass, masses) + "\"");
  const std::vector<std::string> methods = {"lumped", "consistent", "exact"};
  if (std::find(methods.begin(), methods.end(), spec_.integrals) == methods.end())
    diagnostics_.error("reduce.bad-integrals", where(),
                       "integrals is \"" + spec_.integrals + "\", expected one of " + join(methods),
                       "did you mean \"" + find_nearest(spec_.integrals, methods) + "\"");
  if (spec_.support.size() > 1)
    diagnostics_.error("reduce.bad-support", where(),
                       std::to_string(spec_.support.size()) + " support nodes, expected one that carries all six dofs",
                       "give one node, or none to have three well-spread ones chosen");
  if (!spec_.support.empty() && !is_free())
    diagnostics_.warning("reduce.support-unused", where(), "support is given but the frame is fixed",
                         "the deck's SPC set supports a fixed body");
  if (!spec_.support.empty() && spec_.frame == BodyFrame::Node)
    diagnostics_.warning("reduce.support-unused", where(), "support is given but a node carries the frame",
                         "that node supports the body");
  check_damping(spec_, where(), diagnostics_);
  diagnostics_.throw_if_errors();
}

fe::ModelOptions Reduction::make_model_options() const {
  fe::ModelOptions options;
  options.subcase = spec_.subcase;
  options.ignore_spc = is_free();
  options.origin = spec_.origin;
  options.ignore_cards = spec_.ignore_cards;
  if (spec_.mass == "lumped") options.mass_kind = fe::MassKind::Lumped;
  if (spec_.mass == "consistent") options.mass_kind = fe::MassKind::Consistent;
  return options;
}

void Reduction::check_node(const fe::Model& model, int id, const std::string& what, const SourceLocation& at) {
  const int index = model.find_node(id);
  if (index >= 0 && model.node(index).num_dofs == 6) return;
  diagnostics_.error("reduce.unknown-node", at.file.empty() ? where() : at,
                     what + " names node " + std::to_string(id) +
                         (index < 0 ? ", the deck has no such grid" : ", which is a scalar point"),
                     "name a GRID of the deck");
}

void Reduction::check_nodes(const fe::Model& model) {
  for (const int id : spec_.interface_nodes) check_node(model, id, "interface", {});
  for (const int id : spec_.output_nodes) check_node(model, id, "output", {});
  for (const int id : spec_.support) check_node(model, id, "support", {});
  for (const int id : spec_.frame_nodes) check_node(model, id, "frame_nodes", {});
  for (const auto& load : spec_.loads) {
    if (load.load_set > 0) continue;
    check_node(model, load.node, "load \"" + load.name + "\"", load.at);
    if (load.directions.empty() ||
        std::any_of(load.directions.begin(), load.directions.end(), [](int d) { return d < 1 || d > 6; }))
      diagnostics_.error("reduce.bad-direction", load.at, "load \"" + load.name + "\" needs directions from 1 to 6",
                         "1..3 are forces, 4..6 moments");
  }
  diagnostics_.throw_if_errors();
}

void Reduction::set_rigid_part(const fe::Model& model) {
  const auto properties = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero());
  body_.name = spec_.name;
  body_.mass = properties.mass;
  body_.cg = properties.cg;
  body_.inertia = properties.inertia;
  body_.is_free_free = is_free() && spec_.frame != BodyFrame::Node && spec_.frame != BodyFrame::ThreeNodes;
}

/// The columns that select names, or all of them.
std::vector<int> Reduction::choose_columns(int available, const std::string& whose) {
  std::vector<int> columns;
  for (const int s : spec_.select) {
    if (s <= available)
      columns.push_back(s - 1);
    else
      diagnostics_.error("reduce.bad-select", where(),
                         "mode " + std::to_string(s) + " in select, " + whose + std::to_string(available) +
                             " elastic modes in the range");
  }
  diagnostics_.throw_if_errors();
  for (int j = 0; j < available && spec_.select.empty(); ++j) columns.push_back(j);
  return columns;
}

void Reduction::check_rigid(const modal::bases::Basis& basis) {
  const int num_rigid = is_free() ? 6 : 0, found_rigid = basis.num_rigid + basis.num_massless;
  if (is_free() && found_rigid < 6)
    diagnostics_.error("reduce.grounded", where(),
                       "a free body must have 6 rigid motions, this model has " + std::to_string(found_rigid),
                       "remove springs and bushes to ground, or use frame = \"fixed\"");
  if (found_rigid > num_rigid)
    add_mechanism_error(std::to_string(found_rigid - num_rigid) + " motion(s) have no strain");
  diagnostics_.throw_if_errors();
}

void Reduction::set_modes(const fe::Model& model, const StaticSolve& solve) {
  auto options = make_basis_options(spec_);
  options.factor = factor_;
  std::vector<std::string> names;
  options.residual_loads = collect_residual_loads(model, spec_, loads_, names);
  auto basis = modal::bases::calc_basis(model, options, solve, diagnostics_);
  check_rigid(basis);
  std::string unused;
  for (const int i : basis.unused_loads) unused += (unused.empty() ? "" : ", ") + names[static_cast<std::size_t>(i)];
  if (!unused.empty())
    diagnostics_.note("reduce.residual-unused", where(),
                      "no residual vector for " + unused + ": the modes and the loads before hold its deflection",
                      "nothing to do");

  const bool is_moved = is_free() && spec_.frame != BodyFrame::Free;
  // Raw coordinates lose those of the frame's node first, so that select counts what is left.
  if (basis.is_raw && is_moved) modal::bases::move_to_frame(model, make_frame_spec(spec_), basis);
  auto columns = choose_columns(static_cast<int>(basis.lambda.size()), "the model gives ");
  if (spec_.select.empty() && options.kind == modal::bases::BasisKind::Normal && options.residual_loads.cols() == 0 &&
      spec_.num_modes > 0 && static_cast<int>(columns.size()) > spec_.num_modes)
    columns.resize(static_cast<std::size_t>(spec_.num_modes));
  if (columns.empty())
    diagnostics_.warning("reduce.rigid", where(), "no elastic mode is in the range: the body is rigid",
                         "raise max_frequency or the number of modes");
  basis = modal::bases::select_columns(basis, columns);
  set_damping(basis);
  if (!basis.is_raw && is_moved) modal::bases::move_to_frame(model, make_frame_spec(spec_), basis);
  Phi_ = basis.Phi;
  body_.eigenvalue = basis.lambda;
  body_.frequency_hz = basis.lambda.cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  body_.kind = basis.kind;
  body_.modal_mass = basis.M;
  body_.modal_stiffness = basis.K;
  body_.effective_mass = modal::calc_effective_mass(model, Phi_);
  add_dampers(model);
}

/// Any basis: what is not diagonal in ΦᵀMΦ and ΦᵀKΦ stays.
void Reduction::set_given_modes(const fe::Model& model) {
  Phi_ = options_.modes(model);
  const auto available = static_cast<int>(Phi_.cols());
  auto columns = choose_columns(available, "the file gives ");
  if (spec_.select.empty() && spec_.num_modes > 0 && spec_.num_modes < available)
    columns.resize(static_cast<std::size_t>(spec_.num_modes));
  Phi_ = Phi_(Eigen::all, columns).eval();
  if (is_free() && spec_.frame != BodyFrame::Free) {
    const auto C = modal::bases::calc_reference_conditions(model, make_frame_spec(spec_));
    Phi_ = modal::bases::shift_to_frame(model, C, Phi_);
  }
  const auto n = Phi_.cols();
  const auto project = [this](const MatrixXd& A_Phi) -> MatrixXd {
    const MatrixXd A = Phi_.transpose() * A_Phi;
    return 0.5 * (A + A.transpose());
  };
  body_.modal_mass = project(fe::calc_mass_times(model, model.mass_kind(), Phi_));
  body_.modal_stiffness = project(fe::calc_stiffness_times(model, Phi_));
  for (Eigen::Index j = 0; j < n; ++j)
    if (!(body_.modal_mass(j, j) > 0))
      diagnostics_.error("reduce.no-modal-mass", where(),
                         "mode " + std::to_string(j + 1) + " of those kept has no mass (phi' M phi is not positive)",
                         "check the mass matrix, the mode shapes and their dofs");
  diagnostics_.throw_if_errors();
  body_.eigenvalue = body_.modal_stiffness.diagonal().cwiseQuotient(body_.modal_mass.diagonal());
  body_.frequency_hz = body_.eigenvalue.cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  body_.kind.assign(static_cast<std::size_t>(n), records::ModeKind::Normal);
  body_.effective_mass = modal::calc_effective_mass(model, Phi_);
  modal::bases::Basis basis;
  basis.Phi = Phi_;
  basis.lambda = body_.eigenvalue;
  basis.M = body_.modal_mass;
  basis.K = body_.modal_stiffness;
  basis.kind = body_.kind;
  set_damping(basis);
  add_dampers(model);
}

/// By ratio, table, Rayleigh's factors and the materials, in the frame where the basis is orthogonal to rigid motions:
/// those do not dissipate.
void Reduction::set_damping(const modal::bases::Basis& basis) {
  const auto spec = make_damping_spec(spec_);
  const auto n = static_cast<std::size_t>(basis.lambda.size());
  const auto bad = [&](const std::string& what, const std::string& advice) {
    diagnostics_.error("reduce.bad-damping", where(), what, advice);
    diagnostics_.throw_if_errors();
  };
  if (!spec.ratios.empty() && spec.ratios.size() != n)
    bad(std::to_string(spec.ratios.size()) + " damping ratios for " + std::to_string(n) + " modes",
        "give one per kept mode, or one for all");
  std::vector<bool> is_residual;
  for (const auto kind : basis.kind)
    is_residual.push_back(kind == records::ModeKind::Residual || kind == records::ModeKind::Attachment);
  for (std::size_t j = 0; j < n && !spec.table.empty(); ++j) {
    const double hz = std::sqrt(std::max(basis.lambda(static_cast<Eigen::Index>(j)), 0.0)) / (2 * std::numbers::pi);
    if (const double zeta = modal::bases::calc_table_ratio(spec, hz); !(zeta >= 0) || std::isinf(zeta))
      bad("the damping table gives the ratio " + std::to_string(zeta) + " at " + std::to_string(hz) +
              " Hz, where its end lines lead",
          "add a point to the table beyond the modes");
  }
  MatrixXd K_g;
  if (spec_.has_material_damping && options_.elements)
    bad("material = true, but the stiffness comes from given matrices", "use ratios, a table or structural");
  if (spec_.has_material_damping) K_g = calc_material_damping(deck_, basis.Phi, where(), diagnostics_);
  body_.modal_damping = modal::bases::calc_damping(basis.M, basis.K, spec, K_g, is_residual);
}

/// ΦᵀBΦ of the dampers of the deck, which couples modes.
void Reduction::add_dampers(const fe::Model& model) {
  if (!fe::has_damping(model)) return;
  const MatrixXd B = Phi_.transpose() * fe::calc_damping_times(model, Phi_);
  body_.modal_damping += 0.5 * (B + B.transpose());
}

void Reduction::set_nodes(const fe::Model& model) {
  std::vector<int> ids;
  std::set<int> seen;
  const auto add = [&](int id) {
    if (seen.insert(id).second) ids.push_back(id);
  };
  for (const int id : spec_.output_nodes) add(id);
  if (spec_.output_nodes.empty())
    for (const auto& node : model.nodes())
      if (node.num_dofs == 6) add(node.id);
  for (const int id : spec_.interface_nodes) add(id);
  body_.node_id = ids;
  body_.node_xyz.resize(static_cast<Eigen::Index>(ids.size()), 3);
  body_.phi.clear();
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto& node = model.node(model.find_node(ids[k]));
    body_.node_xyz.row(static_cast<Eigen::Index>(k)) = node.x.transpose();
    body_.phi.push_back(Phi_.middleRows(node.first_gdof, 6));
  }
  body_.mesh = model.calc_mesh();
  body_.dof_map = model.calc_dof_map();
  if (spec_.full) body_.full_phi = Phi_;
}

void Reduction::set_integrals(const fe::Model& model) {
  body_.lumped = modal::calc_momentum_integrals(model, fe::MassKind::Lumped, Phi_);
  body_.consistent = modal::calc_momentum_integrals(model, fe::MassKind::Consistent, Phi_);
  body_.exact = modal::calc_exact_integrals(model, model.mass_kind(), Phi_);
  body_.integrals_method = spec_.integrals;
}

/// A locator for each translation of the interface nodes and each load of the body file.
void Reduction::make_loads(const fe::Model& model) {
  for (const int id : spec_.interface_nodes)
    if (std::find(body_.interface_nodes.begin(), body_.interface_nodes.end(), id) == body_.interface_nodes.end())
      body_.interface_nodes.push_back(id);
  const auto add_unit = [&](const std::string& group, const std::string& name, int id, int direction) {
    const auto& node = model.node(model.find_node(id));
    loads_.push_back(
        {group, {name, id, direction}, VectorXd::Unit(model.num_gdofs(), node.first_gdof + direction - 1)});
  };
  for (const int id : body_.interface_nodes)
    for (int d = 1; d <= 3; ++d) add_unit("", "node" + std::to_string(id) + "_" + kDirections[d - 1], id, d);
  for (std::size_t i = 0; i < spec_.loads.size(); ++i) {
    const auto& load = spec_.loads[i];
    const std::string name = load.name.empty() ? "load" + std::to_string(i + 1) : load.name;
    if (load.load_set > 0) {
      BodyLoad& pattern = loads_.emplace_back();
      pattern.group = pattern.locator.name = name;
      pattern.F = model.calc_load(deck_, load.load_set, diagnostics_);
      continue;
    }
    for (const int d : load.directions)
      add_unit(name, load.directions.size() == 1 ? name : name + "_" + kDirections[d - 1], load.node, d);
  }
  diagnostics_.throw_if_errors();
}

/// What each external load does to the body as a whole: Φ_Rᵀ F, and Σ φ_kj × f_k by which mode j shifts its moment.
void Reduction::set_resultants(const fe::Model& model, const MatrixXd& F_ext) {
  body_.load_resultant = model.calc_rigid_modes().transpose() * F_ext;
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

void Reduction::add_mechanism_error(const std::string& what) {
  if (is_free())
    diagnostics_.error("reduce.mechanism", where(), "besides the six rigid motions of a free body, " + what,
                       "tie the loose parts or constrain the free dofs");
  else
    diagnostics_.error("reduce.mechanism", where(), "the constraints do not hold the fixed body: " + what,
                       "complete the SPC set and select it in the case control, or use frame = \"free\" (--free)");
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
StaticSolve Reduction::make_solver(const fe::Model& model, const fe::PetscMat& K) {
  try {
    if (is_on_dependent_node(model)) {
      const auto fixed = std::make_shared<modal::bases::FixedInterface>(model, spec_.frame_nodes, diagnostics_);
      return [fixed](const MatrixXd& F) { return fixed->solve(F); };
    }
    const auto solver = std::make_shared<fe::StaticSolver>(model, K, choose_support(model));
    factor_ = solver->find_definite_factor();
    return [solver](const MatrixXd& F) { return solver->solve(F); };
  } catch (const ComputationError& error) {
    for (auto item : error.items()) {
      if (item.where.file.empty()) item.where = deck_.locate({0, 0});
      diagnostics_.add(std::move(item));
    }
    const auto& id = error.items().front().id;
    if (id != "fe.mechanism" && id != "modal.interface-mechanism") throw;
    add_mechanism_error("the stiffness matrix is singular");
    throw InputError(diagnostics_.items());
  }
}

void Reduction::set_stiffening(const fe::Model& model, const StaticSolve& solve) {
  const auto n = Phi_.cols();
  body_.F_I = calc_inertial_loads(model, model.mass_kind());
  MatrixXd F_ext(model.num_gdofs(), static_cast<Eigen::Index>(loads_.size()));
  for (std::size_t e = 0; e < loads_.size(); ++e) {
    F_ext.col(static_cast<Eigen::Index>(e)) = loads_[e].F;
    body_.locators.push_back(loads_[e].locator);
  }
  body_.external_load = Phi_.transpose() * F_ext;
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
  MatrixXd F(model.num_gdofs(), num_inertial + F_ext.cols());
  F << body_.F_I(Eigen::all, inertial), F_ext;

  const MatrixXd U = solve(F);
  report("geometric stiffness");
  auto K_G = calc_generalized_geometric_stiffness(model, U, Phi_);
  body_.kg_inertial.fill(MatrixXd::Zero(n, n));
  body_.kg_inertial_computed.fill(false);
  for (Eigen::Index c = 0; c < num_inertial; ++c) {
    body_.kg_inertial[inertial[c]] = std::move(K_G[c]);
    body_.kg_inertial_computed[inertial[c]] = true;
  }
  body_.kg_external.assign(std::make_move_iterator(K_G.begin() + num_inertial), std::make_move_iterator(K_G.end()));
}

/// Twice where the origin is a node or the mass centre: the first model says where that is.
fe::Model Reduction::build_model() {
  const auto& elements = options_.elements ? options_.elements : fe::make_elements;
  auto options = make_model_options();
  auto model = fe::Model::build(deck_, options, elements, diagnostics_);
  if (spec_.origin_node > 0) check_node(model, spec_.origin_node, "origin", {});
  check_nodes(model);
  if (spec_.frame != BodyFrame::Fixed && spec_.frame != BodyFrame::Free)
    modal::bases::calc_reference_conditions(model, make_frame_spec(spec_));
  if (spec_.origin_node > 0)
    options.origin = model.node(model.find_node(spec_.origin_node)).x;
  else if (spec_.origin_at_mass_centre)
    options.origin = fe::calc_mass_properties(model, model.mass_kind(), Eigen::Vector3d::Zero()).cg;
  else
    return model;
  Diagnostics reported;
  return fe::Model::build(deck_, options, elements, reported);
}

FlexBody Reduction::run() {
  check_spec();
  report("model");
  const auto model = build_model();
  set_rigid_part(model);

  // The factor first: of a mechanism it names the dofs, which the modes could not.
  report("static factorization");
  const fe::PetscMat K = fe::assemble_stiffness(model, fe::DofSet::Free);
  const auto solve = make_solver(model, K);
  make_loads(model);
  report("modes");
  if (options_.modes)
    set_given_modes(model);
  else
    set_modes(model, solve);
  set_nodes(model);
  report("mass integrals");
  set_integrals(model);
  report("static solutions");
  set_stiffening(model, solve);
  return std::move(body_);
}

}  // namespace

FlexBody reduce(const records::Deck& deck, const BodySpec& spec, const ReduceOptions& options,
                Diagnostics& diagnostics) {
  fe::initialize_petsc();
  return Reduction(deck, spec, options, diagnostics).run();
}

}  // namespace bough::stiffening
