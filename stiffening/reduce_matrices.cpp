#include "stiffening/reduce_matrices.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include "base/rotation.hpp"
#include "fe/linear/factor.hpp"
#include "stiffening/given_checks.hpp"
#include "stiffening/given_elements.hpp"
#include "stiffening/given_rigid.hpp"

namespace bough::stiffening {

using records::BodySpec;
using records::Deck;
using records::FlexBody;

namespace {

template <class Container, class Value>
bool has(const Container& values, const Value& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

/// Grids, coordinate systems, constraints and loads of the deck; no element, no matrix of its own, no scale of mass.
Deck keep_points(const Deck& deck, const GivenMatrices& given) {
  Deck kept = deck;
  kept.beams.clear(), kept.crod.clear(), kept.conrod.clear(), kept.ctube.clear();
  kept.springs.clear(), kept.cbush.clear(), kept.cbush1d.clear(), kept.dampers.clear(), kept.cvisc.clear();
  kept.shells.clear(), kept.shear_panels.clear(), kept.solids.clear();
  kept.scalar_masses.clear(), kept.conm1.clear(), kept.conm2.clear(), kept.direct_matrices.clear();
  for (auto& subcase : kept.subcases) subcase.k2gg.clear(), subcase.m2gg.clear(), subcase.b2gg.clear();
  const std::set<std::string> of_elements = {"WTMASS", "COUPMASS", "CK1", "CK2", "CM1", "CM2", "CB1", "CB2", "AUTOSPC"};
  const auto is_of_elements = [&](const records::Param& p) { return of_elements.count(p.name) > 0; };
  kept.params.erase(std::remove_if(kept.params.begin(), kept.params.end(), is_of_elements), kept.params.end());
  // A matrix on fewer dofs than the g-set was reduced already.
  const auto num_gdofs = 6 * deck.grids.size() + deck.scalar_points.size();
  if (static_cast<std::size_t>(given.K.values.rows()) < num_gdofs) kept.aset.clear(), kept.omit.clear();
  for (auto& grid : kept.grids)
    if (has(given.clamped, grid.id)) grid.ps = 63;
  return kept;
}

class MatrixReduction {
 public:
  MatrixReduction(const Deck& deck, const BodySpec& spec, const GivenMatrices& given, const ReduceOptions& options,
                  Diagnostics& diagnostics)
      : deck_(deck), spec_(spec), given_(given), options_(options), diagnostics_(diagnostics) {}

  FlexBody run();

 private:
  void check_spec();
  BodySpec make_spec() const;
  fe::ElementList make_elements(const fe::NodeTable& nodes);
  SparseRows place(const PointTable& points, const GivenMatrix& matrix, SparseRows* placement = nullptr);
  void restore_rigid_motions(const PointTable& points, const SparseRows& M, SparseRows& K);
  MatrixXd calc_modes(const fe::System& system);
  void warn_of_strangers(const fe::System& system, const MatrixXd& Phi, const std::vector<int>& elastic);
  void check_integrals();
  void set_geometric(FlexBody& body);
  void add_locator(FlexBody& body, const GivenGeometric& g, const VectorXd& F);
  void warn_of_missing(const FlexBody& body);
  void warn_of_stiffening(const FlexBody& body, const std::set<std::size_t>& set);

  const Deck& deck_;
  const BodySpec& spec_;
  const GivenMatrices& given_;
  const ReduceOptions& options_;
  Diagnostics& diagnostics_;
  // Set while the model is built, all on its g-set.
  modal::NodalDofs dofs_;
  Eigen::MatrixXi dof_map_;
  std::vector<char> has_row_;  ///< whether K has the dof
  bool is_lumped_ = false;
  std::vector<SparseRows> K_G_;
  std::vector<VectorXd> F_;  ///< of each K_G that came with its load; empty for the others
  SparseRows P_modes_;
};

void MatrixReduction::check_spec() {
  if (spec_.mass != "deck")
    diagnostics_.error("reduce.bad-mass", given_.M.at, "mass is \"" + spec_.mass + "\", but the mass matrix is given",
                       "remove the key");
  if (deck_.card_counts.count("SEQGP") > 0 && given_.K.row_dofs.rows() == 0)
    diagnostics_.warning("reduce.matrix-order", given_.K.at,
                         given_.K.label + " names no dofs and the deck has SEQGP: rows are taken by the ids of points",
                         "give a table of dofs in the order of the matrix");
  for (const int id : given_.clamped)
    if (std::none_of(deck_.grids.begin(), deck_.grids.end(), [id](const auto& g) { return g.id == id; }))
      diagnostics_.error("reduce.unknown-node", given_.K.at,
                         "clamped names node " + std::to_string(id) + ", there is no such grid", "correct the id");
}

/// K_G of a unit load or a load set takes its locator from the ones that reduce() makes.
BodySpec MatrixReduction::make_spec() const {
  BodySpec spec = spec_;
  spec.full = true;
  spec.integrals = "exact";
  spec.interface_moments = false;  // those given come as loads
  for (const auto& g : given_.geometric) {
    if (g.inertial >= 0 || !g.load.empty()) continue;
    if (g.node > 0 && g.direction <= 3 && has(spec.interface_nodes, g.node)) continue;
    records::ExternalLoadSpec load;
    load.name = g.name;
    load.node = g.node;
    if (g.node > 0) load.directions = {g.direction};
    load.load_set = g.load_set;
    load.at = g.K_G.at;
    spec.loads.push_back(load);
  }
  return spec;
}

/// P A Pᵀ, symmetric to the last bit; a matrix that is not symmetric is an error.
SparseRows MatrixReduction::place(const PointTable& points, const GivenMatrix& matrix, SparseRows* placement) {
  const SparseRows P = calc_placement(points, matrix, diagnostics_);
  if (placement) *placement = P;
  if (diagnostics_.num_errors() > 0) return SparseRows(points.num_gdofs, points.num_gdofs);
  check_symmetry(matrix, diagnostics_);
  const SparseRows A = P * matrix.values * SparseRows(P.transpose());
  return 0.5 * (A + SparseRows(A.transpose()));
}

fe::ElementList MatrixReduction::make_elements(const fe::NodeTable& nodes) {
  const PointTable points(deck_, nodes);
  dofs_ = points.calc_nodal_dofs();
  dof_map_ = points.calc_dof_map();
  fe::ElementList list;
  if (diagnostics_.num_errors() > 0) return list;  // of the grids

  SparseRows P_K;
  SparseRows K = place(points, given_.K, &P_K);
  const SparseRows M = given_.mass_scale * place(points, given_.M);
  const SparseRows B = given_.B.empty() ? SparseRows() : place(points, given_.B);
  K_G_.clear(), F_.clear();
  for (const auto& g : given_.geometric) {
    K_G_.push_back(place(points, g.K_G));
    F_.emplace_back();
    if (g.load.empty()) continue;
    const SparseRows P = calc_placement(points, g.load, diagnostics_);
    if (g.load_column > g.load.values.cols())
      diagnostics_.error("reduce.matrix-size", g.load.at,
                         "column " + std::to_string(g.load_column) + " of " + g.load.label + ", which has " +
                             std::to_string(g.load.values.cols()),
                         "give one of its columns");
    else if (diagnostics_.num_errors() == 0)
      F_.back() = P * VectorXd(MatrixXd(g.load.values).col(g.load_column - 1));
  }
  if (!given_.modes.Phi.empty()) P_modes_ = calc_placement(points, given_.modes.Phi, diagnostics_);
  if (diagnostics_.num_errors() > 0) return list;

  has_row_.assign(static_cast<std::size_t>(points.num_gdofs), 0);
  for (int i = 0; i < P_K.outerSize(); ++i) has_row_[static_cast<std::size_t>(i)] = P_K.row(i).nonZeros() > 0;
  check_mass(M, given_.M, points, diagnostics_);
  is_lumped_ = !couples_points(points, M);
  check_integrals();
  if (spec_.frame != records::BodyFrame::Fixed && diagnostics_.num_errors() == 0) restore_rigid_motions(points, M, K);
  add_direct_elements(points, K, fe::DirectKind::Stiffness, list);
  add_direct_elements(points, M, fe::DirectKind::Mass, list);
  if (B.rows() > 0) add_direct_elements(points, B, fe::DirectKind::Damping, list);
  add_drawn_elements(deck_, nodes, list);
  return list;
}

/// Whether the deck ties points that K need not couple.
bool has_constraint_equations(const Deck& deck) {
  return !(deck.rbe1.empty() && deck.rbe2.empty() && deck.rbe3.empty() && deck.rbar.empty() && deck.rrod.empty() &&
           deck.special.rspline.empty() && deck.mpc.empty());
}

/// K of a free body that another program condensed strains in rigid-body motions by round-off.
void MatrixReduction::restore_rigid_motions(const PointTable& points, const SparseRows& M, SparseRows& K) {
  const auto check = check_rigid_motions(points, K, M);
  if (check.is_exact || !(check.elastic > 0)) return;
  const auto to_hz = [](double lambda) { return std::sqrt(lambda) / (2 * std::numbers::pi); };
  char text[200];
  std::snprintf(text, sizeof text, "up to %.2g Hz, the first elastic mode has %.6g Hz", to_hz(check.worst),
                to_hz(check.elastic));
  if (check.num_mechanisms > 0 && check.num_rigid == 6 && !has_constraint_equations(deck_)) {
    diagnostics_.error("reduce.mechanism", given_.K.at,
                       given_.K.label + " has " + std::to_string(check.num_mechanisms) +
                           " motion(s) without strain in addition to the six rigid-body motions",
                       "look for hinges, and for parts or points that nothing holds");
    return;
  }
  if (!check.is_free) return;
  K = check.K;
  diagnostics_.note(
      "reduce.rigid-roundoff", given_.K.at,
      given_.K.label + " strains in rigid-body motions by round-off: " + text + "; they are taken as rigid",
      "nothing to do; use frame = \"fixed\" if the body is held by springs as soft as these");
}

MatrixXd MatrixReduction::calc_modes(const fe::System& system) {
  const fe::Model& model = system.model;
  MatrixXd Phi = P_modes_ * MatrixXd(given_.modes.Phi.values);
  // Rigid motions of a free body leave no strain; its frame has them already.
  const VectorXd diagonal = fe::get_diagonal(fe::assemble_stiffness(model, fe::DofSet::Global).get()).cwiseAbs();
  const MatrixXd K_Phi = fe::calc_stiffness_times(model, Phi);
  std::vector<int> elastic;
  for (int j = 0; j < Phi.cols(); ++j) {
    const double scale = Phi.col(j).cwiseAbs2().dot(diagonal);
    if (Phi.col(j).dot(K_Phi.col(j)) > 1e-11 * scale) elastic.push_back(j);
  }
  if (static_cast<Eigen::Index>(elastic.size()) < Phi.cols())
    diagnostics_.note("reduce.rigid-modes", given_.modes.Phi.at,
                      std::to_string(Phi.cols() - static_cast<Eigen::Index>(elastic.size())) + " of the " +
                          std::to_string(Phi.cols()) + " modes of " + given_.modes.Phi.label +
                          " have no strain and are left out");
  if (given_.modes.eigenvalue.size() == Phi.cols()) compare_eigenvalues(model, given_.modes, Phi, diagnostics_);
  warn_of_strangers(system, Phi, elastic);
  return Phi(Eigen::all, elastic);
}

/// One step of inverse iteration: x = (λ + σ)(K + σ M)⁻¹ M x of a mode of K and M, λ its Rayleigh quotient. Measured in
/// M, so that the last digits of printed shapes, which strain a fine mesh as much as the mode itself, do not count.
void MatrixReduction::warn_of_strangers(const fe::System& system, const MatrixXd& Phi,
                                        const std::vector<int>& elastic) {
  constexpr double most = 1e-3;
  const fe::Model& model = system.model;
  const auto kind = model.mass_kind();
  const MatrixXd X = Phi(Eigen::all, elastic), M_X = fe::calc_mass_times(model, kind, X);
  const VectorXd mass = X.cwiseProduct(M_X).colwise().sum(),
                 stiffness = X.cwiseProduct(fe::calc_stiffness_times(model, X)).colwise().sum();
  if (X.cols() == 0 || !(mass.minCoeff() > 0) || model.num_fdofs() == 0) return;  // reduce.no-modal-mass says it
  const VectorXd lambda = stiffness.cwiseQuotient(mass);
  const double shift = lambda.minCoeff();
  const fe::PetscMat shifted = fe::add(system.K.get(), shift, system.M.get());
  const fe::SymmetricFactor factor(shifted.get(), true, fe::FactorMethod::Pivoting);
  if (factor.is_singular()) return;
  const MatrixXd f = model.T().transpose() * M_X;
  const MatrixXd E = X - model.T() * (factor.solve(f) * (lambda.array() + shift).matrix().asDiagonal());
  const VectorXd wrong =
      E.cwiseProduct(fe::calc_mass_times(model, kind, E)).colwise().sum().transpose().cwiseQuotient(mass).cwiseSqrt();
  Eigen::Index worst = 0;
  const auto num = (wrong.array() > most).count();
  if (num == 0 || !(wrong.maxCoeff(&worst) > most)) return;
  char share[32];
  std::snprintf(share, sizeof share, "%.1e", wrong[worst]);
  diagnostics_.warning("reduce.modes-residual", given_.modes.Phi.at,
                       std::to_string(num) + " of the " + std::to_string(X.cols()) + " modes of " +
                           given_.modes.Phi.label + " are no modes of K and M: mode " +
                           std::to_string(elastic[static_cast<std::size_t>(worst)] + 1) + " is off by " + share +
                           " of its size",
                       "look whether they are of the same model, constraints, units and order of dofs; shapes that are "
                       "meant (Ritz vectors) are kept as they are");
}

/// M knows one set of momentum integrals, under the name of its kind.
void MatrixReduction::check_integrals() {
  if (spec_.integrals == (is_lumped_ ? "consistent" : "lumped"))
    diagnostics_.error("reduce.bad-integrals", given_.M.at,
                       "integrals is \"" + spec_.integrals + "\", but the mass matrix given is " +
                           (is_lumped_ ? "lumped" : "consistent"),
                       std::string("choose \"exact\" or \"") + (is_lumped_ ? "lumped" : "consistent") + "\"");
}

void MatrixReduction::add_locator(FlexBody& body, const GivenGeometric& g, const VectorXd& F) {
  const auto n = body.full_phi.cols(), e = body.external_load.cols();
  body.locators.push_back({g.name, 0, 0});
  body.external_load.conservativeResize(n, e + 1);
  body.external_load.col(e) = body.full_phi.transpose() * F;
  body.load_resultant.conservativeResize(6, e + 1);
  body.load_resultant.col(e) = dofs_.calc_rigid_modes().transpose() * F;
  MatrixXd moment = MatrixXd::Zero(3, n);
  for (int k = 0; k < dofs_.num_nodes(); ++k) {
    const Eigen::Vector3d f = dofs_.gather(F, k).topRows<3>();
    if (!f.isZero(0)) moment -= skew(f) * dofs_.gather(body.full_phi, k).topRows<3>();
  }
  body.load_moment.push_back(moment);
  body.kg_external.emplace_back(MatrixXd::Zero(n, n));
}

void MatrixReduction::set_geometric(FlexBody& body) {
  const auto n = body.full_phi.cols();
  body.kg_inertial.fill(MatrixXd::Zero(n, n));
  body.kg_inertial_computed.fill(false);
  for (auto& K_G : body.kg_external) K_G.setZero();
  std::set<std::size_t> set;
  for (std::size_t i = 0; i < given_.geometric.size(); ++i) {
    const auto& g = given_.geometric[i];
    const MatrixXd K_G = body.full_phi.transpose() * (K_G_[i] * body.full_phi);
    if (g.inertial >= 0) {
      body.kg_inertial[static_cast<std::size_t>(g.inertial)] = K_G;
      body.kg_inertial_computed[static_cast<std::size_t>(g.inertial)] = true;
      continue;
    }
    if (!g.load.empty()) add_locator(body, g, F_[i]);
    const auto found = std::find_if(body.locators.begin(), body.locators.end(), [&](const auto& locator) {
      return g.node > 0 ? locator.node == g.node && locator.direction == g.direction : locator.name == g.name;
    });
    BOUGH_DEMAND(found != body.locators.end());
    const auto e = static_cast<std::size_t>(found - body.locators.begin());
    found->name = g.name;
    body.kg_external[e] = K_G;
    set.insert(e);
  }
  warn_of_stiffening(body, set);
}

void MatrixReduction::warn_of_stiffening(const FlexBody& body, const std::set<std::size_t>& set) {
  const auto num_inertial = std::count(body.kg_inertial_computed.begin(), body.kg_inertial_computed.end(), true);
  if (num_inertial == 0)
    diagnostics_.warning("reduce.no-stiffening", given_.K.at,
                         "no K_G of an inertial load is given: the body does not stiffen when it moves",
                         "give them in [body.matrices.inertial], or reduce the deck itself");
  std::string names;
  for (std::size_t e = 0; e < body.locators.size(); ++e)
    if (set.count(e) == 0) names += (names.empty() ? "" : ", ") + body.locators[e].name;
  if (!names.empty() && (num_inertial > 0 || !set.empty()))
    diagnostics_.warning("reduce.no-stiffening", given_.K.at, "no K_G is given for " + names + ": it is taken as zero",
                         "give it in [[body.matrices.geometric]]");
}

/// Dofs that the matrix lacks are dependent in the deck, and follow, or zero in every mode: as they should be only
/// where a constraint holds them.
void MatrixReduction::warn_of_missing(const FlexBody& body) {
  std::set<int> held;
  for (const auto& grid : deck_.grids)
    if (grid.ps != 0) held.insert(grid.id);
  for (const auto& spc : deck_.spc) held.insert(spc.g);
  held.insert(given_.clamped.begin(), given_.clamped.end());
  std::set<int> grids;
  Eigen::Index first = -1;
  for (Eigen::Index i = 0; i < body.full_phi.rows(); ++i) {
    const int id = dof_map_(i, 0), code = dof_map_(i, 1);
    if (has_row_[static_cast<std::size_t>(i)] || code > 3 || held.count(id) > 0 || !body.full_phi.row(i).isZero(0))
      continue;
    if (first < 0) first = i;
    grids.insert(id);
  }
  if (grids.empty()) return;
  diagnostics_.warning("reduce.missing-dofs", given_.K.at,
                       given_.K.label + " has no row for translations of " + std::to_string(grids.size()) +
                           " points, the first " + describe_dof(dof_map_, first) + ": they are taken as zero",
                       "constrained ones are zero indeed; omitted ones cannot be recovered: name other output nodes");
}

FlexBody MatrixReduction::run() {
  check_spec();
  ReduceOptions options = options_;
  options.elements = [this](const Deck&, const fe::NodeTable& nodes, Diagnostics&) { return make_elements(nodes); };
  if (!given_.modes.Phi.empty()) options.modes = [this](const fe::System& system) { return calc_modes(system); };
  FlexBody body = reduce(keep_points(deck_, given_), make_spec(), options, diagnostics_);
  (is_lumped_ ? body.consistent : body.lumped) = {};
  body.integrals_method = spec_.integrals;
  set_geometric(body);
  warn_of_missing(body);
  if (!spec_.full) {
    body.set_mesh_shapes(body.full_phi);
    body.full_phi.resize(0, 0);
  }
  diagnostics_.throw_if_errors();
  return body;
}

}  // namespace

FlexBody reduce_matrices(const Deck& deck, const BodySpec& spec, const GivenMatrices& given,
                         const ReduceOptions& options, Diagnostics& diagnostics) {
  return MatrixReduction(deck, spec, given, options, diagnostics).run();
}

}  // namespace bough::stiffening
