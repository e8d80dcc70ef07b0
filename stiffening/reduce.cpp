#include "bough/stiffening/reduce.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bough/base/rotation.hpp"
#include "bough/modal/integrals.hpp"

namespace bough::stiffening {

using records::BodyFrame;
using records::BodySpec;
using records::FlexBody;

namespace {

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
  void set_modes(const fe::Model& model);
  void set_given_modes(const fe::Model& model);
  void set_damping(const fe::Model& model);
  void set_nodes(const fe::Model& model);
  void set_integrals(const fe::Model& model);
  void set_stiffening(const fe::Model& model, const fe::StaticSolver& solver);
  MatrixXd make_external_loads(const fe::Model& model);
  void set_resultants(const fe::Model& model, const MatrixXd& F_ext);
  std::vector<int> choose_support(const fe::Model& model);
  fe::StaticSolver make_solver(const fe::Model& model, const fe::PetscMat& K);
  void add_mechanism_error(const std::string& what);

  bool is_free() const { return spec_.frame == BodyFrame::Free; }

  const records::Deck& deck_;
  const BodySpec& spec_;
  const ReduceOptions& options_;
  Diagnostics& diagnostics_;
  FlexBody body_;
  MatrixXd Phi_;
};

void Reduction::check_spec() {
  if (spec_.num_modes <= 0 && !spec_.max_frequency_hz && spec_.select.empty() && !options_.modes)
    diagnostics_.error("reduce.no-modes", where(), "the body asks for no modes",
                       "give [body.modes] number, max_frequency or select");
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
  if (spec_.damping_ratio < 0 ||
      std::any_of(spec_.damping_ratios.begin(), spec_.damping_ratios.end(), [](double z) { return z < 0; }))
    diagnostics_.error("reduce.bad-damping", where(), "a damping ratio is negative", "give ratios of 0 or more");
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
  body_.is_free_free = is_free();
}

void Reduction::set_modes(const fe::Model& model) {
  modal::EigenOptions options;
  const int num_rigid = is_free() ? 6 : 0;
  int num_elastic = spec_.num_modes;
  for (const int s : spec_.select) num_elastic = std::max(num_elastic, s);
  options.num_modes = num_elastic > 0 ? num_elastic + num_rigid : 0;
  options.max_hz = spec_.max_frequency_hz;
  const auto pairs = modal::calc_normal_modes(model, options, diagnostics_);
  const int found_rigid = pairs.num_rigid + pairs.num_massless;
  if (is_free() && found_rigid < 6)
    diagnostics_.error("reduce.grounded", where(),
                       "a free body must have 6 rigid motions, this model has " + std::to_string(found_rigid),
                       "remove springs and bushes to ground, or use frame = \"fixed\"");
  if (found_rigid > num_rigid)
    add_mechanism_error(std::to_string(found_rigid - num_rigid) + " motion(s) have no strain");
  diagnostics_.throw_if_errors();

  const auto available = static_cast<int>(pairs.lambda.size()) - pairs.num_rigid;
  std::vector<int> columns;
  if (spec_.select.empty()) {
    // A massless rigid motion takes none of the modes asked for: what came in its place is cut again.
    const int kept = spec_.num_modes > 0 ? std::min(available, spec_.num_modes) : available;
    for (int j = 0; j < kept; ++j) columns.push_back(pairs.num_rigid + j);
  } else {
    for (const int s : spec_.select) {
      if (s > available)
        diagnostics_.error("reduce.bad-select", where(),
                           "mode " + std::to_string(s) + " in select, the model gives " + std::to_string(available) +
                               " elastic modes in the range");
      else
        columns.push_back(pairs.num_rigid + s - 1);
    }
    diagnostics_.throw_if_errors();
  }
  if (columns.empty())
    diagnostics_.warning("reduce.rigid", where(), "no elastic mode is in the range: the body is rigid",
                         "raise max_frequency or the number of modes");
  Phi_ = pairs.Phi(Eigen::all, columns);
  const VectorXd lambda = pairs.lambda(columns);
  const auto n = lambda.size();
  body_.eigenvalue = lambda;
  body_.frequency_hz = lambda.cwiseMax(0).cwiseSqrt() / (2 * std::numbers::pi);
  body_.kind.assign(n, records::ModeKind::Normal);
  body_.modal_mass = MatrixXd::Identity(n, n);
  body_.modal_stiffness = lambda.asDiagonal();
  body_.effective_mass = modal::calc_effective_mass(model, Phi_);
  set_damping(model);
}

/// Any basis: what is not diagonal in ΦᵀMΦ and ΦᵀKΦ stays.
void Reduction::set_given_modes(const fe::Model& model) {
  Phi_ = options_.modes(model);
  const auto available = static_cast<int>(Phi_.cols());
  std::vector<int> columns;
  for (const int s : spec_.select) {
    if (s <= available)
      columns.push_back(s - 1);
    else
      diagnostics_.error("reduce.bad-select", where(),
                         "mode " + std::to_string(s) + " in select, " + std::to_string(available) + " are given");
  }
  diagnostics_.throw_if_errors();
  if (!spec_.select.empty())
    Phi_ = Phi_(Eigen::all, columns).eval();
  else if (spec_.num_modes > 0 && spec_.num_modes < available)
    Phi_ = Phi_.leftCols(spec_.num_modes).eval();
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
  set_damping(model);
}

/// 2 ζ ω of the ratios, plus ΦᵀBΦ of the dampers of the deck, which couples modes.
void Reduction::set_damping(const fe::Model& model) {
  const auto n = body_.eigenvalue.size();
  VectorXd zeta = VectorXd::Constant(n, spec_.damping_ratio);
  if (!spec_.damping_ratios.empty()) {
    if (static_cast<Eigen::Index>(spec_.damping_ratios.size()) != n)
      diagnostics_.error(
          "reduce.bad-damping", where(),
          std::to_string(spec_.damping_ratios.size()) + " damping ratios for " + std::to_string(n) + " modes",
          "give one per kept mode, or one for all");
    diagnostics_.throw_if_errors();
    zeta = VectorXd::Map(spec_.damping_ratios.data(), n);
  }
  const Eigen::ArrayXd mass = body_.modal_mass.diagonal().array();
  body_.modal_damping = (2 * zeta.array() * body_.eigenvalue.array().max(0).sqrt() * mass).matrix().asDiagonal();
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
  body_.interface_nodes.clear();
  for (const int id : spec_.interface_nodes)
    if (std::find(body_.interface_nodes.begin(), body_.interface_nodes.end(), id) == body_.interface_nodes.end())
      body_.interface_nodes.push_back(id);

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

MatrixXd Reduction::make_external_loads(const fe::Model& model) {
  std::vector<VectorXd> columns;
  const auto add_unit = [&](const std::string& name, int id, int direction) {
    const auto& node = model.node(model.find_node(id));
    columns.push_back(VectorXd::Unit(model.num_gdofs(), node.first_gdof + direction - 1));
    body_.locators.push_back({name, id, direction});
  };
  for (const int id : body_.interface_nodes)
    for (int d = 1; d <= 3; ++d) add_unit("node" + std::to_string(id) + "_" + kDirections[d - 1], id, d);
  for (std::size_t i = 0; i < spec_.loads.size(); ++i) {
    const auto& load = spec_.loads[i];
    const std::string name = load.name.empty() ? "load" + std::to_string(i + 1) : load.name;
    if (load.load_set > 0) {
      columns.push_back(model.calc_load(deck_, load.load_set, diagnostics_));
      body_.locators.push_back({name, 0, 0});
      continue;
    }
    for (const int d : load.directions)
      add_unit(load.directions.size() == 1 ? name : name + "_" + kDirections[d - 1], load.node, d);
  }
  diagnostics_.throw_if_errors();
  MatrixXd F(model.num_gdofs(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) F.col(static_cast<Eigen::Index>(i)) = columns[i];
  return F;
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
  return fe::choose_determinate_support(model, spec_.support.empty() ? 0 : spec_.support.front());
}

void Reduction::add_mechanism_error(const std::string& what) {
  if (is_free())
    diagnostics_.error("reduce.mechanism", where(), "besides the six rigid motions of a free body, " + what,
                       "tie the loose parts or constrain the free dofs");
  else
    diagnostics_.error("reduce.mechanism", where(), "the constraints do not hold the fixed body: " + what,
                       "complete the SPC set and select it in the case control, or use frame = \"free\"");
}

/// A deck that leaves a mechanism is wrong input here: what the factorization says, with what a body needs.
fe::StaticSolver Reduction::make_solver(const fe::Model& model, const fe::PetscMat& K) {
  const auto support = choose_support(model);
  try {
    return fe::StaticSolver(model, K, support);
  } catch (const ComputationError& error) {
    for (auto item : error.items()) {
      if (item.where.file.empty()) item.where = deck_.locate({0, 0});
      diagnostics_.add(std::move(item));
    }
    if (error.items().front().id != "fe.mechanism") throw;
    add_mechanism_error("the stiffness matrix is singular");
    throw InputError(diagnostics_.items());
  }
}

void Reduction::set_stiffening(const fe::Model& model, const fe::StaticSolver& solver) {
  const auto n = Phi_.cols();
  body_.F_I = calc_inertial_loads(model, model.mass_kind());
  const MatrixXd F_ext = make_external_loads(model);
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

  const MatrixXd U = solver.solve(F);
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

FlexBody Reduction::run() {
  check_spec();
  report("model");
  const auto& elements = options_.elements ? options_.elements : fe::make_elements;
  const auto model = fe::Model::build(deck_, make_model_options(), elements, diagnostics_);
  check_nodes(model);
  set_rigid_part(model);

  // The factor first: of a mechanism it names the dofs, which the modes could not.
  report("static factorization");
  const fe::PetscMat K = fe::assemble_stiffness(model, fe::DofSet::Free);
  const auto solver = make_solver(model, K);
  report("modes");
  if (options_.modes)
    set_given_modes(model);
  else
    set_modes(model);
  set_nodes(model);
  report("mass integrals");
  set_integrals(model);
  report("static solutions");
  set_stiffening(model, solver);
  return std::move(body_);
}

}  // namespace

FlexBody reduce(const records::Deck& deck, const BodySpec& spec, const ReduceOptions& options,
                Diagnostics& diagnostics) {
  fe::initialize_petsc();
  return Reduction(deck, spec, options, diagnostics).run();
}

}  // namespace bough::stiffening
