#include "modal/pencil.hpp"

#include <algorithm>
#include <cmath>

#include "fe/linear/blas.hpp"
#include "fe/linear/null_space.hpp"
#include "fe/linear/products.hpp"
#include "fe/linear/symmetric_matrix.hpp"
#include "fe/model/row_kinds.hpp"
#include "modal/canonical.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::detail {

using Eigen::Vector3d;

namespace {

/// Rows of the f-dofs of a g-set field: the displacement component along the f-dof's CD axis.
MatrixXd restrict_to_fdofs(const fe::Model& model, const MatrixXd& U) {
  MatrixXd X = MatrixXd::Zero(model.num_fdofs(), U.cols());
  const fe::Node* node = nullptr;
  int known = 0;  // its id
  for (int f = 0; f < model.num_fdofs(); ++f) {
    const auto [id, component] = model.describe_fdof(f);
    if (!node || id != known) node = &model.node(model.find_node(id));
    known = id;
    if (node->num_dofs != 6) continue;
    const int c = component - 1;
    X.row(f) = node->R_basic_cd.col(c % 3).transpose() * U.middleRows(node->first_gdof + 3 * (c / 3), 3);
  }
  return X;
}

/// Eigenvectors of the symmetric A whose eigenvalue is above (or not above) threshold times the largest.
MatrixXd calc_range(const MatrixXd& A, double threshold, bool above, VectorXd* values = nullptr) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(linear::symmetrize(A));
  const VectorXd& w = solver.eigenvalues();
  const double limit = threshold * std::max(w.size() ? w.maxCoeff() : 0.0, 0.0);
  const auto low = (w.array() <= limit).count();
  const auto first = above ? low : 0;
  const auto count = above ? w.size() - low : low;
  if (values) *values = w.segment(first, count);
  return solver.eigenvectors().middleCols(first, count);
}

/// Unit vectors of the dofs with mass and nothing at all that stiffens them.
MatrixXd find_loose(const Pencil& pencil) {
  VectorXd loose = VectorXd::Zero(pencil.size());
  Mat K = pencil.K.sparse();
  VectorXd coupled = VectorXd::Zero(pencil.size());  // by the part of low rank
  if (const auto* part = pencil.K.low_rank()) coupled = part->U.cwiseAbs() * VectorXd::Ones(part->rank());
  PetscInt first = 0, last = 0, num = 0;
  linear::check_petsc(MatGetOwnershipRange(K, &first, &last));
  const PetscScalar* values = nullptr;
  for (PetscInt row = first; row < last; ++row) {
    if (coupled(row) != 0 || pencil.K_diagonal(row) != 0 || !(pencil.M_diagonal(row) > 0)) continue;
    linear::check_petsc(MatGetRow(K, row, &num, nullptr, &values));
    loose(row) = std::all_of(values, values + num, [](double v) { return v == 0; });
    linear::check_petsc(MatRestoreRow(K, row, &num, nullptr, &values));
  }
  linear::sum_over_ranks(loose);
  MatrixXd X = MatrixXd::Zero(pencil.size(), static_cast<Eigen::Index>(loose.sum()));
  for (int f = 0, c = 0; f < pencil.size(); ++f)
    if (loose(f) > 0) X(f, c++) = 1;
  return X;
}

Vector3d calc_mean_position(const fe::Model& model) {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (const auto& node : model.nodes()) {
    if (node.num_dofs != 6) continue;
    sum += node.x;
    ++count;
  }
  return count ? (sum / count).eval() : sum;
}

/// The 30 displacement fields x^a e_k of degree 0..2 about the mean position, rotations half their curl, at the f-dofs
/// along their CD axes.
MatrixXd calc_polynomials(const fe::Model& model) {
  const Vector3d centre = calc_mean_position(model);
  double size = 0;
  for (const auto& node : model.nodes())
    if (node.num_dofs == 6) size = std::max(size, (node.x - centre).norm());
  if (size == 0) size = 1;
  MatrixXd X = MatrixXd::Zero(model.num_fdofs(), 30);
  Eigen::Matrix<double, 3, 30> displacement, rotation;
  int known = -1;
  for (int i = 0; i < model.num_fdofs(); ++i) {
    const auto [id, component] = model.describe_fdof(i);
    const auto& node = model.node(model.find_node(id));
    if (node.num_dofs != 6) continue;
    if (id != known) {
      const Vector3d x = (node.x - centre) / size;
      int column = 0;
      const auto add = [&](double value, const Vector3d& gradient) {
        for (int k = 0; k < 3; ++k, ++column) {
          displacement.col(column) = value * Vector3d::Unit(k);
          rotation.col(column) = 0.5 * gradient.cross(Vector3d::Unit(k)) / size;
        }
      };
      add(1, Vector3d::Zero());
      for (int a = 0; a < 3; ++a) add(x(a), Vector3d::Unit(a));
      for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b) add(x(a) * x(b), x(b) * Vector3d::Unit(a) + x(a) * Vector3d::Unit(b));
      known = id;
    }
    const int c = component - 1;
    X.row(i) = node.R_basic_cd.col(c % 3).transpose() * (c < 3 ? displacement : rotation);
  }
  return X;
}

}  // namespace

Pencil::Pencil(const fe::System& system)
    : model(system.model),
      K(system.K),
      M(system.M),
      K_diagonal(system.K_diagonal),
      M_diagonal(system.M_diagonal),
      kinds(fe::list_row_kinds(model)) {}

double Pencil::calc_relative_energy(const VectorXd& x, double energy) const {
  const double scale = x.cwiseAbs2().dot(K_diagonal);
  return scale > 0 ? std::abs(energy) / scale : 0;
}

MatrixXd Pencil::calc_mass_gram(const MatrixXd& X) const {
  MatrixXd G(X.cols(), X.cols());
  for (Eigen::Index c = 0; c < X.cols(); c += kColumnsAtOnce) {
    const auto num = std::min(kColumnsAtOnce, X.cols() - c);
    G.block(0, c, c + num, num) = dot(X.leftCols(c + num), calc_M_times(X.middleCols(c, num)));
  }
  G.triangularView<Eigen::StrictlyLower>() = G.transpose();
  return G;
}

MatrixXd find_forceless(const Pencil& pencil, const MatrixXd& Y, double floor) {
  Mat K = pencil.K.sparse();
  MatrixXd of_part, terms_of_part;
  if (const auto* part = pencil.K.low_rank()) {
    const MatrixXd t = part->U.transpose() * Y;
    of_part = part->U * (part->W * t);
    terms_of_part = part->U.cwiseAbs() * (part->W.cwiseAbs() * t.cwiseAbs());
  }
  PetscInt first = 0, last = 0, num = 0;
  linear::check_petsc(MatGetOwnershipRange(K, &first, &last));
  const PetscInt* columns = nullptr;
  const PetscScalar* values = nullptr;
  MatrixXd G = MatrixXd::Zero(Y.cols(), Y.cols());
  Eigen::RowVectorXd force(Y.cols()), terms(Y.cols());
  for (PetscInt row = first; row < last; ++row) {
    linear::check_petsc(MatGetRow(K, row, &num, &columns, &values));
    force.setZero(), terms.setZero();
    if (of_part.size() > 0) force = of_part.row(row), terms = terms_of_part.row(row);
    for (PetscInt k = 0; k < num; ++k)
      for (Eigen::Index c = 0; c < Y.cols(); ++c) {
        const double term = values[k] * Y(columns[k], c);
        force(c) += term;
        terms(c) += std::abs(term);
      }
    linear::check_petsc(MatRestoreRow(K, row, &num, &columns, &values));
    const double scale = terms.maxCoeff() + floor * std::sqrt(pencil.K_diagonal(row));
    if (scale > 0) force /= scale;
    G += force.transpose() * force;
  }
  linear::sum_over_ranks(G);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(G);
  return solver.eigenvectors().leftCols((solver.eigenvalues().array() < kForcelessSquare).count());
}

namespace {

/// D times the rigid-body motions about a point, D the diagonal of K, and of these Y, those without strain.
struct Strainless {
  MatrixXd DB, Y;
};

Strainless find_strainless(const Pencil& pencil, const Vector3d& centre) {
  const auto& model = pencil.model;
  const MatrixXd B = restrict_to_fdofs(model, model.calc_rigid_modes(centre));
  Strainless result{pencil.K_diagonal.asDiagonal() * B, MatrixXd(model.num_fdofs(), 0)};
  const MatrixXd D = linear::calc_inner_products(B, result.DB);
  const VectorXd scale = D.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  VectorXd d;
  const MatrixXd V = calc_range(scale.asDiagonal() * D * scale.asDiagonal(), kDependentMotions, true, &d);
  if (V.cols() == 0) return result;

  // Y: orthonormal under D. A second pass on the vectors themselves: products of the six basic motions cancel where one
  // motion is much softer than its parts (a turn about a skew axis), those of the motion itself do not.
  MatrixXd Y = B * (scale.asDiagonal() * V * d.cwiseSqrt().cwiseInverse().asDiagonal());
  VectorXd energy;
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(
        linear::calc_inner_products(Y, pencil.calc_K_times(Y)),
        linear::calc_inner_products(Y, pencil.K_diagonal.asDiagonal() * Y));
    energy = solver.eigenvalues();
    if (pass == 0 && energy.minCoeff() > kHeldEnergy) return result;
    Y = (Y * solver.eigenvectors()).eval();
  }
  std::vector<int> strainless;
  for (int i = 0; i < energy.size(); ++i)
    if (std::abs(energy(i)) < kStrainlessEnergy) strainless.push_back(i);
  if (strainless.empty()) return result;
  Y = Y(Eigen::all, strainless).eval();
  result.Y = Y * find_forceless(pencil, Y);
  return result;
}

/// Rigid-body motions of the whole model.
RigidMotions find_global_motions(const Pencil& pencil) {
  const auto& model = pencil.model;
  RigidMotions result;
  result.modes.resize(model.num_fdofs(), 0);
  result.massless.resize(model.num_fdofs(), 0);
  // A supported model needs no centre of mass.
  if (!model.fixed_dofs().empty() && find_strainless(pencil, calc_mean_position(model)).Y.cols() == 0) return result;
  const auto properties = fe::calc_mass_properties(model, model.mass_kind(), Vector3d::Zero());
  const Vector3d centre = properties.mass > 0 ? properties.cg : calc_mean_position(model);
  auto [DB, Y] = find_strainless(pencil, centre);
  if (Y.cols() == 0) return result;

  VectorXd mass;
  for (int pass = 0; pass < 2; ++pass) {
    const MatrixXd G = Y.transpose() * pencil.calc_M_times(Y);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(linear::symmetrize(G));
    Y = (Y * solver.eigenvectors()).eval();
    mass = solver.eigenvalues();
  }
  const auto num_massless = (mass.array() <= kMasslessShare * std::max(mass.maxCoeff(), 0.0)).count();
  const MatrixXd Y_mass = Y.rightCols(Y.cols() - num_massless);

  // The projections of the six motions on the free ones, in order: this basis does not depend on round-off.
  const MatrixXd P = Y_mass * (Y_mass.transpose() * DB);
  const MatrixXd MP = pencil.calc_M_times(P);
  MatrixXd coefficients(6, 0);
  const MatrixXd Mr = P.transpose() * MP;
  for (int i = 0; i < 6 && coefficients.cols() < Y_mass.cols(); ++i) {
    VectorXd c = VectorXd::Unit(6, i);
    for (int pass = 0; pass < 2; ++pass) c -= coefficients * (coefficients.transpose() * (Mr * c));
    const double after = c.dot(Mr * c);
    if (!(after > kOwnMassShare * Mr(i, i))) continue;
    coefficients.conservativeResize(6, coefficients.cols() + 1);
    coefficients.rightCols(1) = c / std::sqrt(after);
  }
  result.modes = P * coefficients;

  result.massless = Y.leftCols(num_massless);
  if (num_massless > 0) {
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(result.massless.transpose());
    for (Eigen::Index i = 0; i < num_massless; ++i)
      result.held.push_back(static_cast<int>(qr.colsPermutation().indices()(i)));
  }
  return result;
}

}  // namespace

RigidMotions find_rigid_motions(const Pencil& pencil) {
  auto result = find_global_motions(pencil);
  const MatrixXd loose = find_loose(pencil);
  if (loose.cols() == 0) {
    orthonormalize(pencil, result.modes);
    return result;
  }
  // Masses that RBE3 and MPC share out among loose dofs are fewer than these: some of their motions move none.
  const MatrixXd M = loose.transpose() * pencil.calc_M_times(loose);
  const VectorXd scale = M.diagonal().cwiseSqrt().cwiseInverse();
  const MatrixXd null =
      scale.asDiagonal() * calc_range(scale.asDiagonal() * M * scale.asDiagonal(), kLooseMassShare, false);
  if (null.cols() > 0) {
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(null.transpose());
    for (Eigen::Index i = 0; i < null.cols(); ++i) {
      Eigen::Index f = 0;
      loose.col(qr.colsPermutation().indices()(i)).maxCoeff(&f);
      result.held.push_back(static_cast<int>(f));
    }
    MatrixXd massless(pencil.size(), result.massless.cols() + null.cols());
    massless << result.massless, loose * null;
    result.massless = massless;
  }
  for (Eigen::Index c = 0; c < loose.cols(); ++c) {
    VectorXd x = loose.col(c);
    const double before = x.dot(pencil.calc_M_times(x).col(0));
    for (int pass = 0; pass < 2; ++pass) x -= result.modes * (result.modes.transpose() * pencil.calc_M_times(x)).eval();
    const double after = x.dot(pencil.calc_M_times(x).col(0));
    if (!(after > kLooseRestShare * before)) continue;
    result.modes.conservativeResize(Eigen::NoChange, result.modes.cols() + 1);
    result.modes.rightCols(1) = x / std::sqrt(after);
  }
  orthonormalize(pencil, result.modes);
  return result;
}

void orthonormalize(const Pencil& pencil, MatrixXd& modes) {
  for (int pass = 0; pass < 2 && modes.cols() > 0; ++pass)
    orthonormalize_ascending(modes.transpose() * pencil.calc_M_times(modes), modes);
}

double estimate_first_eigenvalue(const Pencil& pencil) {
  const MatrixXd X = calc_polynomials(pencil.model);
  const MatrixXd K = pencil.dot(X, pencil.calc_K_times(X));
  const MatrixXd M = pencil.dot(X, pencil.calc_M_times(X));
  const VectorXd scale = M.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  VectorXd m;
  const MatrixXd V = calc_range(scale.asDiagonal() * M * scale.asDiagonal(), kDependentPolynomials, true, &m);
  if (V.cols() > 0) {  // scalar points alone: none
    const MatrixXd W = scale.asDiagonal() * V * m.cwiseSqrt().cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(W.transpose() * K * W);
    const MatrixXd Y = X * (W * ritz.eigenvectors());
    for (Eigen::Index i = 0; i < Y.cols(); ++i) {
      const double lambda = ritz.eigenvalues()(i);
      if (lambda > 0 && pencil.calc_relative_energy(Y.col(i), lambda) > kStrainedEnergy) return lambda;
    }
  }
  // No polynomial strains the model: fall back on the softest single dof.
  double lowest = 0;
  for (int f = 0; f < pencil.size(); ++f) {
    if (pencil.M_diagonal(f) <= 0 || pencil.K_diagonal(f) <= 0) continue;
    const double ratio = pencil.K_diagonal(f) / pencil.M_diagonal(f);
    if (lowest == 0 || ratio < lowest) lowest = ratio;
  }
  return lowest > 0 ? lowest : 1;
}

std::string describe(const fe::Model& model, int fdof) {
  const auto [id, component] = model.describe_fdof(fdof);
  if (component == 0) return "scalar point " + std::to_string(id);
  return "grid " + std::to_string(id) + " component " + std::to_string(component);
}

void throw_singular(const Pencil& pencil, double shift) {
  const linear::SymmetricMatrix A = linear::add(pencil.K, shift, pencil.M);
  const MatrixXd motions = linear::find_mechanisms(A, pencil.kinds, 1);
  std::string where;
  for (Eigen::Index c = 0; c < motions.cols(); ++c) {
    Eigen::Index largest = 0;
    motions.col(c).cwiseAbs().maxCoeff(&largest);
    where += (c ? ", " : " at ") + describe(pencil.model, static_cast<int>(largest));
  }
  throw ComputationError("modal.singular-shift", {},
                         "the shifted stiffness matrix is singular: a part of the model can move without strain and "
                         "without mass" +
                             where,
                         "give that part mass, constrain it, or switch PARAM,AUTOSPC on");
}

}  // namespace bough::modal::detail
