#include "fe/matrices/grid_point_weight.hpp"

#include <Eigen/Eigenvalues>

#include "fe/matrices/assembly.hpp"

namespace bough::fe {

namespace {

/// Axes of a symmetric matrix, each turned to the one of the given axes that it is nearest to: a diagonal matrix keeps
/// its order.
Matrix3d find_axes(const Matrix3d& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(A);
  const Matrix3d V = solver.eigenvectors();
  Matrix3d axes;
  std::array<bool, 3> taken{};
  for (int i = 0; i < 3; ++i) {
    int best = -1;
    for (int j = 0; j < 3; ++j)
      if (!taken[static_cast<std::size_t>(j)] && (best < 0 || std::abs(V(i, j)) > std::abs(V(i, best)))) best = j;
    taken[static_cast<std::size_t>(best)] = true;
    axes.col(i) = V(i, best) < 0 ? Vector3d(-V.col(best)) : Vector3d(V.col(best));
  }
  if (axes.determinant() < 0) axes.col(2) *= -1;
  return axes;
}

bool is_diagonal(const Matrix3d& A, double limit) {
  const Matrix3d off = A - Matrix3d(A.diagonal().asDiagonal());
  return off.norm() <= limit * A.diagonal().norm();
}

}  // namespace

GridPointWeight calc_grid_point_weight(const Eigen::Matrix<double, 6, 6>& MO) {
  GridPointWeight r;
  r.MO = MO;
  const Matrix3d Mt = MO.topLeftCorner<3, 3>();
  if (!is_diagonal(Mt, 1e-3)) r.S = find_axes(Mt);  // Nastran's limit
  const Matrix3d mt = r.S.transpose() * Mt * r.S, mtr = r.S.transpose() * MO.topRightCorner<3, 3>() * r.S,
                 mr = r.S.transpose() * MO.bottomRightCorner<3, 3>() * r.S;
  r.mass = mt.diagonal();
  const auto per = [&](int i, double moment) { return r.mass[i] != 0 ? moment / r.mass[i] : 0; };
  r.cg << per(0, mtr(0, 0)), per(0, -mtr(0, 2)), per(0, mtr(0, 1)),  //
      per(1, mtr(1, 2)), per(1, mtr(1, 1)), per(1, -mtr(1, 0)),      //
      per(2, -mtr(2, 1)), per(2, mtr(2, 0)), per(2, mtr(2, 2));
  const auto& c = r.cg;
  const Vector3d& m = r.mass;
  r.I_S(0, 0) = mr(0, 0) - m[1] * c(1, 2) * c(1, 2) - m[2] * c(2, 1) * c(2, 1);
  r.I_S(1, 1) = mr(1, 1) - m[2] * c(2, 0) * c(2, 0) - m[0] * c(0, 2) * c(0, 2);
  r.I_S(2, 2) = mr(2, 2) - m[0] * c(0, 1) * c(0, 1) - m[1] * c(1, 0) * c(1, 0);
  r.I_S(0, 1) = r.I_S(1, 0) = -mr(0, 1) - m[2] * c(2, 0) * c(2, 1);
  r.I_S(0, 2) = r.I_S(2, 0) = -mr(0, 2) - m[1] * c(1, 0) * c(1, 2);
  r.I_S(1, 2) = r.I_S(2, 1) = -mr(1, 2) - m[0] * c(0, 1) * c(0, 2);
  // The tensor has the products of inertia with the other sign.
  Matrix3d tensor = -r.I_S;
  tensor.diagonal() *= -1;
  if (!is_diagonal(tensor, 1e-12)) r.Q = find_axes(tensor);
  r.I_Q = (r.Q.transpose() * tensor * r.Q).diagonal();
  return r;
}

GridPointWeight calc_grid_point_weight(const Model& model, int grid) {
  Vector3d reference = Vector3d::Zero();
  if (grid > 0) {
    const int index = model.find_node(grid);
    if (index < 0 || model.node(index).num_dofs != 6)
      throw InputError("fe.missing-grid", {},
                       "the weight table names grid " + std::to_string(grid) + ", which the deck does not define",
                       "name a grid of the deck, or 0 for the origin");
    reference = model.node(index).x;
  }
  const double wtmass = model.wtmass() != 0 ? model.wtmass() : 1;
  auto result = calc_grid_point_weight(
      Eigen::Matrix<double, 6, 6>(calc_mass_properties(model, model.mass_kind(), reference).rigid_mass / wtmass));
  result.grid = std::max(grid, 0);
  result.reference = reference;
  return result;
}

}  // namespace bough::fe
