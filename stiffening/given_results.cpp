// Given modes and given geometric stiffness.
#include <algorithm>
#include <cstdio>
#include <set>

#include "fe/linear/factor.hpp"
#include "stiffening/given_checks.hpp"
#include "stiffening/given_model.hpp"

namespace bough::stiffening {

using records::FlexBody;

namespace {

/// φᵀKφ relative to φᵀ|diag K|φ of a mode with strain. The digits of a file leave 1e-14 in rigid-body modes (1e-7
/// squared); a bending wave of 1,500 elements has as little as this.
constexpr double kMinStrain = 1e-11;
/// Distance of a shape from the mode of K and M, relative to the size of the mode in M. Printed shapes of four digits
/// are below; shapes of another model are of the order of 1.
constexpr double kMaxModeError = 1e-3;

/// Warns of given shapes that are no modes of K and M, by one step of inverse iteration: x = (λ + σ)(K + σ M)⁻¹ M x of
/// a mode of K and M, λ its Rayleigh quotient. Measured in M, so that the last digits of printed shapes, which strain a
/// fine mesh as much as the mode itself, do not count.
void report_unrelated_modes(const GivenModel& given, const fe::System& system, const MatrixXd& Phi,
                            const std::vector<int>& elastic, Diagnostics& diagnostics) {
  const fe::Model& model = system.model;
  const auto kind = model.mass_kind();
  const MatrixXd X = Phi(Eigen::all, elastic), M_X = fe::calc_mass_times(model, kind, X);
  const VectorXd mass = X.cwiseProduct(M_X).colwise().sum(),
                 stiffness = X.cwiseProduct(fe::calc_stiffness_times(model, X)).colwise().sum();
  if (X.cols() == 0 || !(mass.minCoeff() > 0) || model.num_fdofs() == 0) return;  // reduce.no-modal-mass reports it
  const VectorXd lambda = stiffness.cwiseQuotient(mass);
  const double shift = lambda.minCoeff();
  const linear::SymmetricMatrix shifted = linear::add(system.K, shift, system.M);
  const linear::SymmetricFactor factor(shifted, true, linear::FactorMethod::Pivoting);
  if (factor.is_singular()) return;
  const MatrixXd f = model.T().transpose() * M_X;
  const MatrixXd E = X - model.T() * (factor.solve(f) * (lambda.array() + shift).matrix().asDiagonal());
  const VectorXd wrong =
      E.cwiseProduct(fe::calc_mass_times(model, kind, E)).colwise().sum().transpose().cwiseQuotient(mass).cwiseSqrt();
  Eigen::Index worst = 0;
  const auto num = (wrong.array() > kMaxModeError).count();
  if (num == 0 || !(wrong.maxCoeff(&worst) > kMaxModeError)) return;
  char share[32];
  std::snprintf(share, sizeof share, "%.1e", wrong[worst]);
  diagnostics.warning("reduce.modes-residual", given.matrices.modes.Phi.at,
                      std::to_string(num) + " of the " + std::to_string(X.cols()) + " modes of " +
                          given.matrices.modes.Phi.label + " are no modes of K and M: mode " +
                          std::to_string(elastic[static_cast<std::size_t>(worst)] + 1) + " is off by " + share +
                          " of its size",
                      "look whether they are of the same model, constraints, units and order of dofs; shapes that are "
                      "meant (Ritz vectors) are kept as they are");
}

void report_missing_stiffness(const GivenMatrix& K, const FlexBody& body, const std::set<std::size_t>& given,
                              Diagnostics& diagnostics) {
  const auto num_inertial = std::count(body.kg_inertial_computed.begin(), body.kg_inertial_computed.end(), true);
  if (num_inertial == 0)
    diagnostics.warning("reduce.no-stiffening", K.at,
                        "no K_G of an inertial load is given: the body does not stiffen when it moves",
                        "give them in [body.matrices.inertial], or reduce the deck itself");
  std::string names;
  for (std::size_t e = 0; e < body.locators.size(); ++e)
    if (given.count(e) == 0) names += (names.empty() ? "" : ", ") + body.locators[e].name;
  if (!names.empty() && (num_inertial > 0 || !given.empty()))
    diagnostics.warning("reduce.no-stiffening", K.at, "no K_G is given for " + names + ": it is taken as zero",
                        "give it in [[body.matrices.geometric]]");
}

}  // namespace

MatrixXd calc_given_modes(const GivenModel& given, const fe::System& system, Diagnostics& diagnostics) {
  const fe::Model& model = system.model;
  const MatrixXd& Phi = given.Phi;
  // Rigid-body modes of a free body: its frame has them already.
  const VectorXd diagonal = linear::get_diagonal(fe::assemble_stiffness(model, fe::DofSet::Global)).cwiseAbs();
  const MatrixXd K_Phi = fe::calc_stiffness_times(model, Phi);
  std::vector<int> elastic;
  for (int j = 0; j < Phi.cols(); ++j) {
    const double scale = Phi.col(j).cwiseAbs2().dot(diagonal);
    if (Phi.col(j).dot(K_Phi.col(j)) > kMinStrain * scale) elastic.push_back(j);
  }
  if (static_cast<Eigen::Index>(elastic.size()) < Phi.cols())
    diagnostics.note("reduce.rigid-modes", given.matrices.modes.Phi.at,
                     std::to_string(Phi.cols() - static_cast<Eigen::Index>(elastic.size())) + " of the " +
                         std::to_string(Phi.cols()) + " modes of " + given.matrices.modes.Phi.label +
                         " have no strain and are left out");
  if (given.matrices.modes.eigenvalue.size() == Phi.cols())
    compare_eigenvalues(model, given.matrices.modes, Phi, diagnostics);
  report_unrelated_modes(given, system, Phi, elastic, diagnostics);
  return Phi(Eigen::all, elastic);
}

void add_given_patterns(const GivenModel& given, std::vector<LoadPattern>& patterns) {
  for (std::size_t i = 0; i < given.F.size(); ++i) {
    if (given.F[i].size() == 0) continue;
    auto& pattern = patterns.emplace_back();
    pattern.group = pattern.locator.name = given.matrices.geometric[i].name;
    pattern.load.F = given.F[i];
  }
}

void set_given_stiffness(const BodyRequest& request, const MatrixXd& Phi, FlexBody& body) {
  const GivenModel& given = *request.given;
  const MatrixXd zero = MatrixXd::Zero(Phi.cols(), Phi.cols());
  body.kg_inertial.fill(zero);
  body.kg_inertial_computed.fill(false);
  body.kg_external.assign(body.locators.size(), zero);
  std::set<std::size_t> locators;
  for (std::size_t i = 0; i < given.K_G.size(); ++i) {
    const auto& g = given.matrices.geometric[i];
    const MatrixXd K_G = Phi.transpose() * (given.K_G[i] * Phi);
    if (g.inertial >= 0) {
      body.kg_inertial[static_cast<std::size_t>(g.inertial)] = K_G;
      body.kg_inertial_computed[static_cast<std::size_t>(g.inertial)] = true;
      continue;
    }
    const auto found = std::find_if(body.locators.begin(), body.locators.end(), [&](const auto& locator) {
      return g.node > 0 ? locator.node == g.node && locator.direction == g.direction : locator.name == g.name;
    });
    BOUGH_DEMAND(found != body.locators.end());
    const auto e = static_cast<std::size_t>(found - body.locators.begin());
    found->name = g.name;
    body.kg_external[e] = K_G;
    locators.insert(e);
  }
  report_missing_stiffness(given.matrices.K, body, locators, request.diagnostics);
}

/// A constrained dof is zero as it should be; a dependent one follows others.
void report_missing_rows(const BodyRequest& request, const MatrixXd& Phi) {
  const GivenModel& given = *request.given;
  const Eigen::MatrixXi dof_map = given.points.calc_dof_map();
  std::set<int> constrained;
  for (const auto& grid : request.deck.grids)
    if (grid.ps != 0) constrained.insert(grid.id);
  for (const auto& spc : request.deck.spc) constrained.insert(spc.g);
  constrained.insert(given.matrices.clamped.begin(), given.matrices.clamped.end());
  std::set<int> grids;
  Eigen::Index first = -1;
  for (Eigen::Index i = 0; i < Phi.rows(); ++i) {
    const int id = dof_map(i, 0), code = dof_map(i, 1);
    if (given.has_row[static_cast<std::size_t>(i)] || code > 3 || constrained.count(id) > 0 || !Phi.row(i).isZero(0))
      continue;
    if (first < 0) first = i;
    grids.insert(id);
  }
  if (grids.empty()) return;
  request.diagnostics.warning(
      "reduce.missing-dofs", given.matrices.K.at,
      given.matrices.K.label + " has no row for translations of " + std::to_string(grids.size()) +
          " points, the first " + describe_dof(dof_map, first) + ": they are taken as zero",
      "constrained ones are zero indeed; omitted ones cannot be recovered: name other output nodes");
}

}  // namespace bough::stiffening
