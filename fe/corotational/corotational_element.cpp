#include "fe/corotational/corotational_element.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "base/rotation.hpp"
#include "fe/corotational/series.hpp"
#include "fe/elements/solve_in_range.hpp"
#include "fe/elements/stress_state.hpp"

namespace bough::fe {

namespace {

/// Weight of the nodes' rotations in the frame per mean square distance of the nodes: it decides the twist of a line,
/// and little else. Any value gives the same V to third order.
constexpr double kRotationWeight = 1e-3;
constexpr double kRigidTolerance = 1e-8;  // of K times rigid-body motion

}  // namespace

Matrix3d invert_symmetric(const Matrix3d& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(A);
  Vector3d inverse = eigen.eigenvalues();
  for (double& value : inverse) value = value > 1e-12 * eigen.eigenvalues()[2] ? 1 / value : 0;
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

bool CorotationalElement::find_stiffness(const Element& element, const std::vector<Node>& nodes) {
  const int N = element.num_dofs();
  K_ = MatrixXd::Zero(N, N);
  element.add_stiffness(1, K_);
  return find_nodes(element, nodes) && is_free_of_rigid_motion();
}

bool follows_nodes(const Element& element, const std::vector<Node>& nodes) {
  return CorotationalElement().find_stiffness(element, nodes);
}

CorotationalElement::CorotationalElement(const Element& element, const std::vector<Node>& nodes) {
  follows_nodes_ = find_stiffness(element, nodes);
  if (!follows_nodes_) return;
  set_frame();
  set_local_strains(element);
}

/// True when the dofs are all translations of some grids, and all rotations of some of these.
bool CorotationalElement::find_nodes(const Element& element, const std::vector<Node>& nodes) {
  const auto& gdofs = element.gdofs();
  const auto find_row = [&](int dof) {
    const auto it = std::find(gdofs.begin(), gdofs.end(), dof);
    return it == gdofs.end() ? -1 : static_cast<int>(it - gdofs.begin());
  };
  std::vector<Vector3d> places;
  int num_rows = 0;
  for (const int index : element.nodes()) {
    if (std::find(grids_.begin(), grids_.end(), index) != grids_.end()) continue;
    grids_.push_back(index);
    const Node& node = nodes[static_cast<std::size_t>(index)];
    const int row = find_row(node.first_gdof);
    const auto is_block = [&](int first) {
      return first >= 0 && first + 2 < element.num_dofs() &&
             gdofs[static_cast<std::size_t>(first) + 2] == gdofs[static_cast<std::size_t>(first)] + 2;
    };
    if (node.num_dofs != 6 || !is_block(row)) return false;
    const int turn = find_row(node.first_gdof + 3);
    if (turn >= 0 && !is_block(turn)) return false;
    translations_.push_back(row);
    rotations_.push_back(turn);
    places.push_back(node.x);
    num_rows += turn >= 0 ? 6 : 3;
  }
  if (places.empty() || num_rows != element.num_dofs()) return false;
  arms_.resize(3, static_cast<Eigen::Index>(places.size()));
  for (Eigen::Index k = 0; k < arms_.cols(); ++k) arms_.col(k) = places[static_cast<std::size_t>(k)];
  arms_.colwise() -= arms_.rowwise().mean().eval();
  return true;
}

bool CorotationalElement::is_free_of_rigid_motion() const {
  // The row of a dof that the motion hardly strains has roundoff alone: its size is that of the diagonals.
  const VectorXd size = K_.diagonal().cwiseMax(0).cwiseSqrt();
  for (int c = 0; c < 6; ++c) {
    VectorXd u = VectorXd::Zero(K_.rows());
    for (std::size_t k = 0; k < translations_.size(); ++k) {
      const Vector3d e = Vector3d::Unit(c % 3);
      u.segment<3>(translations_[k]) = c < 3 ? e : Vector3d(e.cross(arms_.col(static_cast<Eigen::Index>(k))));
      if (c >= 3 && rotations_[k] >= 0) u.segment<3>(rotations_[k]) = e;
    }
    if (((K_ * u).array().abs() > kRigidTolerance * size.dot(u.cwiseAbs()) * size.array()).any()) return false;
  }
  return true;
}

void CorotationalElement::set_frame() {
  rotation_weight_ = kRotationWeight * arms_.squaredNorm() / static_cast<double>(arms_.cols());
  if (rotation_weight_ == 0) rotation_weight_ = 1;
  Matrix3d H = arms_ * arms_.transpose();
  for (const int row : rotations_)
    if (row >= 0) H += rotation_weight_ * Matrix3d::Identity();
  frame_inverse_ = invert_symmetric(H.trace() * Matrix3d::Identity() - H);
}

void CorotationalElement::set_local_strains(const Element& element) {
  const StressState* state = element.stress_state();
  const int N = num_dofs(), s = state ? state->num_internal_forces() : 0;
  F_ = MatrixXd::Zero(s, N);
  if (s == 0) return;
  state->calc_internal_forces_of(MatrixXd::Identity(N, N), F_);
  for (int m = 0; m < s; ++m) {
    MatrixXd P = MatrixXd::Zero(N, N);
    state->add_geometric_stiffness(VectorXd::Unit(s, m), 1, P);
    P_.push_back(0.5 * (P + P.transpose()));
  }
  E_ = F_ * solve_in_range(K_, F_.transpose());
}

/// Frame and nodes along one curve.
struct CorotationalElement::Motion {
  SeriesMatrix R, H;                   ///< the frame, and Rᵀ B
  std::vector<SeriesVector> y, turn;   ///< places and rotation vectors of the nodes, seen from the frame
  std::vector<SeriesVector> rotation;  ///< rotation vectors in basic
};

namespace {

/// Rotation R nearest to the nodes and H = RᵀB, which is symmetric: B = R H and RᵀR = 1 order by order, R_k the
/// symmetric part that the orders below leave, and a skew one by the spin that makes H_k symmetric.
void find_frame(const SeriesMatrix& B, const Matrix3d& inverse, SeriesMatrix& R, SeriesMatrix& H) {
  R[0].setIdentity();
  H[0] = B[0];
  for (std::size_t k = 1; k < B.size(); ++k) {
    Matrix3d even = Matrix3d::Zero(), rest = B[k];
    for (std::size_t i = 1; i < k; ++i) {
      even.noalias() -= 0.5 * (R[i].transpose() * R[k - i]);
      rest.noalias() -= R[i] * H[k - i];
    }
    const Vector3d spin = inverse * calc_axis(Matrix3d(rest - even * H[0]));
    R[k] = even + skew(spin);
    rest.noalias() -= R[k] * H[0];
    H[k] = 0.5 * (rest + rest.transpose());
  }
}

}  // namespace

std::vector<CorotationalElement::Motion> CorotationalElement::calc_motions(const Eigen::Ref<const MatrixXd>& u,
                                                                           MatrixXd& d) const {
  const std::size_t num_nodes = translations_.size();
  const Eigen::Index num_curves = u.cols() / kSeriesTop;
  std::vector<Motion> motions(static_cast<std::size_t>(num_curves));
  d.resize(u.rows(), u.cols());
  for (Eigen::Index curve = 0; curve < num_curves; ++curve) {
    Motion& motion = motions[static_cast<std::size_t>(curve)];
    const auto u_c = u.middleCols<kSeriesTop>(curve * kSeriesTop);
    std::vector<SeriesVector> x(num_nodes, make_zero_vector());
    std::vector<SeriesMatrix> R_nodes(num_nodes);
    SeriesVector mean = make_zero_vector();
    for (std::size_t k = 0; k < num_nodes; ++k) {
      x[k] = get_vector(u_c, translations_[k]);
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += x[k][i] / static_cast<double>(num_nodes);
    }
    SeriesMatrix B = make_zero_matrix();
    motion.rotation.resize(num_nodes);
    for (std::size_t k = 0; k < num_nodes; ++k) {
      const Vector3d arm = arms_.col(static_cast<Eigen::Index>(k));
      for (std::size_t i = 0; i < mean.size(); ++i) x[k][i] -= mean[i];
      x[k][0] += arm;
      for (std::size_t i = 0; i < mean.size(); ++i) B[i] += x[k][i] * arm.transpose();
      if (rotations_[k] < 0) continue;
      motion.rotation[k] = get_vector(u_c, rotations_[k]);
      R_nodes[k] = calc_exponential(motion.rotation[k]);
      for (std::size_t i = 0; i < mean.size(); ++i) B[i] += rotation_weight_ * R_nodes[k][i];
    }
    find_frame(B, frame_inverse_, motion.R, motion.H);
    const SeriesMatrix Rt = transpose(motion.R);
    motion.y.resize(num_nodes);
    motion.turn.resize(num_nodes);
    auto d_c = d.middleCols<kSeriesTop>(curve * kSeriesTop);
    for (std::size_t k = 0; k < num_nodes; ++k) {
      motion.y[k] = multiply(Rt, x[k]);
      put_vector(motion.y[k], translations_[k], d_c);  // from order 1; the arm is order 0
      if (rotations_[k] < 0) continue;
      motion.turn[k] = calc_logarithm(multiply(Rt, R_nodes[k]));
      put_vector(motion.turn[k], rotations_[k], d_c);
    }
  }
  return motions;
}

MatrixXd CorotationalElement::calc_second_strains(const MatrixXd& d, std::vector<MatrixXd>& Pd) const {
  MatrixXd w = MatrixXd::Zero(static_cast<Eigen::Index>(P_.size()), d.cols());
  Pd.resize(P_.size());
  for (std::size_t m = 0; m < P_.size(); ++m) {
    Pd[m].noalias() = P_[m] * d;
    for (Eigen::Index c = 0; c < d.cols(); c += kSeriesTop)
      for (int i = 1; i < kSeriesTop; ++i)
        for (int j = 1; i + j <= kSeriesTop; ++j)
          w(static_cast<Eigen::Index>(m), c + i + j - 1) += d.col(c + i - 1).dot(Pd[m].col(c + j - 1));
  }
  return w;
}

LocalSeries CorotationalElement::calc_local(const Eigen::Ref<const MatrixXd>& u) const {
  BOUGH_DEMAND(u.rows() == num_dofs() && u.cols() % kSeriesTop == 0);
  LocalSeries local;
  local.d = u;
  if (!follows_nodes_) return local;
  calc_motions(u, local.d);
  std::vector<MatrixXd> Pd;
  local.internal = F_ * local.d;
  if (!P_.empty()) local.internal += 0.5 * (E_ * calc_second_strains(local.d, Pd));
  return local;
}

MatrixXd CorotationalElement::calc_forces(const Eigen::Ref<const MatrixXd>& u) const {
  BOUGH_DEMAND(u.rows() == num_dofs() && u.cols() % kSeriesTop == 0);
  if (!follows_nodes_) return K_ * u;
  const std::size_t num_nodes = translations_.size();
  const Eigen::Index num_curves = u.cols() / kSeriesTop;
  MatrixXd d;
  const std::vector<Motion> motions = calc_motions(u, d);

  // ∂V/∂d = K d + ½ Fᵀw + Σ_m (F d + ½ E w)_m P_m d
  MatrixXd g = K_ * d;
  if (!P_.empty()) {
    std::vector<MatrixXd> Pd;
    const MatrixXd w = calc_second_strains(d, Pd), h = F_ * d + 0.5 * (E_ * w);
    g += 0.5 * (F_.transpose() * w);
    for (Eigen::Index m = 0; m < w.rows(); ++m)
      for (Eigen::Index c = 0; c < d.cols(); c += kSeriesTop)
        for (int i = 1; i < kSeriesTop; ++i)
          for (int j = 1; i + j <= kSeriesTop; ++j)
            g.col(c + i + j - 1) += h(m, c + i - 1) * Pd[static_cast<std::size_t>(m)].col(c + j - 1);
  }

  MatrixXd f = MatrixXd::Zero(u.rows(), u.cols());
  for (Eigen::Index curve = 0; curve < num_curves; ++curve) {
    const Motion& motion = motions[static_cast<std::size_t>(curve)];
    const auto g_c = g.middleCols<kSeriesTop>(curve * kSeriesTop);
    auto f_c = f.middleCols<kSeriesTop>(curve * kSeriesTop);
    std::vector<SeriesVector> force(num_nodes), moment(num_nodes);
    SeriesVector tau = make_zero_vector();
    for (std::size_t k = 0; k < num_nodes; ++k) {
      force[k] = get_vector(g_c, translations_[k]);
      SeriesVector share = cross(motion.y[k], force[k]);
      if (rotations_[k] >= 0) {
        moment[k] = multiply(transpose(calc_inverse_tangent(motion.turn[k])), get_vector(g_c, rotations_[k]));
        for (std::size_t i = 0; i < tau.size(); ++i) share[i] += moment[k][i];
      }
      for (std::size_t i = 0; i < tau.size(); ++i) tau[i] += share[i];
    }
    // The frame turns by (tr H 1 - H)⁻¹ (Σ a × Rᵀδx + c Σ (tr Q 1 - Q) Rᵀδφ), Q the node seen from the frame.
    const SeriesVector mu = solve(subtract_from_trace(motion.H), frame_inverse_, tau);
    SeriesVector mean = make_zero_vector();
    for (std::size_t k = 0; k < num_nodes; ++k) {
      const Vector3d arm = arms_.col(static_cast<Eigen::Index>(k));
      for (std::size_t i = 0; i < mu.size(); ++i) force[k][i] -= mu[i].cross(arm);
      for (std::size_t i = 0; i < mu.size(); ++i) mean[i] += force[k][i] / static_cast<double>(num_nodes);
    }
    for (std::size_t k = 0; k < num_nodes; ++k) {
      for (std::size_t i = 0; i < mu.size(); ++i) force[k][i] -= mean[i];
      put_vector(multiply(motion.R, force[k]), translations_[k], f_c);
      if (rotations_[k] < 0) continue;
      const SeriesVector back = multiply(transpose(subtract_from_trace(calc_exponential(motion.turn[k]))), mu);
      for (std::size_t i = 0; i < mu.size(); ++i) moment[k][i] -= rotation_weight_ * back[i];
      put_vector(multiply(transpose(calc_tangent(motion.rotation[k])), multiply(motion.R, moment[k])), rotations_[k],
                 f_c);
    }
  }
  return f;
}

}  // namespace bough::fe
