#include "modal/response/response_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "fe/linear/blas.hpp"
#include "fe/linear/products.hpp"
#include "fe/matrices/assembly.hpp"
#include "fe/statics/static_case.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::response {
namespace {

/// Largest number of directions of dampers that become separate residual vectors.
constexpr int kMaxDamperDirections = 60;

/// Eigenvalue of a residual vector over that of the highest mode, from which on it has no mass (a frequency 1000 times
/// as high): with more of them M and K lose their digits, with fewer mass is neglected.
constexpr double kMasslessResidual = 1e6;

MatrixXd join_columns(const MatrixXd& A, const MatrixXd& B) {
  MatrixXd C(A.rows(), A.cols() + B.cols());
  C << A, B;
  return C;
}

MatrixXd times_mass(const fe::Model& model, const MatrixXd& X) {
  return fe::calc_mass_times(model, model.mass_kind(), X);
}
/// Forces of the viscous dampers, in directions that span them; of the modes where the dampers are many.
MatrixXd calc_damper_loads(const fe::Model& model, const MatrixXd& Phi) {
  const auto none = MatrixXd(model.num_gdofs(), 0);
  if (!fe::has_damping(model)) return none;
  const auto B = fe::gather_sparse(fe::assemble_damping(model, fe::DofSet::Global));
  std::vector<int> rows;
  for (int i = 0; i < B.num_rows; ++i) {
    const auto first = B.data.begin() + B.indptr[static_cast<std::size_t>(i)];
    const auto last = B.data.begin() + B.indptr[static_cast<std::size_t>(i) + 1];
    if (std::any_of(first, last, [](double b) { return b != 0; })) rows.push_back(i);
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  if (n == 0) return none;
  if (n > 6 * kMaxDamperDirections) return fe::calc_damping_times(model, Phi);
  MatrixXd dense = MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(rows[static_cast<std::size_t>(i)]);
    for (int k = B.indptr[row]; k < B.indptr[row + 1]; ++k) {
      const auto at = std::lower_bound(rows.begin(), rows.end(), B.indices[static_cast<std::size_t>(k)]);
      if (at != rows.end() && *at == B.indices[static_cast<std::size_t>(k)])
        dense(i, at - rows.begin()) = B.data[static_cast<std::size_t>(k)];
    }
  }
  // Rows by their own size: forces and moments have other units.
  VectorXd root = dense.diagonal().cwiseAbs().cwiseSqrt();
  for (double& r : root) r = r > 0 ? r : 1;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
      linear::symmetrize(root.cwiseInverse().asDiagonal() * dense * root.cwiseInverse().asDiagonal()));
  const VectorXd size = solver.eigenvalues().cwiseAbs();
  MatrixXd loads = none;
  for (Eigen::Index c = 0; c < n; ++c) {
    if (!(size(c) > detail::kDampedDirection * size.maxCoeff())) continue;
    VectorXd load = VectorXd::Zero(model.num_gdofs());
    load(rows) = root.cwiseProduct(solver.eigenvectors().col(c));
    loads = join_columns(loads, load);
  }
  return loads.cols() > kMaxDamperDirections ? fe::calc_damping_times(model, Phi) : loads;
}

bool is_off_diagonal(const MatrixXd& A) {
  for (Eigen::Index j = 0; j < A.cols(); ++j)
    for (Eigen::Index i = 0; i < A.rows(); ++i)
      if (i != j && std::abs(A(i, j)) > detail::kDampingCoupling * std::sqrt(std::abs(A(i, i) * A(j, j)))) return true;
  return false;
}

/// K X without K2PP.
MatrixXd times_structure(const fe::Model& model, const DampingChoice& damping, const MatrixXd& X) {
  MatrixXd Y = fe::calc_stiffness_times(model, X);
  if (damping.times_direct) Y -= damping.times_direct(X);
  return Y;
}

/// Columns of A that are not zero.
MatrixXd take_nonzero(const MatrixXd& A) {
  std::vector<int> kept;
  for (Eigen::Index c = 0; c < A.cols(); ++c)
    if (!A.col(c).isZero(0)) kept.push_back(static_cast<int>(c));
  return A(Eigen::all, kept);
}

/// Loads K u0 and K v0, of which the start is the static solution.
MatrixXd calc_start_loads(const fe::Model& model, const StartMotion& start) {
  MatrixXd loads(model.num_gdofs(), 0);
  for (const auto* u : {&start.u, &start.v})
    if (u->size() > 0) loads = join_columns(loads, fe::calc_stiffness_times(model, *u));
  return loads;
}

class Maker {
 public:
  Maker(const fe::Model& model, const ModeBasis& modes, const bases::StaticSolve& solve, const DampingChoice& damping,
        Diagnostics& diagnostics)
      : model_(model), modes_(modes), solve_(solve), damping_(damping), diagnostics_(diagnostics) {}

  ResponseModel make(const Excitation& excitation, const StartMotion& start, bool with_residuals) {
    ResponseModel r;
    const auto k = excitation.D.cols();
    r.Psi = MatrixXd(model_.num_gdofs(), k);
    if (k > 0) {
      const MatrixXd moved = model_.T_fixed() * excitation.D;
      r.Psi = moved + solve_(-fe::calc_stiffness_times(model_, moved));
    }
    MatrixXd loads = excitation.F;
    for (const auto& more :
         {times_mass(model_, r.Psi), times_damping(model_, damping_, r.Psi), times_structural(model_, damping_, r.Psi)})
      loads = join_columns(loads, more);
    more_loads_ = excitation.residual;
    choose_shapes(loads, start, with_residuals, r);
    const auto num_dynamic = r.Phi.cols();
    if (with_residuals) add_massless(join_columns(loads, calc_inner_loads(elastic())), r);
    r.P = r.Phi.transpose() * loads;
    damp(r, k);
    const auto Phi = r.Phi.leftCols(num_dynamic);
    if (start.u.size() > 0) r.u0 = Phi.transpose() * times_mass(model_, start.u);
    if (start.v.size() > 0) r.v0 = Phi.transpose() * times_mass(model_, start.v);
    return r;
  }

 private:
  /// Static solutions in the a-set; omitted DOFs follow it.
  MatrixXd solve_within(const MatrixXd& F) const {
    MatrixXd U = solve_(F);
    if (model_.omitted()) U -= model_.omitted()(F);
    return U;
  }
  Eigen::Index num_elastic() const { return modes_.lambda.size() - modes_.num_rigid; }
  MatrixXd rigid() const { return modes_.Phi.leftCols(modes_.num_rigid); }
  MatrixXd elastic() const { return modes_.Phi.rightCols(num_elastic()); }

  /// Forces of dampers, and of structural damping where that is not of one measure throughout: then it is no K.
  MatrixXd calc_inner_loads(const MatrixXd& Phi) const {
    const MatrixXd loads = calc_damper_loads(model_, Phi);
    if (damping_.is_over_time && damping_.w4 <= 0) return loads;
    const MatrixXd X = Phi.leftCols(std::min<Eigen::Index>(Phi.cols(), kMaxDamperDirections));
    MatrixXd S = fe::calc_structural_damping_times(model_, 0, X);
    if (S.size() == 0 || S.isZero(0)) return loads;
    const MatrixXd K = fe::calc_stiffness_times(model_, X);
    const double even = S.cwiseProduct(K).sum() / K.squaredNorm();
    if ((S - even * K).norm() < detail::kEvenDamping * S.norm()) return loads;
    return join_columns(loads, S);
  }

  /// Ritz pairs of residual vectors up to the eigenvalue `max_lambda`. Those above have negligible mass and would
  /// degrade the orthogonality of the others; add_massless() has their flexibility. The first pass finds them, the
  /// second is orthonormal to round-off.
  bases::ModeSet separate(MatrixXd X, double max_lambda) const {
    bases::ModeSet modes;
    for (int pass = 0; pass < 2 && X.cols() > 0; ++pass) {
      const auto pairs = bases::calc_ritz_pairs(
          linear::symmetrize(linear::calc_inner_products(X, times_mass(model_, X))),
          linear::symmetrize(linear::calc_inner_products(X, fe::calc_stiffness_times(model_, X))));
      const auto num = (pairs.lambda.array() <= max_lambda).count();
      modes.lambda = pairs.lambda.head(num);
      X = (X * pairs.N.leftCols(num)).eval();
    }
    modes.Phi = std::move(X);
    return modes;
  }

  void choose_shapes(const MatrixXd& loads, const StartMotion& start, bool with_residuals, ResponseModel& r) {
    MatrixXd kept = elastic();
    VectorXd lambda = modes_.lambda.tail(num_elastic());
    if (with_residuals) {
      // B Ψ lies in the loads of the dampers; K_s Ψ is negligible.
      const auto k = r.Psi.cols(), m = loads.cols() - 3 * k;
      MatrixXd F = take_nonzero(
          join_columns(join_columns(loads.leftCols(m + k), calc_inner_loads(kept)), calc_start_loads(model_, start)));
      if (more_loads_.cols() > 0) F = join_columns(F, more_loads_);
      const auto solve = [this](const MatrixXd& loads_g) { return solve_within(loads_g); };
      const auto residual = bases::calc_residual_vectors(model_, solve, rigid(), kept, F);
      if (residual.modes.lambda.size() > 0) {
        const double highest = lambda.size() > 0 ? lambda(lambda.size() - 1) : residual.modes.lambda(0);
        const auto pseudo = separate(residual.modes.Phi, kMasslessResidual * highest);
        kept = join_columns(kept, pseudo.Phi);
        lambda.conservativeResize(kept.cols());
        lambda.tail(pseudo.lambda.size()) = pseudo.lambda;
      }
    }
    r.num_rigid = modes_.num_rigid;
    r.num_normal = static_cast<int>(modes_.lambda.size());
    r.Phi = join_columns(rigid(), kept);
    r.lambda = VectorXd::Zero(r.Phi.cols());
    r.lambda.tail(lambda.size()) = lambda;
    const int out = modes_.num_left_out;
    if (out == 0) return;
    left_out_ = r.Phi.leftCols(out);
    left_out_lambda_ = r.lambda.head(out);
    r.Phi = r.Phi.rightCols(r.Phi.cols() - out).eval();
    r.lambda = r.lambda.tail(r.Phi.cols()).eval();
    r.num_rigid = std::max(0, r.num_rigid - out);
    r.num_normal -= out;
  }

  /// Adds the remainder of the static solutions in the shapes if its work is above 1e-10 of that of the load: its mass
  /// is negligible, or a residual vector would have it. Orthonormal in K.
  void add_massless(const MatrixXd& loads, ResponseModel& r) const {
    const MatrixXd Phi_r = rigid(), F = bases::equilibrate(model_, Phi_r, loads);
    MatrixXd rest = solve_within(F);
    if (Phi_r.cols() > 0) rest -= Phi_r * (Phi_r.transpose() * times_mass(model_, rest));
    const VectorXd work = rest.cwiseProduct(F).colwise().sum();
    const auto take = [&](const MatrixXd& Phi, const VectorXd& lambda) {
      for (Eigen::Index j = 0; j < lambda.size(); ++j)
        if (lambda(j) > 0) rest -= Phi.col(j) * (Phi.col(j).transpose() * F) / lambda(j);
    };
    take(r.Phi, r.lambda);
    take(left_out_, left_out_lambda_);
    // The rest may be 1e-5 of the static solution, whose round-off is along the shapes: it is removed again by K.
    const auto clean = [&](const MatrixXd& Phi, const VectorXd& lambda) {
      const MatrixXd products = Phi.transpose() * fe::calc_stiffness_times(model_, rest);
      for (Eigen::Index j = 0; j < lambda.size(); ++j)
        if (lambda(j) > 0) rest -= Phi.col(j) * (products.row(j) / lambda(j));
    };
    for (int pass = 0; pass < 2; ++pass) {
      clean(r.Phi, r.lambda);
      clean(left_out_, left_out_lambda_);
    }
    const VectorXd energy = rest.cwiseProduct(fe::calc_stiffness_times(model_, rest)).colwise().sum();
    std::vector<int> kept;
    for (Eigen::Index c = 0; c < rest.cols(); ++c) {
      const double left = energy(c);
      if (!(work(c) > 0) || !(left > detail::kLeftWork * work(c))) continue;
      rest.col(c) /= std::sqrt(left);
      kept.push_back(static_cast<int>(c));
    }
    if (kept.empty()) return;
    const MatrixXd X = rest(Eigen::all, kept);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> gram(
        linear::symmetrize(linear::calc_inner_products(X, fe::calc_stiffness_times(model_, X))));
    const auto num = (gram.eigenvalues().array() > detail::kDependentVector).count();
    const MatrixXd Z =
        X * gram.eigenvectors().rightCols(num) * gram.eigenvalues().tail(num).cwiseSqrt().cwiseInverse().asDiagonal();
    r.num_massless = static_cast<int>(num);
    r.Phi = join_columns(r.Phi, Z);
    r.lambda.conservativeResize(r.lambda.size() + num);
    r.lambda.tail(num).setOnes();
  }

  double calc_ratio(const ResponseModel& r, Eigen::Index j) const {
    double hz = std::sqrt(std::max(r.lambda(j), 0.0)) / (2 * std::numbers::pi);
    // Residual vectors lie far above the modes: there the curve keeps its end value.
    if (j >= r.num_normal) hz = std::min(hz, damping_.curve->points.back().first);
    return calc_damping_ratio(*damping_.curve, hz);
  }

  /// k: motions of the supports.
  void damp(ResponseModel& r, Eigen::Index k) const {
    const auto n = r.lambda.size();
    r.D = linear::symmetrize(linear::calc_inner_products(r.Phi, fe::calc_damping_times(model_, r.Phi)));
    r.S = MatrixXd::Zero(n, n);
    const MatrixXd K_e =
        linear::symmetrize(linear::calc_inner_products(r.Phi, fe::calc_structural_damping_times(model_, 0, r.Phi)));
    MatrixXd K = r.lambda.asDiagonal();
    if (damping_.times_direct) K -= linear::symmetrize(r.Phi.transpose() * damping_.times_direct(r.Phi));
    const MatrixXd K_g = damping_.g * K;
    const auto num = r.num_dynamic();
    r.D += damping_.alpha2 * K;
    r.D.diagonal().head(num).array() += damping_.alpha1;
    if (damping_.is_over_time) {
      if (damping_.w4 > 0) r.D += K_e / damping_.w4;
      if (damping_.w3 > 0) r.D += K_g / damping_.w3;
    } else {
      r.S = K_e + K_g;
    }
    if (damping_.curve) add_curve(r, k);
    r.is_coupled = is_off_diagonal(r.D) || is_off_diagonal(r.S);
    if (damping_.is_over_time && r.num_massless > 0) {
      if (r.D.bottomRows(r.num_massless).cwiseAbs().maxCoeff() > detail::kMasslessDamping * r.D.cwiseAbs().maxCoeff())
        diagnostics_.warning("modal.massless-damper", {},
                             "damping acts on motions without mass: over time they follow their loads at once",
                             "give the grids of these dampers some mass; bough frequency has no such limit");
      r.is_coupled = is_off_diagonal(r.D.topLeftCorner(num, num));
    }
    r.damping_ratio = VectorXd::Zero(n);
    for (Eigen::Index j = 0; j < num; ++j)
      if (r.lambda(j) > 0)
        r.damping_ratio(j) = r.D(j, j) / (2 * std::sqrt(r.lambda(j))) + r.S(j, j) / (2 * r.lambda(j));
  }

  void add_curve(ResponseModel& r, Eigen::Index k) const {
    const auto m = r.P.cols() - 3 * k;
    for (Eigen::Index j = 0; j < r.num_dynamic(); ++j) {
      if (!(r.lambda(j) > 0)) continue;
      const double ratio = calc_ratio(r, j), omega = std::sqrt(r.lambda(j));
      if (ratio < 0 && !diagnostics_.has("modal.negative-damping")) {
        char text[96];
        std::snprintf(text, sizeof text, "the damping of %.6g at %.6g Hz is below 0", ratio,
                      omega / (2 * std::numbers::pi));
        diagnostics_.warning("modal.negative-damping", {},
                             "TABDMP1 " + std::to_string(damping_.curve->id) + ": " + text,
                             "the table goes on along its last line; give it a point beyond the highest mode");
      }
      const bool is_structural = damping_.is_stiffness && !damping_.is_over_time;
      const double c = 2 * ratio * (is_structural ? r.lambda(j) : omega);
      (is_structural ? r.S : r.D)(j, j) += c;
      // On the absolute motion: c (q̇ + P_M ḋ), of the loads B Ψ (-ḋ) or K_s Ψ (-i d).
      if (!damping_.is_relative) r.P.block(j, m + (is_structural ? 2 * k : k), 1, k) += c * r.P.block(j, m, 1, k);
    }
  }

  const fe::Model& model_;
  const ModeBasis& modes_;
  const bases::StaticSolve& solve_;
  const DampingChoice& damping_;
  Diagnostics& diagnostics_;
  MatrixXd more_loads_;  ///< Excitation::residual
  MatrixXd left_out_;    ///< modes below V1 or LFREQ
  VectorXd left_out_lambda_;
};

}  // namespace

MatrixXd times_damping(const fe::Model& model, const DampingChoice& damping, const MatrixXd& X) {
  MatrixXd Y = fe::calc_damping_times(model, X);
  if (damping.alpha1 != 0) Y += damping.alpha1 * times_mass(model, X);
  if (damping.alpha2 != 0) Y += damping.alpha2 * times_structure(model, damping, X);
  if (!damping.is_over_time) return Y;
  if (damping.w4 > 0) Y += fe::calc_structural_damping_times(model, 0, X) / damping.w4;
  if (damping.w3 > 0) Y += damping.g / damping.w3 * times_structure(model, damping, X);
  return Y;
}
MatrixXd times_structural(const fe::Model& model, const DampingChoice& damping, const MatrixXd& X) {
  if (damping.is_over_time) return MatrixXd::Zero(X.rows(), X.cols());
  return fe::calc_structural_damping_times(model, 0, X) + damping.g * times_structure(model, damping, X);
}

StartMotion calc_start(const fe::Model& model, const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                       Diagnostics& diagnostics) {
  StartMotion start;
  const int set = subcase.dynamics.ic;
  if (set == 0) return start;
  VectorXd u = VectorXd::Zero(model.num_fdofs()), v = u;
  bool is_found = false;
  for (const auto& card : deck.dynamics.initial) {
    if (card.sid != set) continue;
    is_found = true;
    const int row = find_dof(model, deck, card.g, card.c, "TIC", card.at, diagnostics);
    if (row < 0) continue;
    const int index = model.find_node(card.g);
    const int f = model.find_fdof(index, model.node(index).num_dofs == 1 ? 0 : card.c);
    if (f < 0) {
      diagnostics.error("modal.initial-held", deck.locate(card.at),
                        "TIC moves grid " + std::to_string(card.g) + " component " + std::to_string(card.c) +
                            ", which is fixed or follows other dofs",
                        "give the start of the dofs that it follows, or leave it out");
      continue;
    }
    u[f] = card.u0;
    v[f] = card.v0;
  }
  if (!is_found)
    diagnostics.error("modal.missing-initial", deck.locate(subcase.find_command("IC")),
                      "IC = " + std::to_string(set) + " names no TIC card of the deck",
                      "add the cards or correct the id");
  if (!u.isZero(0)) start.u = model.T() * u;
  if (!v.isZero(0)) start.v = model.T() * v;
  start.u_free = std::move(u);
  start.v_free = std::move(v);
  return start;
}

ResponseModel make_response_model(const fe::Model& model, const ModeBasis& modes, const bases::StaticSolve& solve,
                                  const Excitation& excitation, const StartMotion& start, const DampingChoice& damping,
                                  bool with_residuals, Diagnostics& diagnostics) {
  return Maker(model, modes, solve, damping, diagnostics).make(excitation, start, with_residuals);
}

void select_modes(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase, int num_left_out,
                  ResponseModel& r, Diagnostics& diagnostics) {
  const int id = subcase.dynamics.modsel;
  if (id == 0) return;
  const auto at = deck.locate(subcase.find_command("MODSEL"));
  const auto set = subcase.dynamics.sets.find(id);
  if (set == subcase.dynamics.sets.end()) {
    diagnostics.error("modal.missing-set", at,
                      "MODSEL = " + std::to_string(id) + " names a SET that the case control does not define before it",
                      "write SET " + std::to_string(id) + " = numbers of modes");
    return;
  }
  std::vector<int> kept, dynamic;
  int num_rigid = 0, num_normal = 0;
  for (int j = 0; j < r.lambda.size(); ++j) {
    const bool is_normal = j < r.num_normal;
    if (is_normal && !set->second.contains(num_left_out + j + 1)) continue;
    kept.push_back(j);
    num_rigid += j < r.num_rigid;
    num_normal += is_normal;
    if (j < r.num_dynamic()) dynamic.push_back(j);
  }
  if (num_normal == 0)
    diagnostics.error(
        "modal.empty-selection", at,
        "SET " + std::to_string(id) + " of MODSEL has no number of the " + std::to_string(r.num_normal) + " modes",
        "correct the set, or compute more modes");
  r.Phi = r.Phi(Eigen::all, kept).eval();
  r.lambda = r.lambda(kept).eval();
  r.P = r.P(kept, Eigen::all).eval();
  r.D = r.D(kept, kept).eval();
  r.S = r.S(kept, kept).eval();
  r.damping_ratio = r.damping_ratio(kept).eval();
  if (r.u0.size() > 0) r.u0 = r.u0(dynamic).eval();
  if (r.v0.size() > 0) r.v0 = r.v0(dynamic).eval();
  r.num_rigid = num_rigid;
  r.num_normal = num_normal;
}

}  // namespace bough::modal::response
