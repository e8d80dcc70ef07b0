#include "modal/element_strain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/diagnostic.hpp"
#include "base/number_text.hpp"
#include "fe/linear/blas.hpp"
#include "fe/linear/ranks.hpp"
#include "fe/linear/residual.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "fe/matrices/vector_products.hpp"
#include "fe/model/element_loop.hpp"
#include "modal/canonical.hpp"
#include "modal/pencil.hpp"

namespace bough::modal::detail {
namespace {

using Eigen::Index;

constexpr int kMaxDofs = 24;         // of an element taken apart
constexpr double kRoundoff = 1e-13;  // of uᵀK_e u, over its parts
constexpr double kNoMotion = 1e-13;  // scaled principal stiffness of an element's rigid-body motions
constexpr double kNoStrain = 1e-22;  // energy over its parts: the square of the round-off of doubles
constexpr double kSoft = 1e-9;       // below this share of their parts, energies of K are looked at
constexpr double kSame = 1e-6;       // relative, of eigenvalues
constexpr double kShift = 1e-13;     // of diag K, which makes K definite
constexpr double kNoDigits = 1e16;   // parts over energy
constexpr double kSure = 1e-3;       // relative error up to which an eigenvalue is good
constexpr double kMatters = 1e-4;    // relative change of a frequency below which there is nothing to report
constexpr double kStiff = 1e6;       // largest over smallest stiffness of elements: they differ, not the mesh is fine

void add_element(const MatrixXd& K, const MatrixXd& u, int most_dofs, MatrixXd& forces, ElementStrain& strain) {
  const VectorXd diagonal = K.diagonal().cwiseAbs();
  const VectorXd parts = u.cwiseAbs2().transpose() * diagonal;
  strain.parts += parts;
  if (K.rows() > most_dofs) {
    forces = K * u;
    for (Index j = 0; j < u.cols(); ++j) {
      if (std::abs(u.col(j).dot(forces.col(j))) < kRoundoff * parts(j))
        forces.col(j).setZero();
      else
        strain.whole(j) += parts(j);
    }
    const MatrixXd energy = u.transpose() * forces;
    strain.energy += 0.5 * (energy + energy.transpose());
    return;
  }
  const VectorXd root = diagonal.cwiseSqrt();
  const VectorXd inverse = root.unaryExpr([](double r) { return r > 0 ? 1 / r : 0; });
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(MatrixXd(inverse.asDiagonal() * K * inverse.asDiagonal()));
  VectorXd kappa = solver.eigenvalues();
  for (double& k : kappa)
    if (std::abs(k) < kNoMotion) k = 0;
  const MatrixXd z = solver.eigenvectors().transpose() * (root.asDiagonal() * u);
  forces = root.asDiagonal() * (solver.eigenvectors() * (kappa.asDiagonal() * z));
  strain.energy += z.transpose() * (kappa.asDiagonal() * z);
}

/// The f-dofs of g-set fields U: the components along their CD axes.
MatrixXd take_fdofs(const fe::Model& model, const Eigen::Ref<const MatrixXd>& U) {
  MatrixXd X(model.num_fdofs(), U.cols());
  for (int i = 0; i < model.num_fdofs(); ++i) {
    const auto [id, component] = model.describe_fdof(i);
    const auto& node = model.node(model.find_node(id));
    const int c = component - 1, row = node.first_gdof;
    if (node.num_dofs == 6)
      X.row(i) = node.R_basic_cd.col(c % 3).transpose() * U.middleRows(row + 3 * (c / 3), 3);
    else
      X.row(i) = U.row(row);
  }
  return X;
}

/// Some modes of a system, made better by the strain of its elements.
class SoftModes {
 public:
  SoftModes(const fe::System& system, const Pencil& pencil, MatrixXd X)
      : pencil_(pencil), factor_(shift(system), false, linear::FactorMethod::Pivoting), X_(std::move(X)) {}

  /// False if nothing came of it.
  bool improve() {
    if (factor_.is_singular()) return false;
    double before = std::numeric_limits<double>::infinity();
    for (int step = 0; step < 12; ++step) {
      find_ritz();
      const MatrixXd r = forces_ - M_X_ * theta_.asDiagonal();
      const MatrixXd correction = factor_.solve(r);
      eta_ = r.cwiseProduct(correction).colwise().sum().transpose().cwiseMax(0.0).cwiseSqrt();
      for (Index j = 0; j < eta_.size(); ++j)
        eta_(j) = theta_(j) > 0 ? eta_(j) * std::sqrt((1 + kShift * parts_(j) / theta_(j)) / theta_(j)) : 0;
      if (!eta_.allFinite() || !theta_.allFinite()) return false;
      const double worst = eta_.maxCoeff();
      if (worst < 1e-12 || (step > 2 && worst > 0.9 * before)) return true;
      before = worst;
      X_ -= correction;
    }
    find_ritz();
    return true;
  }

  const MatrixXd& X() const { return X_; }
  const MatrixXd& M_X() const { return M_X_; }
  const MatrixXd& forces() const { return forces_; }  ///< of the f-set
  const VectorXd& theta() const { return theta_; }    ///< exactly zero without strain
  /// Relative: η, or the roundoff of elements that are not taken apart; 1 where K has no digit of the mode left, by
  /// which others may be missing.
  double calc_error(Index j) const {
    if (theta_(j) <= 0) return 0;
    return parts_(j) > kNoDigits * theta_(j) ? 1 : std::max(eta_(j), 1e-15 * whole_(j) / theta_(j));
  }

 private:
  linear::SymmetricMatrix shift(const fe::System& system) const {
    return linear::add_diagonal(system.K, kShift * linear::fill_diagonal(system.K_diagonal, pencil_.kinds));
  }

  void find_ritz() {
    // Mass is summed by elements: where constraints have large factors, sums over the f-set lose digits of the mass
    // too.
    const auto& model = pencil_.model;
    orthonormalize_ascending(fe::calc_mass_gram(model, model.mass_kind(), model.T() * X_), X_);
    const auto strain = calc_element_strain(pencil_.model, pencil_.model.T() * X_, true);
    MatrixXd V;
    theta_ = calc_graded_eigenvalues(strain.energy, V);
    std::vector<Index> order(static_cast<std::size_t>(theta_.size()));
    std::iota(order.begin(), order.end(), Index{0});
    parts_ = V.cwiseAbs2().transpose() * strain.parts;
    whole_ = V.cwiseAbs2().transpose() * strain.whole;
    for (Index j = 0; j < theta_.size(); ++j)
      if (theta_(j) <= kNoStrain * parts_(j)) theta_(j) = 0;
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return theta_(a) < theta_(b); });
    theta_ = theta_(order).eval();
    parts_ = parts_(order).eval();
    whole_ = whole_(order).eval();
    V = V(Eigen::all, order).eval();
    X_ = (X_ * V).eval();
    M_X_ = pencil_.calc_M_times(X_);
    forces_ = pencil_.model.T().transpose() * (strain.forces * V);
  }

  const Pencil& pencil_;
  linear::SymmetricFactor factor_;
  MatrixXd X_, M_X_, forces_;
  VectorXd theta_, eta_, parts_, whole_;
};

/// Puts the improved modes in the place of the `soft` ones and sorts all.
void replace(const Pencil& pencil, const SoftModes& better, const std::vector<Index>& soft, EigenPairs& pairs) {
  const VectorXd residual = linear::calc_pair_residuals(pencil.K_diagonal, pencil.M_diagonal, better.theta(),
                                                        better.X(), better.forces(), better.M_X(), pencil.kinds);
  for (std::size_t i = 0; i < soft.size(); ++i) {
    const auto c = static_cast<Index>(i);
    pairs.lambda(soft[i]) = better.theta()(c);
    pairs.residual(soft[i]) = residual(c);
    pairs.Phi.col(soft[i]) = pencil.model.T() * better.X().col(c);
  }
  std::vector<Index> order(static_cast<std::size_t>(pairs.lambda.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return pairs.lambda(a) < pairs.lambda(b); });
  pairs.lambda = pairs.lambda(order).eval();
  pairs.residual = pairs.residual(order).eval();
  pairs.Phi = pairs.Phi(Eigen::all, order).eval();
  pairs.num_rigid = static_cast<int>((pairs.lambda.array() == 0).count());
  fix_signs(pairs.Phi);
  pairs.modal_mass.resize(0), pairs.energy_share.resize(0);  // of what was before
}

}  // namespace

ElementStrain calc_element_strain(const fe::Model& model, const MatrixXd& X_g, bool decompose) {
  const Index m = X_g.cols();
  ElementStrain strain{MatrixXd::Zero(X_g.rows(), m), MatrixXd::Zero(m, m), VectorXd::Zero(m), VectorXd::Zero(m)};
  MatrixXd K, u, forces;
  fe::visit_elements(model, fe::get_own_elements(model), [&](int, const fe::Element& element) {
    K.setZero(element.num_dofs(), element.num_dofs());
    model.add_stiffness(element, K);
    if (K.isZero(0)) return;
    u = X_g(element.gdofs(), Eigen::all);
    add_element(K, u, decompose ? kMaxDofs : 0, forces, strain);
    for (int i = 0; i < element.num_dofs(); ++i) strain.forces.row(element.gdofs()[i]) += forces.row(i);
  });
  linear::sum_over_ranks(strain.forces);
  linear::sum_over_ranks(strain.energy);
  MatrixXd parts(m, 2);
  parts << strain.parts, strain.whole;
  linear::sum_over_ranks(parts);
  strain.parts = parts.col(0);
  strain.whole = parts.col(1);
  return strain;
}

VectorXd calc_graded_eigenvalues(MatrixXd G, MatrixXd& V) {
  const Index n = G.rows();
  V = MatrixXd::Identity(n, n);
  for (int sweep = 0; sweep < 40; ++sweep) {
    bool is_diagonal = true;
    for (Index p = 0; p < n; ++p)
      for (Index q = p + 1; q < n; ++q) {
        const double g = G(p, q);
        if (!(std::abs(g) > 1e-15 * std::sqrt(std::abs(G(p, p) * G(q, q))))) continue;
        is_diagonal = false;
        const double ratio = (G(q, q) - G(p, p)) / (2 * g);
        const double t = (ratio < 0 ? -1 : 1) / (std::abs(ratio) + std::hypot(1.0, ratio));
        const double c = 1 / std::hypot(1.0, t);
        const double low = G(p, p) - t * g, high = G(q, q) + t * g;
        Eigen::JacobiRotation<double> J(c, c * t);
        G.applyOnTheLeft(p, q, J.adjoint());
        G.applyOnTheRight(p, q, J);
        V.applyOnTheRight(p, q, J);
        G(p, p) = low;
        G(q, q) = high;
        G(p, q) = G(q, p) = 0;
      }
    if (is_diagonal) break;
  }
  return G.diagonal();
}

namespace {

/// The stiffest element, by translations, rotations and scalar points each; empty if stiffness differs by less than
/// kStiff.
std::string find_stiffest(const fe::Model& model) {
  std::vector<int> kind_of(static_cast<std::size_t>(model.num_gdofs()), 0);
  for (const auto& node : model.nodes())
    for (int c = 0; c < node.num_dofs; ++c)
      kind_of[static_cast<std::size_t>(node.first_gdof + c)] = node.num_dofs == 1 ? 2 : c / 3;
  std::array<double, 3> min_size{}, max_size{};
  std::array<std::string, 3> name;
  for (const auto& element : model.elements()) {
    MatrixXd K = MatrixXd::Zero(element->num_dofs(), element->num_dofs());
    element->add_stiffness(1, K);
    std::array<double, 3> size{};
    for (int i = 0; i < element->num_dofs(); ++i) {
      double& s = size[static_cast<std::size_t>(
          kind_of[static_cast<std::size_t>(element->gdofs()[static_cast<std::size_t>(i)])])];
      s = std::max(s, std::abs(K(i, i)));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(size[k] > 0)) continue;
      if (!(min_size[k] > 0) || size[k] < min_size[k]) min_size[k] = size[k];
      if (size[k] > max_size[k]) max_size[k] = size[k], name[k] = element->card() + " " + std::to_string(element->id());
    }
  }
  std::string stiffest;
  double ratio = kStiff;
  for (std::size_t k = 0; k < 3; ++k) {
    if (min_size[k] > 0 && max_size[k] / min_size[k] > ratio) ratio = max_size[k] / min_size[k], stiffest = name[k];
  }
  return stiffest;
}

/// Blocks of given matrices are no separate structures: their energies are no strain.
bool has_given_blocks(const fe::Model& model) { return model.has_card("DMIG"); }

}  // namespace

Restored restore_digits(const fe::System& system, int number, bool is_from_first, EigenPairs& pairs) {
  const fe::Model& model = system.model;
  if (has_given_blocks(model)) return {};
  if (model.prestress() || model.omitted() || pairs.lambda.size() == 0) return {};
  // Modes below the last soft one are included: their errors would grow by the ratio of the eigenvalues.
  Index num_soft = 0;
  for (Index j = 0; j < pairs.energy_share.size(); ++j)
    if (pairs.energy_share(j) < kSoft) num_soft = j + 1;
  if (num_soft == 0) return {};
  const Pencil pencil(system);
  const MatrixXd X = take_fdofs(model, pairs.Phi.leftCols(num_soft));
  std::vector<Index> soft(static_cast<std::size_t>(num_soft));
  std::iota(soft.begin(), soft.end(), Index{0});
  const bool has_values = std::any_of(soft.begin(), soft.end(), [&](Index j) { return pairs.lambda(j) != 0; });
  const auto strain = calc_element_strain(model, pairs.Phi.leftCols(num_soft), has_values);
  const auto is_same = [&](std::size_t i) {
    const auto c = static_cast<Index>(i);
    const double lambda = pairs.lambda(soft[i]), energy = strain.energy(c, c);
    return lambda == 0 ? energy <= kNoStrain * strain.parts(c)
                       : std::abs(energy - lambda) <= kSame * std::abs(lambda) + 1e-15 * strain.whole(c);
  };
  bool is_all_same = true;
  for (std::size_t i = 0; i < soft.size(); ++i) is_all_same = is_all_same && is_same(i);
  if (is_all_same) return {};
  if (!is_from_first) return {true, 1, {}};

  const VectorXd before = pairs.lambda;
  SoftModes better(system, pencil, X);
  if (!better.improve()) return {};
  Restored result;
  result.is_done = true;
  int num_changed = 0;
  for (std::size_t i = 0; i < soft.size() && soft[i] < number; ++i) {
    const auto c = static_cast<Index>(i);
    const double old = before(soft[i]), now = better.theta()(c);
    if (now == 0 && old == 0) continue;
    result.error = std::max(result.error, better.calc_error(c));
    const double f_old = std::sqrt(std::max(0.0, old)) / (2 * M_PI), f_now = std::sqrt(now) / (2 * M_PI);
    const double change = f_now > 0 ? std::abs(f_now - f_old) / f_now : 1;
    if (change > kMatters && ++num_changed <= 3) {
      result.changes += (num_changed > 1 ? ", " : "") + std::string("mode ") + std::to_string(soft[i] + 1) + " from " +
                        show_number(f_old, 4) + " to " + show_number(f_now, 4) + " Hz";
      if (change < 0.1) result.changes += " (by " + show_number(100 * change, 4) + " %)";
    }
  }
  if (num_changed > 3) result.changes += " and " + std::to_string(num_changed - 3) + " more";
  if (!result.changes.empty() || !(result.error < kSure)) result.stiffest = find_stiffest(model);
  replace(pencil, better, soft, pairs);
  return result;
}

void warn_of_lost_digits(const Restored& restored, Diagnostics& diagnostics) {
  const bool is_sure = restored.error < kSure;
  if (!restored.is_done || (restored.changes.empty() && is_sure)) return;
  diagnostics.warning(
      "modal.lost-digits", {},
      "the sums of the assembled stiffness matrix have lost digits of soft modes; by the strain of the elements " +
          (restored.changes.empty() ? "the modes are as they were" : restored.changes) +
          (is_sure              ? ", right to about " + show_number(std::max(1e-15, restored.error), 4)
           : restored.error < 1 ? ", not reliable: they may be off by " + show_number(restored.error, 4) + " and more"
                                : ", not reliable: K has no digit of them, and others may be missing"),
      restored.stiffest.empty()
          ? "a coarser mesh keeps more digits: elements far shorter than the waves of the modes only add round-off"
          : "replace the stiffest elements, " + restored.stiffest +
                " first, by rigid ones; forces in them are round-off");
}

}  // namespace bough::modal::detail
