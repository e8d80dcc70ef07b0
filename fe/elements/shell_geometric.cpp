#include "fe/elements/geometric_projection.hpp"
#include "fe/elements/shell.hpp"
#include "fe/elements/shell_dofs.hpp"
#include "fe/linear/blas.hpp"

namespace bough::fe {

using namespace shell;

/// All that K_G takes from the internal forces of a load; docs/elements/shell.md.
template <int N>
struct Shell::SecondOrder {
  /// ∫ N_i,a (N, M)_ab N_j,b. Rows sum to zero: Σ_ij A_ij a_i b_j is -Σ_i<j A_ij (a_j - a_i)(b_j - b_i).
  Eigen::Matrix<double, N, N> NN = Eigen::Matrix<double, N, N>::Zero(), MM = NN;
  Eigen::Matrix<double, 3, N> on_slope;                                       ///< Nxx Nyy Nxy dA of each point
  Eigen::Matrix<double, N, 1> on_side = Eigen::Matrix<double, N, 1>::Zero();  ///< T: works on its mean shear
  Eigen::Matrix<double, N, 1> on_drilling;  ///< moments about z of triads against the surface
  Eigen::Matrix<double, 2, N> turn = Eigen::Matrix<double, 2, N>::Zero();  ///< factor of (θx, θy) θz / 2 of each node
  Eigen::Matrix<double, N, 1> on_arm = Eigen::Matrix<double, N, 1>::Zero();  ///< factor of -½ (θx² + θy²) of each node
};

namespace {

/// Where moments about z act: shape functions of the triad, and where the surface turns. Of the drilling penalty at the
/// points; of drilling rotations at the corners, against the surface in the middle, which their springs compare.
template <int N>
std::array<Point<N>, N> list_drilling(const ShellFields<N>& fields, const Corners<N>& xy) {
  if (!fields.membrane.has_rotations) return fields.points;
  std::array<Point<N>, N> result;
  result.fill(calc_centre<N>(xy));
  for (int i = 0; i < N; ++i) result[static_cast<std::size_t>(i)].shape = Eigen::Matrix<double, N, 1>::Unit(i);
  return result;
}

/// [8×N] The forces of each point times its area, moments as they work on curvatures: where these stretch the element
/// (strain_of_plate), with the work of the membrane forces on that.
template <int N>
Eigen::Matrix<double, 8, N> calc_working_forces(const ShellFields<N>& fields, const double* force) {
  Eigen::Matrix<double, 8, N> f = Eigen::Map<const Eigen::Matrix<double, 8, N>>(force);
  double area = 0;
  for (int q = 0; q < N; ++q) {
    f.col(q) *= fields.points[q].weight;
    area += fields.points[q].weight;
  }
  if (!fields.membrane.coupled) return f;
  const Eigen::Vector3d mean = f.template topRows<3>().rowwise().sum() / area;
  for (int q = 0; q < N; ++q)
    f.template block<3, 1>(3, q) +=
        fields.membrane.stretch.transpose() * (f.template block<3, 1>(0, q) - fields.points[q].weight * mean);
  return f;
}

}  // namespace

template <int N>
Shell::SecondOrder<N> Shell::calc_second_order(const ShellFields<N>& fields, const double* force) const {
  SecondOrder<N> s;
  const auto& plate = fields.plate;
  Eigen::Matrix<double, 2, N> arm_force = Eigen::Matrix<double, 2, N>::Zero();
  const Eigen::Matrix<double, kNumForces, N> forces = calc_working_forces<N>(fields, force);
  for (int q = 0; q < N; ++q) {
    const auto& point = fields.points[q];
    const auto f = forces.col(q);
    Eigen::Matrix2d n, m;
    n << f[0], f[2], f[2], f[1];
    m << f[3], f[5], f[5], f[4];
    const Eigen::Matrix<double, 2, N>&grad = point.dshape, m_grad = m * grad;
    s.NN.noalias() += grad.transpose() * (n * grad);
    s.MM.noalias() += grad.transpose() * m_grad;
    s.turn += m_grad;
    s.on_slope.col(q) = f.template head<3>();
    s.on_drilling[q] = (fields.membrane.has_rotations ? 1 : point.weight) * force[kNumForces * N + q];
    for (int k = 0; k < N; ++k)
      s.on_side[k] +=
          plate.side_bending[k][q].dot(f.template segment<3>(3)) + plate.side_shear[k][q].dot(f.template tail<2>());
    if (!has_arms_) continue;
    const Row<N> on_membrane = f.template head<3>().transpose() * fields.membrane.strain[q];
    for (int i = 0; i < N; ++i) arm_force.col(i) += on_membrane.template segment<2>(3 * i);
    if (fields.membrane.has_rotations) continue;
    for (int i = 0; i < N; ++i)
      arm_force.col(i) += s.on_drilling[q] * fields.membrane.spring[q].template segment<2>(3 * i);
  }
  // The springs of CQUADR act on displacements by the turn of the middle alone; all else of its moments sums to zero.
  if (has_arms_ && fields.membrane.has_rotations && fields.membrane.num_springs > 0) {
    const Row<N> turning = s.on_drilling.sum() * fields.membrane.spring[0];
    for (int i = 0; i < N; ++i) arm_force.col(i) += turning.template segment<2>(3 * i);
  }
  for (int k = 0; k < N; ++k) {
    const auto& side = plate.sides[k];
    const double T = s.on_side[k], lift = T / side.length;
    for (int i : {side.i, side.j}) s.turn.col(i) += 0.5 * T * side.t;
    s.on_arm[side.j] += arm_[side.j] * lift;
    s.on_arm[side.i] -= arm_[side.i] * lift;
  }
  for (int i = 0; i < N; ++i) s.turn.col(i) += arm_[i] * arm_force.col(i);
  return s;
}

template <int N>
void Shell::add_geometric_stiffness_of(const Eigen::Ref<const VectorXd>& force, double scale,
                                       Eigen::Ref<MatrixXd> out) const {
  const ShellFields<N> fields = calc_fields<N>();
  const SecondOrder<N> s = calc_second_order<N>(fields, force.data());
  Eigen::Matrix<double, 3 * N, 3 * N> slopes = Eigen::Matrix<double, 3 * N, 3 * N>::Zero();
  for (int q = 0; q < N; ++q) {
    Eigen::Matrix2d n;
    n << s.on_slope(0, q), s.on_slope(2, q), s.on_slope(2, q), s.on_slope(1, q);
    slopes.noalias() += fields.plate.slope[q].transpose() * (n * fields.plate.slope[q]);
  }
  Square<N> K = Square<N>::Zero(), at_nodes = K;  // of the surface's dofs, of the nodes' own rotations
  const auto add = [](Square<N>& A, int i, int j, double value) {
    A(i, j) += value;
    A(j, i) += value;
  };
  for (int j = 0; j < 3 * N; ++j)
    for (int i = 0; i < 3 * N; ++i) K(kPlate<N>[i], kPlate<N>[j]) = slopes(i, j);
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i) {
      K(6 * i, 6 * j) += s.NN(i, j);
      K(6 * i + 1, 6 * j + 1) += s.NN(i, j);
      add(K, 6 * i, 6 * j + 4, s.MM(i, j));  // M_ab u,a·β,b with β = (θy, -θx)
      add(K, 6 * i + 1, 6 * j + 3, -s.MM(i, j));
    }
  for (int k = 0; k < N; ++k) {
    const auto& side = fields.plate.sides[k];
    const double half = 0.5 * s.on_side[k] / side.length;
    for (int m : {side.i, side.j}) {  // T (u_j - u_i)/L · ½ (β_i + β_j)
      add(K, 6 * side.j, 6 * m + 4, half);
      add(K, 6 * side.i, 6 * m + 4, -half);
      add(K, 6 * side.j + 1, 6 * m + 3, -half);
      add(K, 6 * side.i + 1, 6 * m + 3, half);
    }
  }
  const auto drilling = list_drilling<N>(fields, get_corners<N>());
  for (int q = 0; q < N; ++q) {  // ½ (θz (u,x + v,y) - θx w,x - θy w,y)
    const auto& point = drilling[static_cast<std::size_t>(q)];
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        for (int a = 0; a < 2; ++a) {
          const double part = 0.5 * s.on_drilling[q] * point.shape[i] * point.dshape(a, j);
          add(K, 6 * i + 5, 6 * j + a, part);
          add(K, 6 * i + 3 + a, 6 * j + 2, -part);
        }
  }
  for (int i = 0; i < N; ++i)
    for (int a = 0; a < 2; ++a) {
      at_nodes(6 * i + 3 + a, 6 * i + 3 + a) -= s.on_arm[i];
      add(at_nodes, 6 * i + 3 + a, 6 * i + 5, 0.5 * s.turn(a, i));
    }
  if (has_arms_ || has_lean_) {
    const Square<N> map = calc_surface_map<N>();
    K = (map.transpose() * (K * map)).eval();
  }
  add_turned<N>(K + at_nodes, scale, out);
}

/// Terms of K_G: as many products as K_G has independent numbers, with weights for every load.
template <int N>
void Shell::add_projected_of(const Eigen::Ref<const MatrixXd>& U, const Eigen::Ref<const MatrixXd>& Phi,
                             GeometricProjection& sums) const {
  constexpr int kNumPairs = N * (N - 1) / 2;
  const ShellFields<N> fields = calc_fields<N>();
  auto terms = sums.add_terms(2 * kNumPairs + N + N + 2 * N + 3 * N + (has_arms_ ? N : 0));

  const auto weigh = [&](const Eigen::Ref<const MatrixXd>& force, Eigen::Ref<MatrixXd> weights) {
    for (Eigen::Index c = 0; c < force.cols(); ++c) {
      const SecondOrder<N> s = calc_second_order<N>(fields, force.col(c).data());
      double* w = weights.col(c).data();
      for (int j = 0; j < N; ++j)
        for (int i = 0; i < j; ++i) *w++ = -s.NN(i, j), *w++ = -s.MM(i, j);
      for (int k = 0; k < N; ++k) *w++ = s.on_side[k];
      for (int q = 0; q < N; ++q) *w++ = s.on_drilling[q];
      for (int i = 0; i < N; ++i) *w++ = s.turn(0, i), *w++ = s.turn(1, i);
      for (int q = 0; q < N; ++q)
        for (int a = 0; a < 3; ++a) *w++ = s.on_slope(a, q);
      for (int i = 0; i < N && has_arms_; ++i) *w++ = s.on_arm[i];
    }
  };
  const ForceMap<N> map = calc_force_map<N>(fields);
  if (U.cols() > 6 * N) {  // the weights are linear in u: of unit displacements, then of all loads at once
    MatrixXd of_unit(terms.weights.rows(), 6 * N);
    weigh(map, of_unit);
    linear::multiply_dense(false, of_unit, U, 0, terms.weights);
  } else {
    MatrixXd force((kNumForces + 1) * N, U.cols());
    linear::multiply_dense(false, map, U, 0, force);
    weigh(force, terms.weights);
  }

  // Columns of Φ in element axes, one row each: of the nodes, and of the surface.
  Eigen::Matrix<double, Eigen::Dynamic, 6 * N> X(Phi.cols(), 6 * N), S;
  for (int i = 0; i < 2 * N; ++i)
    X.template middleCols<3>(3 * i) = Phi.middleRows<3>(3 * i).transpose().lazyProduct(R_);
  S = X;
  if (has_arms_ || has_lean_) S = X * calc_surface_map<N>().transpose();
  Eigen::Index term = 0;
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < j; ++i) {
      const Eigen::Matrix<double, Eigen::Dynamic, 6> d =
          S.template middleCols<6>(6 * j) - S.template middleCols<6>(6 * i);
      for (int a = 0; a < 2; ++a) add_square(d.col(a), 1, terms.products.col(term));
      ++term;
      add_cross(d.col(0), d.col(4), 1, terms.products.col(term));
      add_cross(d.col(1), d.col(3), -1, terms.products.col(term));
      ++term;
    }
  for (const auto& side : fields.plate.sides) {
    const auto i = S.template middleCols<6>(6 * side.i), j = S.template middleCols<6>(6 * side.j);
    const double half = 0.5 / side.length;
    add_cross(j.col(0) - i.col(0), i.col(4) + j.col(4), half, terms.products.col(term));
    add_cross(j.col(1) - i.col(1), i.col(3) + j.col(3), -half, terms.products.col(term));
    ++term;
  }
  for (const auto& point : list_drilling<N>(fields, get_corners<N>())) {
    Eigen::Matrix<double, Eigen::Dynamic, 3> turn = Eigen::Matrix<double, Eigen::Dynamic, 3>::Zero(Phi.cols(), 3);
    Eigen::Matrix<double, Eigen::Dynamic, 1> stretch = Eigen::Matrix<double, Eigen::Dynamic, 1>::Zero(Phi.cols());
    Eigen::Matrix<double, Eigen::Dynamic, 2> slope = Eigen::Matrix<double, Eigen::Dynamic, 2>::Zero(Phi.cols(), 2);
    for (int i = 0; i < N; ++i) {
      turn += point.shape[i] * S.template middleCols<3>(6 * i + 3);
      stretch += point.dshape(0, i) * S.col(6 * i) + point.dshape(1, i) * S.col(6 * i + 1);
      for (int a = 0; a < 2; ++a) slope.col(a) += point.dshape(a, i) * S.col(6 * i + 2);
    }
    add_cross(turn.col(2), stretch, 0.5, terms.products.col(term));
    for (int a = 0; a < 2; ++a) add_cross(turn.col(a), slope.col(a), -0.5, terms.products.col(term));
    ++term;
  }
  for (int i = 0; i < N; ++i)
    for (int a = 0; a < 2; ++a) add_cross(X.col(6 * i + 3 + a), X.col(6 * i + 5), 0.5, terms.products.col(term++));
  for (int q = 0; q < N; ++q) {
    const Vectors<N>& slope = fields.plate.slope[q];
    Eigen::Matrix<double, Eigen::Dynamic, 2> w = Eigen::Matrix<double, Eigen::Dynamic, 2>::Zero(Phi.cols(), 2);
    for (int i = 0; i < 3 * N; ++i)
      for (int a = 0; a < 2; ++a) w.col(a) += slope(a, i) * S.col(kPlate<N>[i]);
    for (int a = 0; a < 2; ++a) add_square(w.col(a), 1, terms.products.col(term++));
    add_cross(w.col(0), w.col(1), 1, terms.products.col(term++));
  }
  for (int i = 0; i < N && has_arms_; ++i, ++term)
    for (int a = 0; a < 2; ++a) add_square(X.col(6 * i + 3 + a), -1, terms.products.col(term));
}

void Shell::add_geometric_stiffness(const Eigen::Ref<const VectorXd>& force, double scale,
                                    Eigen::Ref<MatrixXd> K_G) const {
  num_nodes_ == 4 ? add_geometric_stiffness_of<4>(force, scale, K_G) : add_geometric_stiffness_of<3>(force, scale, K_G);
}

void Shell::add_projected_geometric_stiffness(const Eigen::Ref<const MatrixXd>& U,
                                              const Eigen::Ref<const MatrixXd>& Phi, GeometricProjection& sums) const {
  num_nodes_ == 4 ? add_projected_of<4>(U, Phi, sums) : add_projected_of<3>(U, Phi, sums);
}

}  // namespace bough::fe
