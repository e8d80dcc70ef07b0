#include "modal/bases/basis.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <numeric>

#include "fe/linear/blas.hpp"
#include "fe/linear/products.hpp"
#include "fe/model/model_size.hpp"
#include "modal/canonical.hpp"
#include "modal/null_motions.hpp"
#include "modal/pencil.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::bases {

using records::ModeKind;

namespace {

MatrixXd join(const MatrixXd& A, const MatrixXd& B) {
  MatrixXd C(A.rows(), A.cols() + B.cols());
  C << A, B;
  return C;
}
VectorXd join(const VectorXd& a, const VectorXd& b) {
  VectorXd c(a.size() + b.size());
  c << a, b;
  return c;
}
MatrixXd times_M(const fe::Model& model, const MatrixXd& X) { return fe::calc_mass_times(model, model.mass_kind(), X); }
VectorXd calc_norms(const fe::Model& model, const MatrixXd& X) {
  return X.cwiseProduct(times_M(model, X)).colwise().sum().cwiseMax(0).cwiseSqrt();
}
MatrixXd calc_gram_M(const fe::Model& model, const MatrixXd& X) {
  return linear::symmetrize(linear::calc_inner_products(X, times_M(model, X)));
}
MatrixXd calc_gram_K(const fe::Model& model, const MatrixXd& X) {
  return linear::symmetrize(linear::calc_inner_products(X, fe::calc_stiffness_times(model, X)));
}

/// Unit loads on the interface dofs: Tᵀ of them is the row of T that a boundary dof is.
MatrixXd calc_interface_loads(const fe::Model& model, const Partition& part) {
  MatrixXd F = MatrixXd::Zero(model.num_gdofs(), part.num_boundary());
  for (int b = 0; b < part.num_boundary(); ++b) {
    const auto [id, component] = part.boundary[static_cast<std::size_t>(b)];
    const auto& node = model.node(model.find_node(id));
    const int c = component - 1;
    F.block<3, 1>(node.first_gdof + 3 * (c / 3), b) = node.R_basic_cd.col(c % 3);
  }
  return F;
}

/// One basis of each repeated root and the sign of each vector, so that they do not depend on roundoff.
MatrixXd make_canonical(const fe::Model& model, VectorXd& lambda, MatrixXd& Phi) {
  MatrixXd Q = MatrixXd::Identity(lambda.size(), lambda.size());
  detail::make_canonical(
      detail::calc_basis_weights(model), [](const MatrixXd& Y) { return Y; }, lambda, Phi, &Q);
  detail::fix_signs(Phi);
  return Q;
}

/// `kind` for the `count` entries of largest share.
void mark_largest(const VectorXd& share, Eigen::Index count, ModeKind kind, std::vector<ModeKind>& kinds) {
  std::vector<int> order(kinds.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return share(a) > share(b); });
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(count, share.size()); ++i)
    kinds[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])] = kind;
}

std::string format_percent(double part) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * part);
  return text;
}

/// Normal modes of the model, then the residual vectors of the interface and of the loads.
Basis calc_free_interface_basis(const fe::System& system, const BasisOptions& options, const StaticSolve& solve,
                                Diagnostics& diagnostics) {
  const fe::Model& model = system.model;
  Basis basis;
  EigenOptions eigen;
  eigen.num_modes = options.num_modes > 0 || !options.max_hz ? options.num_modes + (options.is_free ? 6 : 0) : 0;
  if (!options.max_hz) eigen.num_modes = std::max(eigen.num_modes, 1);
  eigen.max_hz = options.max_hz;
  eigen.factor = options.factor;
  eigen.solver = options.solver;
  const auto pairs = calc_normal_modes(system, eigen, diagnostics);
  basis.num_rigid = pairs.num_rigid;
  basis.num_massless = pairs.num_massless;
  const auto num_pairs = static_cast<int>(pairs.lambda.size());
  if (num_pairs > 0) basis.check = {num_pairs, pairs.inertia_count, pairs.residual.maxCoeff(), pairs.solvers};
  auto kept = pairs.lambda.size() - pairs.num_rigid;
  if (options.num_modes == 0 && !options.max_hz) kept = 0;
  // A massless rigid-body motion is none of the requested modes: the modes computed in excess are dropped.
  if (options.num_modes > 0) kept = std::min<Eigen::Index>(kept, options.num_modes);
  basis.Phi = pairs.Phi.middleCols(pairs.num_rigid, kept);
  basis.lambda = pairs.lambda.segment(pairs.num_rigid, kept);
  basis.kind.assign(static_cast<std::size_t>(kept), ModeKind::Normal);

  MatrixXd F = options.residual_loads;
  if (F.rows() == 0) F.resize(model.num_gdofs(), 0);
  Eigen::Index num_attachments = 0;
  std::vector<std::pair<int, int>> boundary;
  if (options.kind == BasisKind::CraigChang) {
    const auto part = make_partition(model, options.interface_nodes, diagnostics);
    F = join(calc_interface_loads(model, part), F);
    num_attachments = part.num_boundary();
    boundary = part.boundary;
  }
  const auto residual = calc_residual_vectors(model, solve, pairs.Phi.leftCols(pairs.num_rigid), basis.Phi, F);
  basis.Phi = join(basis.Phi, residual.modes.Phi);
  basis.lambda = join(basis.lambda, residual.modes.lambda);
  const auto num_unused =
      std::count_if(residual.unused.begin(), residual.unused.end(), [&](int i) { return i < num_attachments; }) +
      std::count_if(residual.massless.begin(), residual.massless.end(),
                    [&](const auto& lost) { return lost.first < num_attachments; });
  std::vector<ModeKind> kinds(static_cast<std::size_t>(residual.modes.lambda.size()), ModeKind::Residual);
  mark_largest(residual.share.topRows(num_attachments).colwise().sum(), num_attachments - num_unused,
               ModeKind::Attachment, kinds);
  basis.kind.insert(basis.kind.end(), kinds.begin(), kinds.end());
  // The eigenvectors are exact to the tolerance of Krylov-Schur only: their strain energy with the new vectors is
  // projected out.
  if (!kinds.empty()) {
    const auto pairs_all = calc_ritz_pairs(calc_gram_M(model, basis.Phi), calc_gram_K(model, basis.Phi));
    basis.Phi = basis.Phi * pairs_all.N;
    basis.lambda = pairs_all.lambda;
    make_canonical(model, basis.lambda, basis.Phi);
  }
  std::string lost;
  for (const auto& [i, part] : residual.massless) {
    if (i >= num_attachments) {
      basis.massless_loads.emplace_back(i - static_cast<int>(num_attachments), part);
      continue;
    }
    const auto [id, component] = boundary[static_cast<std::size_t>(i)];
    lost += (lost.empty() ? "" : ", ") + std::string(component > 3 ? "turning" : "motion") + " of grid " +
            std::to_string(id) + (component > 3 ? " about " : " along ") + "xyz"[(component - 1) % 3] + " (" +
            format_percent(part) + ")";
  }
  if (!lost.empty())
    diagnostics.warning(
        "modal.massless-interface", {}, "what moves no mass has no attachment mode; lost of the flexibility in " + lost,
        "a hinge there meets a stiffer body; give the model inertia there, or take fewer modes, if it should "
        "not");
  for (const int i : residual.unused)
    if (i >= num_attachments) basis.unused_loads.push_back(i - static_cast<int>(num_attachments));
  const auto n = basis.lambda.size();
  basis.M = MatrixXd::Identity(n, n);
  basis.K = basis.lambda.asDiagonal();
  return basis;
}

/// Describes the motion of the interface in each of the directions X of Craig-Bampton coordinates: "turning of grid 31
/// about (0.33 0.67 0.67)".
std::string describe_directions(const fe::Model& model, const Basis& basis, const MatrixXd& X) {
  constexpr double kRoundoff = 1e-9;
  const double size = std::max(fe::calc_model_size(model), std::numeric_limits<double>::min());
  std::vector<std::string> found;
  for (Eigen::Index c = 0; c < X.cols(); ++c) {
    std::map<std::pair<int, bool>, Vector3d> parts;  // by grid and whether it turns; translations in sizes of the model
    for (std::size_t b = 0; b < basis.boundary.size(); ++b) {
      const auto [id, component] = basis.boundary[b];
      auto& part = parts.try_emplace({id, component > 3}, Vector3d::Zero()).first->second;
      part += X(static_cast<Eigen::Index>(b), c) / (component > 3 ? 1 : size) *
              model.node(model.find_node(id)).R_basic_cd.col((component - 1) % 3);
    }
    const auto largest = std::max_element(parts.begin(), parts.end(), [](const auto& a, const auto& b) {
      return a.second.squaredNorm() < b.second.squaredNorm();
    });
    if (largest == parts.end()) continue;
    Vector3d axis = largest->second.normalized();
    Eigen::Index first = 0;
    axis.cwiseAbs().maxCoeff(&first);
    if (axis(first) < 0) axis = -axis;
    axis = (axis.array().abs() > kRoundoff).select(axis, 0.0);
    char numbers[80];
    std::snprintf(numbers, sizeof numbers, " (%.3g %.3g %.3g)", axis.x() + 0.0, axis.y() + 0.0, axis.z() + 0.0);
    const std::string direction = std::string(largest->first.second ? "turning of grid " : "motion of grid ") +
                                  std::to_string(largest->first.first) + (largest->first.second ? " about" : " along") +
                                  numbers;
    if (std::find(found.begin(), found.end(), direction) == found.end()) found.push_back(direction);
  }
  std::string text;
  for (const auto& direction : found) text += (text.empty() ? "" : ", ") + direction;
  return text;
}

/// K^N = M^ND of the component, twice: the second time nearly diagonal, for the digits of the lowest values.
void orthogonalize(const fe::Model& model, const MatrixXd& rigid, Eigen::Index num_constraint, Basis& basis,
                   Diagnostics& diagnostics) {
  constexpr double kRigid = 1e-9;  // relative remainder of a vector that is a rigid-body motion
  MatrixXd& Phi = basis.Phi;
  MatrixXd K = basis.K;
  if (rigid.cols() > 0) {
    const VectorXd before = calc_norms(model, Phi);
    for (int pass = 0; pass < 2; ++pass) Phi -= rigid * (times_M(model, rigid).transpose() * Phi).eval();
    const VectorXd after = calc_norms(model, Phi);
    // The constraint modes of a single grid: round-off of rigid elements is no shape.
    for (Eigen::Index j = 0; j < Phi.cols(); ++j) {
      if (after(j) > kRigid * before(j)) continue;
      Phi.col(j).setZero();
      K.row(j).setZero();
      K.col(j).setZero();
    }
  }
  MatrixXd N = MatrixXd::Identity(Phi.cols(), Phi.cols());
  for (int pass = 0; pass < 2; ++pass) {
    const auto pairs = calc_ritz_pairs(calc_gram_M(model, Phi), pass == 0 ? K : calc_gram_K(model, Phi));
    if (pass == 0 && pairs.massless.cols() > 0)
      diagnostics.warning("modal.massless-interface", {},
                          describe_directions(model, basis, pairs.massless) +
                              " moves no mass: it follows the other shapes without force",
                          "a hinge passes nothing in that direction; give the model inertia there if it should");
    MatrixXd orthogonal(Phi.rows(), pairs.N.cols());
    linear::multiply_dense(false, Phi, pairs.N, 0, orthogonal);
    Phi = std::move(orthogonal);
    N = N * pairs.N;
    basis.lambda = pairs.lambda;
  }
  N = N * make_canonical(model, basis.lambda, Phi);

  const auto n = basis.lambda.size();
  VectorXd constraint(n), residual(n);  // shares in the strain energy
  for (Eigen::Index j = 0; j < n; ++j) {
    const VectorXd b = N.col(j).head(num_constraint);
    constraint(j) = b.dot(K.topLeftCorner(num_constraint, num_constraint) * b) / basis.lambda(j);
    residual(j) = 0;
    for (Eigen::Index i = num_constraint; i < N.rows(); ++i)
      if (basis.kind[static_cast<std::size_t>(i)] == ModeKind::Residual)
        residual(j) += K(i, i) * N(i, j) * N(i, j) / basis.lambda(j);
  }
  const auto num_residual = std::count(basis.kind.begin(), basis.kind.end(), ModeKind::Residual);
  std::vector<ModeKind> kind(static_cast<std::size_t>(n), ModeKind::Normal);
  mark_largest(constraint, std::clamp<Eigen::Index>(num_constraint - rigid.cols(), 0, n), ModeKind::Constraint, kind);
  for (Eigen::Index j = 0; j < n; ++j)
    if (kind[static_cast<std::size_t>(j)] == ModeKind::Constraint) residual(j) = -1;
  mark_largest(residual, num_residual, ModeKind::Residual, kind);
  basis.kind = kind;
  basis.M = MatrixXd::Identity(n, n);
  basis.K = basis.lambda.asDiagonal();
}

/// Raw coordinates without the constraint modes that move no mass (the roll of a line of bars): no coordinate of
/// motion.
Basis drop_massless(const Basis& basis, Diagnostics& diagnostics) {
  const VectorXd mass = basis.M.diagonal();
  std::vector<int> columns;
  for (int j = 0; j < mass.size(); ++j) {
    if (j >= static_cast<int>(basis.boundary.size()) || mass(j) > detail::kMasslessCoordinate * mass.maxCoeff()) {
      columns.push_back(j);
      continue;
    }
    const auto [node, component] = basis.boundary[static_cast<std::size_t>(j)];
    diagnostics.warning("modal.massless-constraint", {},
                        "the constraint mode of node " + std::to_string(node) + " component " +
                            std::to_string(component) + " moves no mass and is left out",
                        "give the model inertia about that axis, or hold it");
  }
  return static_cast<Eigen::Index>(columns.size()) == mass.size() ? basis : select_columns(basis, columns);
}

Basis calc_craig_bampton_basis(const fe::System& system, const BasisOptions& options, Diagnostics& diagnostics) {
  const fe::Model& model = system.model;
  Basis basis;
  MatrixXd rigid(model.num_gdofs(), 0);
  if (options.is_free) {
    const detail::Pencil pencil(system);
    auto motions = detail::find_rigid_motions(pencil);
    // AUTOSPC may hold a rotation of a pinned grid: then the motions are not those of one rigid body, but are there.
    constexpr Eigen::Index kNumRigid = 6;
    if (motions.modes.cols() + motions.massless.cols() < kNumRigid) motions = detail::find_null_motions(pencil);
    rigid = model.T() * motions.modes;
    basis.num_rigid = static_cast<int>(motions.modes.cols());
    basis.num_massless = static_cast<int>(motions.massless.cols());
  }
  const FixedInterface fixed(system, options.interface_nodes, diagnostics);
  basis.boundary = fixed.partition().boundary;
  const auto nb = static_cast<Eigen::Index>(basis.boundary.size());
  const MatrixXd Psi = fixed.calc_constraint_modes();
  const auto modes = fixed.calc_modes(options.num_modes, options.max_hz, diagnostics, options.solver);
  basis.check = modes.check;
  // A load is carried by the interface, which the constraint modes hold exactly, and by the interior with it held.
  MatrixXd F = options.residual_loads.rows() == 0 ? MatrixXd(model.num_gdofs(), 0) : options.residual_loads;
  if (options.is_free && F.cols() > 0) {
    // In equilibrium with the inertia of the body; what inertia balances of itself (a uniform acceleration) is nothing.
    const VectorXd before = F.colwise().norm();
    F = equilibrate(model, rigid, F);
    for (Eigen::Index c = 0; c < F.cols(); ++c)
      if (F.col(c).norm() < detail::kBalancedLoad * before(c)) F.col(c).setZero();
  }
  const auto residual = calc_residual_vectors(
      model, [&](const MatrixXd& loads) { return fixed.solve(loads); }, MatrixXd(model.num_gdofs(), 0), modes.Phi, F);
  basis.unused_loads = residual.unused;
  basis.massless_loads = residual.massless;

  const VectorXd lambda = join(modes.lambda, residual.modes.lambda);
  basis.Phi = join(Psi, join(modes.Phi, residual.modes.Phi));
  basis.kind.assign(static_cast<std::size_t>(nb), ModeKind::Constraint);
  basis.kind.insert(basis.kind.end(), static_cast<std::size_t>(modes.lambda.size()), ModeKind::Normal);
  basis.kind.insert(basis.kind.end(), static_cast<std::size_t>(residual.modes.lambda.size()), ModeKind::Residual);
  // K^ = diag(K_bb + K_bi Ψ, Λ): constraint modes and what moves with the interface held share no strain energy.
  basis.K = MatrixXd::Zero(basis.Phi.cols(), basis.Phi.cols());
  basis.K.topLeftCorner(nb, nb) = calc_gram_K(model, Psi);
  basis.K.bottomRightCorner(lambda.size(), lambda.size()) = lambda.asDiagonal();
  if (options.orthogonalize) {
    orthogonalize(model, rigid, nb, basis, diagnostics);
    return basis;
  }
  basis.is_raw = true;
  basis.M = calc_gram_M(model, basis.Phi);
  basis.lambda = basis.K.diagonal().cwiseQuotient(basis.M.diagonal());
  basis = drop_massless(basis, diagnostics);
  if (const auto massless = calc_ritz_pairs(basis.M, basis.K).massless; massless.cols() > 0)
    diagnostics.warning("modal.massless-interface", {},
                        describe_directions(model, basis, massless) + " moves no mass: the mass matrix is singular",
                        "give the model inertia in that direction, or hold it");
  return basis;
}

}  // namespace

Basis calc_basis(const fe::System& system, const BasisOptions& options, const StaticSolve& solve,
                 Diagnostics& diagnostics) {
  if (options.kind != BasisKind::Normal && options.interface_nodes.empty())
    throw InputError("modal.no-interface", {}, "the basis needs interface nodes", "name them in interface");
  if (options.kind == BasisKind::CraigBampton) return calc_craig_bampton_basis(system, options, diagnostics);
  return calc_free_interface_basis(system, options, solve, diagnostics);
}

Basis select_columns(const Basis& basis, const std::vector<int>& columns) {
  Basis kept = basis;
  kept.Phi = basis.Phi(Eigen::all, columns);
  kept.lambda = basis.lambda(columns);
  kept.M = basis.M(columns, columns);
  kept.K = basis.K(columns, columns);
  kept.kind.clear();
  kept.boundary.clear();
  for (const int c : columns) {
    kept.kind.push_back(basis.kind[static_cast<std::size_t>(c)]);
    if (basis.is_raw && c < static_cast<int>(basis.boundary.size()))
      kept.boundary.push_back(basis.boundary[static_cast<std::size_t>(c)]);
  }
  return kept;
}

void move_to_frame(const fe::Model& model, const FrameSpec& frame, Basis& basis) {
  const MatrixXd C = calc_reference_conditions(model, frame);
  const bool is_on_node = frame.kind == FrameKind::Node;
  if (basis.is_raw) {
    std::vector<int> columns;
    for (int j = 0; j < basis.lambda.size(); ++j)
      if (j >= static_cast<int>(basis.boundary.size()) || !is_on_node ||
          basis.boundary[static_cast<std::size_t>(j)].first != frame.nodes[0])
        columns.push_back(j);
    if (basis.lambda.size() - static_cast<Eigen::Index>(columns.size()) != 6)
      throw InputError("modal.raw-frame", {},
                       "Craig-Bampton coordinates that are kept hold the rigid-body motions of a free body",
                       "put the frame on an interface node, fix it by constraints, or orthogonalize");
    basis = select_columns(basis, columns);
  }
  basis.Phi = shift_to_frame(model, C, basis.Phi);
  // At rest, not at rest to roundoff: who asks whether the node moves must hear no.
  if (is_on_node) basis.Phi.middleRows(model.node(model.find_node(frame.nodes[0])).first_gdof, 6).setZero();
  basis.M = calc_gram_M(model, basis.Phi);
  if (basis.is_raw) basis.lambda = basis.K.diagonal().cwiseQuotient(basis.M.diagonal());
}

}  // namespace bough::modal::bases
