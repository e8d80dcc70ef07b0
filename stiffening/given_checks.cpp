#include "stiffening/given_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace bough::stiffening {

namespace {

constexpr double kAsymmetry = 1e-6;  ///< relative to the largest entries of both rows: files of seven digits are below
constexpr double kMaxMassDifference = 1e-6;  ///< of rigid-body masses, relative to their mean: likewise

std::string show(double value, const char* format = "%.6g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// The first pair of rows where A differs from its transpose, beyond the digits of a file and roundoff.
std::optional<std::pair<int, int>> find_asymmetry(const SparseRows& A) {
  VectorXd largest = VectorXd::Zero(A.rows());  // of each row and column
  for (int i = 0; i < A.outerSize(); ++i)
    for (SparseRows::InnerIterator it(A, i); it; ++it)
      for (const auto k : {Eigen::Index(i), Eigen::Index(it.col())})
        largest[k] = std::max(largest[k], std::abs(it.value()));
  const double roundoff = 1e-12 * (A.rows() > 0 ? largest.maxCoeff() : 0.0);
  const SparseRows difference = A - SparseRows(A.transpose());
  for (int i = 0; i < difference.outerSize(); ++i)
    for (SparseRows::InnerIterator it(difference, i); it; ++it)
      if (std::abs(it.value()) > std::max(kAsymmetry * std::sqrt(largest[i] * largest[it.col()]), roundoff))
        return std::pair(i, static_cast<int>(it.col()));
  return {};
}

}  // namespace

std::string describe_dof(const Eigen::MatrixXi& dof_map, Eigen::Index gdof) {
  const int id = dof_map(gdof, 0), code = dof_map(gdof, 1);
  return code == 0 ? "scalar point " + std::to_string(id)
                   : "grid " + std::to_string(id) + " component " + std::to_string(code);
}

void check_symmetry(const GivenMatrix& given, Diagnostics& diagnostics) {
  const auto pair = find_asymmetry(given.values);
  if (!pair) return;
  const auto [i, j] = *pair;
  diagnostics.error("reduce.not-symmetric", given.at,
                    given.label + " is not symmetric: (" + std::to_string(i + 1) + ", " + std::to_string(j + 1) +
                        ") is " + show(given.values.coeff(i, j), "%.9g") + ", (" + std::to_string(j + 1) + ", " +
                        std::to_string(i + 1) + ") is " + show(given.values.coeff(j, i), "%.9g"),
                    "give a symmetric matrix: without follower loads, gyroscopic or friction terms");
}

void check_mass(const SparseRows& M, const GivenMatrix& given, const PointTable& points, Diagnostics& diagnostics) {
  const VectorXd diagonal = M.diagonal();
  for (Eigen::Index i = 0; i < diagonal.size(); ++i) {
    if (diagonal[i] >= 0) continue;
    diagnostics.error(
        "reduce.negative-mass", given.at,
        given.label + " has " + show(diagonal[i]) + " on the diagonal at " + describe_dof(points.calc_dof_map(), i),
        "give a mass matrix that is positive, or at least semidefinite");
    return;
  }
  const MatrixXd Phi_R = points.calc_nodal_dofs().calc_rigid_modes();
  const MatrixXd R = Phi_R.transpose() * (M * Phi_R);
  const double m = R.topLeftCorner<3, 3>().trace() / 3;
  if (!(m > 0)) {
    diagnostics.error("reduce.negative-mass", given.at,
                      "the translations of " + given.label + " carry the mass " + show(m) + ", expected more than zero",
                      "check that it is the mass matrix, and the list of dofs");
    return;
  }
  const Eigen::Matrix3d T = R.topLeftCorner<3, 3>(), S = R.topRightCorner<3, 3>();
  const double length = std::sqrt(std::max(R.bottomRightCorner<3, 3>().trace() / m, 0.0));
  const double off = std::max((T - m * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() / m,
                              length > 0 ? (S + S.transpose()).cwiseAbs().maxCoeff() / (m * length) : 0.0);
  if (off <= kMaxMassDifference) return;
  diagnostics.warning("reduce.not-rigid-mass", given.at,
                      "rigid-body motions have the masses " + show(T(0, 0)) + ", " + show(T(1, 1)) + ", " +
                          show(T(2, 2)) + " in x, y, z and differ from those of one rigid body by a part of " +
                          show(off, "%.2g") + ": mass, centre and inertia are means",
                      "give the matrix before supports and omitted dofs took their part; check axes and dofs");
}

void compare_eigenvalues(const fe::Model& model, const GivenModes& given, const MatrixXd& Phi,
                         Diagnostics& diagnostics) {
  const VectorXd k = Phi.cwiseProduct(fe::calc_stiffness_times(model, Phi)).colwise().sum();
  const VectorXd m = Phi.cwiseProduct(fe::calc_mass_times(model, model.mass_kind(), Phi)).colwise().sum();
  const VectorXd& lambda = given.eigenvalue;
  const double largest = lambda.cwiseAbs().maxCoeff();
  for (Eigen::Index j = 0; j < lambda.size(); ++j) {
    if (std::abs(lambda[j]) < 1e-6 * largest && std::abs(k[j]) < 1e-5 * largest * m[j]) continue;
    if (m[j] > 0 && std::abs(k[j] / m[j] - lambda[j]) <= 1e-3 * std::abs(lambda[j])) continue;
    diagnostics.warning("reduce.modes-differ", given.Phi.at,
                        "mode " + std::to_string(j + 1) + " of " + given.Phi.label + " has the eigenvalue " +
                            show(lambda[j]) + ", K and M give it " + show(m[j] > 0 ? k[j] / m[j] : 0.0),
                        "check that modes and matrices are of one run, their axes (CD) and dofs");
    return;
  }
}

}  // namespace bough::stiffening
